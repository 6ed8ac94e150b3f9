"""The diagnosis as a section of the report, and as a page of its own."""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any, Final

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from calibrate.report.diagnosis import rows
from calibrate.report.record_file import kept_part
from calibrate.report.sections import Section, add_section
from calibrate.runs.stored import DIAGNOSIS, FIGURE, REPORT

__all__ = ["TITLE", "add_diagnosis_section", "keep_diagnosis", "page_html", "section_html"]

TITLE: Final = "What the simulation gets wrong"


@dataclass(frozen=True)
class Grid:
    """A table in words.

    Attributes
    ----------
    head : sequence of str
    rows : sequence of sequence of str
    """

    head: Sequence[str]
    rows: Sequence[Sequence[str]]


def add_diagnosis_section(record: Mapping[str, Any], figure: bytes, report: Path) -> Path:
    """Add a diagnosis to a report, or replace what it says of an earlier one.

    Parameters
    ----------
    record : mapping
        The diagnosis as plain data.
    figure : bytes
        Its picture, PNG.
    report : Path
        Replaced as a whole.

    Raises
    ------
    CalibrationError
        When it is no report.
    """
    return add_section(report, Section(TITLE, section_html(record, figure)))


def keep_diagnosis(out: Path, study_sha256: str) -> bool:
    """Add the diagnosis that a directory holds to its report, which was written anew.

    Parameters
    ----------
    out : Path
        Directory of a study's results.
    study_sha256 : str
        A diagnosis of another study, or of other data, is left out.

    Returns
    -------
    bool
        False where one was left out.
    """
    record = kept_part(out / DIAGNOSIS, study_sha256)
    # One of an earlier version has no such key, and is made again by 'bulkcal diagnose'.
    if "further_runs" in record and (out / FIGURE).exists():
        add_diagnosis_section(record, (out / FIGURE).read_bytes(), out / REPORT)
    return bool(record) or not (out / DIAGNOSIS).exists()


def section_html(record: Mapping[str, Any], figure: bytes) -> str:
    """Return figure, sentences and tables as HTML; everything from outside is escaped.

    Parameters
    ----------
    record : mapping
        The diagnosis as plain data.
    figure : bytes
        Its picture, PNG.
    """
    image = base64.b64encode(figure).decode("ascii")
    with_cause = [f"with {' and '.join(record['leading'])}"] if record["leading"] else []
    after = [f"z left out, {one}" for one in with_cause] if record["residuals_after"] else []
    engine = [*with_cause, "z"] if record["engine_after"] else []
    text: str = (
        _pages()
        .get_template("diagnosis_section.html.j2")
        .render(
            grid=_grid_html,
            headline=record["headline"],
            sentences=record["sentences"][1:],
            image=f"data:image/png;base64,{image}",
            visible=Grid(rows.VISIBLE, rows.visible_rows(record)),
            shares=Grid(rows.SHARES, rows.share_rows(record)),
            supposed=rows.supposed_words(record),
            change=Grid(rows.CHANGE, rows.change_rows(record) if record["supposed"] else []),
            measure=Grid(rows.NEXT, rows.next_rows(record)),
            residuals=Grid([*rows.RESIDUALS, *after], rows.residual_rows(record)),
            groups=Grid(rows.GROUPS, rows.group_rows(record)),
            engine=Grid([*rows.ENGINE, *engine], rows.engine_rows(record)),
            held_out=[_held_out(one) for one in record["gains"]],
            extended=record["extended"],
            next=record["next"],
            cost=_cost(record),
        )
    )
    return text


def page_html(section: str) -> str:
    """Return a section of `section_html` as a page of its own."""
    return str(_pages().get_template("single.html.j2").render(title=TITLE, section=Markup(section)))


def _pages() -> Environment:
    return Environment(
        loader=PackageLoader("calibrate.report", "pages"),
        autoescape=True,
        undefined=StrictUndefined,
    )


def _held_out(gain: Mapping[str, Any]) -> dict[str, Any]:
    return {
        "title": " and ".join(gain["candidates"]),
        "table": Grid(rows.HELD_OUT, rows.held_out_rows(gain)),
        "chance": f"{gain['chance']:+.1f}",
    }


def _cost(record: Mapping[str, Any]) -> str:
    few = record["few_twins"]
    kept = f" Few runs of {', '.join(few)}: nothing is said of them." if few else ""
    further = record["further_runs"]
    tried = f" {further} runs of further experiments told what to try next." if further else ""
    return (
        f"{len(record['runs'])} runs stand behind the emulators, {record['twins']} of them with an "
        f"effect on, {record['added']} added where evidence or strength was uncertain, "
        f"{record['failed_runs']} failed.{kept}{tried}"
    )


def _grid_html(grid: Grid) -> Markup:
    """Return a table; cells whose difference the errors do not explain are marked."""
    head = "".join(f"<th>{escape(one)}</th>" for one in grid.head)
    body = "".join(f"<tr>{''.join(map(_cell, grid.head, row))}</tr>" for row in grid.rows)
    return Markup(
        f'<div class="scroll"><table><thead><tr>{head}</tr></thead>'
        f"<tbody>{body}</tbody></table></div>"
    )


def _cell(heading: str, text: str) -> str:
    mark = ' class="bad"' if rows.is_large(heading, text) else ""
    return f"<td{mark}>{escape(text)}</td>"
