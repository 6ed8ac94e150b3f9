"""The joint calibration's section of a report, and the page of a study without stages."""

from __future__ import annotations

import base64
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup
from matplotlib.figure import Figure

from calibrate.questions.core.problem import place_name
from calibrate.questions.joint.result import JointResult
from calibrate.report.drawing import png
from calibrate.report.gallery import Drawings, gallery
from calibrate.report.joint.figures import left_out_figure, targets_figure
from calibrate.report.joint.tables import check_words, unknown_words
from calibrate.report.record import provenance
from calibrate.report.sections import LINKS_END, SECTIONS_END, Section, add_section
from liggghts_io.files import write_text

__all__ = ["add_joint_section", "write_joint_page"]

TITLE: Final = "All targets at once"
HONEST: Final = 1.5
"""Root mean square distance up to which emulators kept their word."""


def add_joint_section(
    result: JointResult, report: Path, staged: Mapping[str, float] | None = None
) -> Path:
    """Add the joint calibration to a report, or replace what it says of an earlier one.

    Parameters
    ----------
    result : JointResult
    report : Path
        Page that `write_report` or `write_joint_page` wrote; replaced as a whole.
    staged : mapping, optional
        What stages of the same study found, by the study's label of a parameter.

    Raises
    ------
    CalibrationError
        When it is no report.
    """
    text = _page("joint_section.html.j2").render(**_content(result, staged))
    return add_section(report, Section(TITLE, text))


def write_joint_page(result: JointResult, path: Path, command: str, drawings: Drawings) -> Path:
    """Write the report of a study without stages; `add_joint_section` fills it.

    Parameters
    ----------
    result : JointResult
    path : Path
        HTML file to write; replaced as a whole.
    command : str
        Command to repeat it.
    drawings : Drawings
        How a case directory is drawn.
    """
    text = _page("joint.html.j2").render(
        title=result.study.title,
        links=Markup(LINKS_END),
        extra=Markup(SECTIONS_END),
        provenance=list(provenance(result.study, command).items()),
        sources=list(result.data.sources),
        **gallery(_cases(result) if result.checked else (), drawings),
    )
    write_text(path, text)
    return path


def _page(name: str) -> Any:
    environment = Environment(
        loader=PackageLoader("calibrate.report", "pages"),
        autoescape=True,
        undefined=StrictUndefined,
    )
    return environment.get_template(name)


def _content(result: JointResult, staged: Mapping[str, float] | None) -> dict[str, Any]:
    unknowns, chance = unknown_words(result, staged), result.study.likelihood.discrepancy
    return {
        "unknowns": unknowns,
        "published": any(one.published for one in unknowns),
        "staged": any(one.staged for one in unknowns),
        "targets": len(result.check),
        "sentences": result.sentences,
        "discrepancy": f"{100.0 * chance:g} %" if chance else "",
        "modes": len(result.posterior.regions),
        "corner": _embed(result.figure()),
        "checked": result.checked,
        "seeds": result.study.design.check_seeds,
        "draws": result.study.design.check_draws,
        "honesty": _honesty(result.unseen_z),
        "check": check_words(result),
        "targets_image": _embed(targets_figure(result)),
        "quality": [_quality(row) for row in result.emulators.quality.to_dict("records")],
        "left_out": _embed(left_out_figure(result)),
        "cost": _cost(result),
    }


def _embed(figure: Figure) -> str:
    return "data:image/png;base64," + base64.b64encode(png(figure)).decode("ascii")


def _honesty(unseen_z: float) -> str:
    """Say how the emulators did on the check's runs before they had seen them."""
    if not np.isfinite(unseen_z):
        return ""
    how = "as they should" if unseen_z <= HONEST else "more than they should"
    return (
        "Before the emulators had seen these runs they missed them by "
        f"{unseen_z:.2f} expected errors (root mean square), {how}: 1 is honest."
    )


def _quality(row: dict[Any, Any]) -> dict[str, Any]:
    return {
        "output": row["output"],
        "where": f"{row['experiment']}, {row['kind']}",
        "runs": row["n"],
        "q2": f"{row['Q2']:.2f}",
        "z_rms": f"{row['z_rms']:.2f}",
        "inflation": f"{row['inflation']:.2f}",
    }


def _cost(result: JointResult) -> str:
    table = result.runs.table
    minutes = float(table["wall_s"].sum()) / 60.0
    failed = int((table["status"] != "ok").sum())
    return (
        f"{len(table)} runs stand behind the emulators, {result.provenance['runs_of_budget']} of "
        f"them of the budget of {result.study.design.runs} and the others from stages, earlier "
        f"work and the check; {minutes:.0f} min of computing on one core, {failed} failed."
    )


def _cases(result: JointResult) -> Iterator[tuple[str, Path | None]]:
    """Yield title and the newest good run of every place."""
    table = result.runs.table
    for place in result.study.places:
        experiment = result.study.experiments[place.experiment]
        kind = result.study.surface_named(place.surface).kind
        here = result.runs.of((place.experiment, kind)) & (table["status"] == "ok").to_numpy()
        newest = Path(str(table["path"].to_numpy()[here][-1])) if here.any() else None
        yield f"{experiment.caption}: {place_name(place)}", newest
