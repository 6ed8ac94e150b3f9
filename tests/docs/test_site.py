"""The documentation as a site: built without a warning, every link leads somewhere, all offline."""

from __future__ import annotations

import importlib
import os
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

from tests.house.public_api import MODULES
from tests.paths import ROOT

TAKEN_IN = {"link": "href", "script": "src", "img": "src", "iframe": "src", "source": "src"}
"""What a browser fetches without being asked."""


class Page(HTMLParser):
    """Links, anchors and fetched files of a page.

    Attributes
    ----------
    links, fetched : list of str
    anchors : set of str
    """

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.links: list[str] = []
        self.fetched: list[str] = []
        self.anchors: set[str] = set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs) -> None:
        """Note what a tag says."""
        found = dict(attrs)
        self.anchors |= {value for key in ("id", "name") if (value := found.get(key))}
        if tag == "a" and found.get("href"):
            self.links.append(found["href"])
        if tag in TAKEN_IN and found.get("rel") != "canonical" and found.get(TAKEN_IN[tag]):
            self.fetched.append(found[TAKEN_IN[tag]])


@pytest.fixture(scope="module")
def site(tmp_path_factory) -> Path:
    """Build the site as `make docs` does; a warning fails it."""
    out = tmp_path_factory.mktemp("docs") / "site"
    done = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(out)],
        cwd=ROOT, env=os.environ | {"NO_MKDOCS_2_WARNING": "1"}, capture_output=True, text=True,
        check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    assert "WARNING" not in done.stdout + done.stderr
    assert "Documentation built" in done.stderr  # a quiet mkdocs sees no warnings, strict or not
    return out


@pytest.fixture(scope="module")
def pages(site: Path) -> dict[Path, Page]:
    # The page for addresses that are not there has absolute links, which is right for it alone.
    return {path: Page(path) for path in site.rglob("*.html") if path.name != "404.html"}


def test_every_link_leads_to_a_page_and_a_place_on_it(site, pages) -> None:
    wrong, followed = [], 0
    for path, page in pages.items():
        for link in (*page.links, *page.fetched):
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            anchors = pages[target].anchors if target in pages else set()
            good = target.is_file() and (not parts.fragment or unquote(parts.fragment) in anchors)
            followed += 1
            if not good:
                wrong.append(f"{path.relative_to(site)}: {link}")
    assert wrong == []
    assert followed > 1000


def test_a_reader_without_a_network_has_everything(pages) -> None:
    away = {one for page in pages.values() for one in page.fetched if urlsplit(one).netloc}
    assert away == set()


def test_styles_take_nothing_from_elsewhere(site) -> None:
    for sheet in site.rglob("*.css"):
        text = sheet.read_text(encoding="utf-8")
        assert not re.search(r"(@import|url\()\s*[\"']?(https?:)?//", text), sheet


@pytest.mark.parametrize("name", MODULES)
def test_the_reference_has_the_whole_public_interface(pages, site, name: str) -> None:
    anchors = pages[site / "reference" / f"{name}.html"].anchors
    public = {f"{name}.{one}" for one in importlib.import_module(name).__all__}
    assert public - anchors == set()


def test_the_tutorial_shows_what_the_notebook_shows(pages, site) -> None:
    assert any(".png" in one for one in pages[site / "tutorial.html"].fetched)
    assert "study.calibrate(" in re.sub(
        r"<[^>]+>", "", (site / "tutorial.html").read_text(encoding="utf-8")
    )
