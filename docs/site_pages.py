"""What mkdocs asks when it builds the site: pages that are written elsewhere, and their links.

README, changelog, examples and the notebook stand where a reader of the repository looks for them.
Here they become pages, and a link between two files of the repository one between two pages. Names
of the functions are those that mkdocs looks for.
"""

from __future__ import annotations

import os
import posixpath
import re
from pathlib import Path
from typing import Any, Final

import nbformat
from mkdocs.structure.files import File, Files
from nbconvert import MarkdownExporter

ROOT: Final = Path(__file__).resolve().parent.parent
PAGES: Final = {
    "index.md": "README.md",
    "changelog.md": "CHANGELOG.md",
    "contributing.md": "CONTRIBUTING.md",
    "tutorial.md": "docs/tutorial.ipynb",
    "cases/index.md": "cases/README.md",
    "cases/drawdown.md": "cases/drawdown/README.md",
    "cases/drum.md": "cases/drum/README.md",
    "cases/hidden.md": "cases/hidden/README.md",
    "cases/oblique_impact.md": "cases/oblique_impact/README.md",
    "cases/plain_script.md": "cases/plain_script/README.md",
    "peers.md": "benchmarks/peers/README.md",
    "torture.md": "benchmarks/torture.md",
}
"""Page of the site: file of the repository."""
_FENCE: Final = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)
_LINK: Final = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")
_OUTSIDE: Final = re.compile(r"[a-z]+:|#")


def on_files(files: Files, config: Any) -> Files:
    """Add the pages that are written elsewhere."""
    for page, source in PAGES.items():
        if source.endswith(".ipynb"):
            text, pictures = _notebook(ROOT / source)
            for name, content in pictures.items():
                files.append(File.generated(config, name, content=content))
        else:
            text = (ROOT / source).read_text(encoding="utf-8")
        files.append(File.generated(config, page, content=text))
    return files


def on_page_markdown(markdown: str, page: Any, config: Any, files: Files) -> str:
    """Turn links between files of the repository into links between pages."""
    del config
    here = page.file.src_uri
    parts, end = [], 0
    for fence in _FENCE.finditer(markdown):
        parts += [_linked(markdown[end : fence.start()], here, files), fence.group()]
        end = fence.end()
    return "".join([*parts, _linked(markdown[end:], here, files)])


def _linked(text: str, here: str, files: Files) -> str:
    """Return text that is no code with the links of a page of the site."""
    source = PAGES.get(here, f"docs/{here}")
    pages = {file: page for page, file in PAGES.items()}

    def turned(link: re.Match[str]) -> str:
        mark, words, address = link.groups()
        if _OUTSIDE.match(address):
            return link.group()
        path, hash_, anchor = address.partition("#")
        file = posixpath.normpath(posixpath.join(posixpath.dirname(source), path))
        page = pages.get(file, file.removeprefix("docs/"))
        if files.get_file_from_path(page):
            relative = posixpath.relpath(page, posixpath.dirname(here) or ".")
            return f"{mark}[{words}]({relative}{hash_}{anchor})"
        # A file that is no page is named; one that is not there is left for mkdocs to refuse.
        return words if not mark and (ROOT / file).exists() else link.group()

    return _LINK.sub(turned, text)


def _notebook(path: Path) -> tuple[str, dict[str, bytes]]:
    """Return a notebook as Markdown, and its pictures by name."""
    notebook = nbformat.read(path, as_version=4)
    text, resources = MarkdownExporter().from_notebook_node(notebook)
    pictures = {f"{path.stem}_{os.fspath(n)}": data for n, data in resources["outputs"].items()}
    for name in resources["outputs"]:
        text = text.replace(f"]({name})", f"]({path.stem}_{name})")
    return text, pictures
