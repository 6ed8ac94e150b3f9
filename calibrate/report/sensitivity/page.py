"""A sensitivity study as a record, a page and a section of the report."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import Any, Final

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup
from matplotlib.figure import Figure

from calibrate.questions.sensitivity.result import SensitivityResult
from calibrate.report.drawing import png
from calibrate.report.record import plain, provenance
from calibrate.report.record_file import hashed_record
from calibrate.report.sections import Section, add_section
from calibrate.report.sensitivity.tables import grids_of
from calibrate.runs.stored import RECORD, REPORT, SENSITIVITY, SENSITIVITY_PAGE
from liggghts_io.files import write_text

__all__ = ["write_sensitivity"]

TITLE: Final = "What moves what"


def write_sensitivity(result: SensitivityResult, out: Path, command: str) -> None:
    """Write record and page, and a section of the report where the directory has one.

    Parameters
    ----------
    result : SensitivityResult
    out : Path
        Directory of the results.
    command : str
        Command that made them.
    """
    follows = "diagnose" if (out / RECORD).exists() else "calibrate"
    follows = f"bulkcal {follows} {result.data.path} --out {out}"
    facts = {"next": follows, "provenance": provenance(result.data.study, command)}
    record = hashed_record(plain({**result.record(), **facts}))
    write_text(out / SENSITIVITY, json.dumps(record, indent=1) + "\n")
    section = _page("sensitivity_section.html.j2").render(**_content(result, follows))
    title = f"{TITLE}: {result.data.study.title}"
    page = _page("single.html.j2").render(title=title, section=Markup(section))
    write_text(out / SENSITIVITY_PAGE, page)
    if (out / REPORT).exists():
        add_section(out / REPORT, Section(TITLE, section))


def _page(name: str) -> Any:
    environment = Environment(
        loader=PackageLoader("calibrate.report", "pages"),
        autoescape=True,
        undefined=StrictUndefined,
    )
    return environment.get_template(name)


def _content(result: SensitivityResult, follows: str) -> dict[str, Any]:
    single = {one.where for one in result.responses}
    return {
        "sentences": result.sentences,
        "baseline": [f"{name} = {value:g}" for name, value in result.baseline.items()],
        "grids": grids_of(result),
        "curves": [
            {"where": where, "image": _embed(result.figure(where))}
            for where in result.places
            if where in single
        ],
        "indices": _embed(result.indices_figure()) if result.shares else "",
        "levels": result.levels,
        "seeds": result.seeds,
        "runs": result.runs,
        "failed": result.failed,
        "next": follows,
    }


def _embed(figure: Figure) -> str:
    return "data:image/png;base64," + base64.b64encode(png(figure)).decode("ascii")
