"""Pages in a headless Chromium, where there is one."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
# A machine for tests has no graphics card: WebGL by software, which a browser must be told.
WITH_WEBGL = ["--enable-unsafe-swiftshader"]
WITHOUT_WEBGL = ["--disable-3d-apis"]
PHONE, DESKTOP = (390, 844), (1280, 900)
LIMIT_MS = 120_000.0


@dataclass
class Opened:
    """A page in a browser, and what it did.

    Attributes
    ----------
    page : playwright.sync_api.Page
    errors : list of str
        Of the console, and those that no script caught.
    requests : list of str
        Addresses that were asked for, the page's own and data inside it left out.
    """

    page: Any
    errors: list[str] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)


@contextmanager
def opened(path: Path, size: tuple[int, int] = DESKTOP, *, webgl: bool = True) -> Iterator[Opened]:
    """Open a page in a window of a size, or skip the test where there is no browser."""
    playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    program = next(filter(None, map(shutil.which, NAMES)), None)
    if program is None:
        pytest.skip(f"no Chromium on the path ({', '.join(NAMES)})")
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(
            executable_path=program,
            args=["--no-sandbox", *(WITH_WEBGL if webgl else WITHOUT_WEBGL)],
        )
        page = browser.new_page(viewport={"width": size[0], "height": size[1]})
        page.set_default_timeout(LIMIT_MS)
        found = Opened(page)
        page.on("console", lambda said: said.type == "error" and found.errors.append(said.text))
        page.on("pageerror", lambda error: found.errors.append(str(error)))
        page.on("request", lambda asked: _note(found.requests, asked.url, path.as_uri()))
        page.goto(path.as_uri())
        yield found
        browser.close()


def _note(requests: list[str], address: str, own: str) -> None:
    if address.partition("#")[0] != own and not address.startswith("data:"):
        requests.append(address)
