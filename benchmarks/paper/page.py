"""The page: text stands in it, tables between markers are made anew."""

from __future__ import annotations

import re
from collections.abc import Callable

from benchmarks.paper import sources, tables

PARTS: dict[str, Callable[[], list[str]]] = {
    "angles": tables.angles,
    "times": tables.times,
    "boxes": tables.boxes,
    "flows": tables.flows,
    "parameters hsp13": lambda: tables.parameters("hsp13"),
    "parameters proppants": lambda: tables.parameters("proppants"),
    "apparatus hsp13": lambda: tables.apparatus("hsp13"),
    "apparatus proppants": lambda: tables.apparatus("proppants"),
    "deviations hsp13": lambda: tables.deviations("hsp13"),
    "deviations proppants": lambda: tables.deviations("proppants"),
    "held out": tables.held_out,
    "held out summary": tables.held_out_summary,
    "contours": tables.contours,
    "sensitivity": tables.sensitivity,
    "sensitivity engine": tables.sensitivity_engine,
    "sobol": tables.sobol,
    "campaign": lambda: tables.campaign("quick"),
    "quality hsp13": lambda: tables.quality("hsp13"),
    "quality proppants": lambda: tables.quality("proppants"),
}
"""What stands between the markers ``<!-- NAME -->`` and ``<!-- end NAME -->``."""


def filled(text: str) -> str:
    """Return the text of the page with every table made anew.

    Raises
    ------
    ValueError
        Where a table has no markers on the page.
    """
    for name, make in PARTS.items():
        pattern = re.compile(rf"(<!-- {name} -->\n).*?(<!-- end {name} -->)", re.DOTALL)
        if not pattern.search(text):
            msg = f"{sources.PAGE.name}: no markers for '{name}'"
            raise ValueError(msg)
        body = "\n".join(["", *make(), "", ""])
        text = pattern.sub(lambda found, body=body: found[1] + body + found[2], text)
    return text


def write() -> None:
    """Write the page."""
    sources.PAGE.write_text(filled(sources.PAGE.read_text(encoding="utf-8")), encoding="utf-8")
