"""Draw the layers of the program from its imports.

    python docs/draw_layers.py            # writes docs/images/layers.svg
    python docs/draw_layers.py --check    # exit code 1 if that picture is out of date

Every box is a folder or a loose module below one of the three packages; its words are the first
line of its docstring. A box stands one row above the highest box that it imports from the same
package, also where the import is made late or for types only. An arrow is left out where a longer
way says the same.
"""

from __future__ import annotations

import argparse
import ast
import sys
import textwrap
from collections.abc import Mapping
from graphlib import CycleError, TopologicalSorter
from html import escape
from pathlib import Path
from typing import Final

import grimp

ROOT: Final = Path(__file__).resolve().parents[1]
PICTURE: Final = ROOT / "docs" / "images" / "layers.svg"
PACKAGES: Final = ("calibrate", "liggghts_io", "minidem")
BOX_WIDTH, BOX_HEIGHT, GAP, ROW = 188, 62, 14, 96
MARGIN, HEAD = 18, 34
LETTERS: Final = 31
"""Letters of the small print that fit into a box."""

Graph = Mapping[str, frozenset[str]]


def imports_of(package: str) -> dict[str, frozenset[str]]:
    """Return which folders and loose modules of a package import which, by dotted name."""
    graph = grimp.build_graph(*PACKAGES, cache_dir=None)
    members = sorted(graph.find_children(package))
    found = {}
    for member in members:
        inside = {member} | graph.find_descendants(member)
        reached = {
            part
            for module in inside
            for target in graph.find_modules_directly_imported_by(module)
            if (part := ".".join(target.split(".")[:2])) in members and part != member
        }
        found[member] = frozenset(reached)
    return found


def levels_of(graph: Graph) -> dict[str, int]:
    """Return the row of every box, 0 for those that import nothing of their package.

    Raises
    ------
    SystemExit
        If the imports go in a circle, which is named.
    """
    levels: dict[str, int] = {}
    try:
        for name in TopologicalSorter(graph).static_order():
            levels[name] = 1 + max((levels[other] for other in graph[name]), default=-1)
    except CycleError as err:
        circle = " -> ".join(reversed(err.args[1]))
        msg = f"imports go in a circle: {circle}"
        raise SystemExit(msg) from err
    return levels


def shortened(graph: Graph) -> dict[str, frozenset[str]]:
    """Leave out every import that a longer way of imports implies."""

    def below(name: str) -> set[str]:
        return set().union(*({other} | below(other) for other in graph[name]))

    return {
        name: frozenset(
            other
            for other in others
            if not any(other in below(third) for third in others if third != other)
        )
        for name, others in graph.items()
    }


def purpose_of(name: str) -> str:
    """Return the first line of a folder's or module's docstring."""
    path = ROOT.joinpath(*name.split("."))
    file = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    text = ast.get_docstring(ast.parse(file.read_text(encoding="utf-8"))) or ""
    return text.split("\n", 1)[0].replace("`", "")


def _box(name: str, x: float, y: float) -> list[str]:
    """Return the shapes of one box."""
    folder = ROOT.joinpath(*name.split(".")).is_dir()
    shown = name.split(".")[1] + ("/" if folder else "")
    small = textwrap.shorten(purpose_of(name), 3 * LETTERS - 6, placeholder=" ...")
    lines = textwrap.wrap(small, LETTERS)[:3]
    parts = [
        f'<rect x="{x}" y="{y}" width="{BOX_WIDTH}" height="{BOX_HEIGHT}" rx="5" '
        f'class="{"folder" if folder else "module"}"/>',
        f'<text x="{x + 8}" y="{y + 16}" class="name">{escape(shown)}</text>',
    ]
    for i, line in enumerate(lines):
        parts.append(f'<text x="{x + 8}" y="{y + 30 + 12 * i}">{escape(line)}</text>')
    return parts


def _arrow(upper: tuple[float, float], lower: tuple[float, float], width: float) -> str:
    """Return an arrow from box to box; one that leaps over rows goes around them."""
    x, y = upper[0] + BOX_WIDTH / 2, upper[1] + BOX_HEIGHT
    a, b = lower[0] + BOX_WIDTH / 2, lower[1] - 1
    leaps = b - y > ROW
    out = (-1 if x + a < width else 1) * 1.5 * BOX_WIDTH if leaps else 0.0
    side = min(x, a) if out < 0 else max(x, a)
    bends = f"C{side + out} {y + ROW / 2} {side + out} {b - ROW / 2} " if leaps else "L"
    return f'<path d="M{x} {y} {bends}{a} {b}" marker-end="url(#tip)" class="arrow"/>'


def _band(package: str, top: float, width: float) -> tuple[list[str], float]:
    """Return the shapes of one package and the height they take."""
    graph = imports_of(package)
    levels = levels_of(graph)
    rows = [sorted(n for n in graph if levels[n] == row) for row in range(max(levels.values()) + 1)]
    height = HEAD + ROW * len(rows)
    place: dict[str, tuple[float, float]] = {}
    for level, names in enumerate(rows):
        y = top + HEAD + ROW * (len(rows) - 1 - level)
        left = (width - len(names) * (BOX_WIDTH + GAP) + GAP) / 2
        for i, name in enumerate(names):
            place[name] = (left + i * (BOX_WIDTH + GAP), y)
    shapes = [
        f'<rect x="{MARGIN / 2}" y="{top}" width="{width - MARGIN}" height="{height - 8}" '
        'class="band"/>',
        f'<text x="{MARGIN}" y="{top + 21}" class="title">{package}</text>',
    ]
    for name, others in sorted(shortened(graph).items()):
        shapes += [_arrow(place[name], place[other], width) for other in sorted(others)]
    for name, (x, y) in sorted(place.items()):
        shapes += _box(name, x, y)
    return shapes, height


STYLE: Final = """
text { font: 10px sans-serif; fill: #444 }
.name { font: bold 12px sans-serif; fill: #111 }
.title { font: bold 16px sans-serif; fill: #333 }
.band { fill: #f4f5f7; stroke: none }
.folder { fill: #fff; stroke: #2b6cb0; stroke-width: 1.4 }
.module { fill: #fff; stroke: #a0aec0 }
.arrow { stroke: #8a97a8; stroke-width: 1; fill: none }
"""


def drawing() -> str:
    """Return the picture as SVG text; the same imports give the same text."""
    widest = max(
        max(list(levels.values()).count(row) for row in levels.values())
        for levels in (levels_of(imports_of(package)) for package in PACKAGES)
    )
    width = widest * (BOX_WIDTH + GAP) + 2 * MARGIN
    shapes: list[str] = []
    top = MARGIN / 2
    for package in PACKAGES:
        more, height = _band(package, top, width)
        shapes += more
        top += height
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {top}" width="{width}">'
        f"<style>{STYLE}</style>"
        '<defs><marker id="tip" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" '
        'markerHeight="7" orient="auto"><path d="M0 0 8 4 0 8z" fill="#8a97a8"/></marker></defs>'
        f'<rect width="{width}" height="{top}" fill="#fff"/>'
    )
    return "\n".join([head, *shapes, "</svg>"]) + "\n"


def main() -> int:
    """Write the picture, or say whether it is current."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("--check", action="store_true", help="write nothing, compare")
    wanted = drawing()
    if parser.parse_args().check:
        return int(PICTURE.read_text(encoding="utf-8") != wanted)
    PICTURE.write_text(wanted, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
