"""One self-contained HTML file per calibration, to be read by a colleague without the program."""

from __future__ import annotations

import base64
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from calibrate.report.drawing import WORDS
from calibrate.report.figures import interval_figure, quality_figure, stage_figure
from calibrate.report.gallery import Drawings, gallery
from calibrate.report.numbers import band, pair, plus_minus, signed
from calibrate.report.record import provenance
from calibrate.report.sections import LINKS_END, SECTIONS_END
from calibrate.scales import slope
from calibrate.significance import shown
from calibrate.staged.calibration import Calibration
from calibrate.staged.placed import at_place
from calibrate.staged.result import StageResult, TargetFit
from calibrate.study.model import places_of
from liggghts_io.files import write_text

__all__ = ["write_report"]

FIGURES: Final = {1: "Targets over the parameter", 2: "Contour lines"}
CORNER: Final = "Corner plot"
"""What is drawn of a stage, by the number of its free parameters."""


def write_report(
    result: Calibration,
    path: Path,
    *,
    command: str,
    drawings: Drawings,
) -> Path:
    """Write the report; `sections.add_section` adds to it later.

    Parameters
    ----------
    result : Calibration
        What to report.
    path : Path
        HTML file to write; replaced as a whole.
    command : str
        Command to repeat it.
    drawings : Drawings
        How a case directory is drawn.
    """
    environment = Environment(
        loader=PackageLoader("calibrate.report", "pages"),
        autoescape=True,
        undefined=StrictUndefined,
    )
    page = environment.get_template("report.html.j2")
    text = page.render(**_content(result, command, drawings))
    write_text(path, text)
    return path


def _content(result: Calibration, command: str, drawings: Drawings) -> dict[str, Any]:
    study, stages = result.study, result.stages
    intervals = [i for s in stages for levels in s.intervals.values() for i in levels.values()]
    return {
        "title": study.title,
        "summary": _summary(result),
        "published": any(one.published for one in study.parameters.values()),
        "parameters": [_parameter(result, s, key) for s in stages for key in s.freed.keys],
        "any_not_point": any(not s.verdict.is_point for s in stages),
        "any_open": any(i.open_low or i.open_high for i in intervals),
        "any_failed": bool((result.runs["status"] != "ok").any()),
        "intervals_image": _embed(interval_figure(study, stages)),
        "check_seeds": study.design.check_seeds,
        "check": [_check_row(row) for row in result.check],
        "stages": [_stage(result, s) for s in stages],
        "stage_sizes": sorted({s.posterior.size for s in stages}),
        # Comments that say where further sections and their links go.
        "links": Markup(LINKS_END),
        "extra": Markup(SECTIONS_END),
        "quality": [_quality(s, fit) for s in stages for fit in s.fits],
        "quality_image": _embed(quality_figure(stages)),
        "runs_sentence": _runs_sentence(result),
        "failures": _failures(result),
        "provenance": list(provenance(study, command).items()),
        "sources": list(result.data.sources),
        **gallery(_cases(result), drawings),
    }


def _embed(png: bytes) -> str:
    return "data:image/png;base64," + base64.b64encode(png).decode("ascii")


def _summary(result: Calibration) -> list[str]:
    missed = [row for row in result.check if row.significant]
    open_stages = [s.stage.title for s in result.stages if not s.verdict.is_point]
    sentences = []
    if open_stages:
        sentences.append(
            f"Not all targets can be met: see {', '.join(open_stages)}. The values found there "
            "are the most probable, and meet not every target."
        )
    else:
        sentences.append("In every stage the measured values can be met.")
    if missed:
        names = ", ".join(
            f"{row.label} ({row.deviation_percent:+.1f} %, z = {shown(row.z)})" for row in missed
        )
        sentences.append(
            f"At the found parameters the simulator itself still misses, by more than the errors "
            f"explain: {names}."
        )
    else:
        largest = max((abs(row.z) for row in result.check), default=math.nan)
        sentences.append(
            "At the found parameters the simulator meets every observable within its errors "
            f"(no z beyond {shown(largest).lstrip('+')})."
        )
    return sentences


def _parameter(result: Calibration, stage: StageResult, key: tuple[str, str]) -> dict[str, Any]:
    name, instance = key
    levels = stage.intervals[name]
    published = result.study.published_of(name, instance)
    return {
        "name": result.study.label(name, instance),
        "words": WORDS.get(name, ""),
        "value": f"{stage.found[name]:.3f}",
        "least_squares": f"{stage.least_squares[name]:.3f}",
        "is_point": stage.verdict.is_point,
        "interval_68": band(levels[0.68]),
        "interval_90": band(levels[0.90]),
        "published": "" if published is None else f"{published:.3f}",
    }


def _check_row(row: Any) -> dict[str, Any]:
    measured, simulated = pair((row.measured, row.measured_se), (row.simulated, row.simulated_se))
    remark = "" if row.used else "not used in the calibration"
    return {
        "name": row.name,
        "label": row.label,
        "measured": f"{measured} {row.unit}",
        "simulated": f"{simulated} {row.unit}" if row.seeds else "every run failed",
        "deviation": signed(row.deviation_percent, " %"),
        "z": shown(row.z),
        "large": row.significant,
        "remark": remark,
    }


def _stage(whole: Calibration, result: StageResult) -> dict[str, Any]:
    targets = "; ".join(_at_the_mark(fit) for fit in result.fits)
    return {
        "title": result.stage.title,
        "notes": whole.sentences(result),
        "alt": f"{FIGURES.get(result.posterior.size, CORNER)} of {result.stage.title}",
        "image": _embed(stage_figure(result)),
        "caption": targets + ".",
    }


def _at_the_mark(fit: TargetFit) -> str:
    unit = fit.target.simulated_unit
    return (
        f"{fit.target.label}: surrogate {plus_minus(fit.predicted, fit.predicted_sd)} {unit} at "
        f"the mark, measured {plus_minus(fit.measured.value, fit.measured.se)} {unit}, "
        f"z = {shown(fit.z)}"
    )


def _cases(result: Calibration) -> Iterator[tuple[str, Path | None]]:
    """Yield title and a run of the final check of every experiment."""
    runs = result.check_runs
    study = result.study
    for place in places_of(study.numbers):
        of = f" of {place.material}" if len(study.materials) > 1 else ""
        caption = study.experiments[place.experiment].caption
        title = f"{caption}, {place.surface} plate{of}, at the found parameters"
        good = runs[at_place(runs, place) & (runs["status"] == "ok")]
        yield title, Path(str(good["path"].iloc[0])) if len(good) else None


def _quality(stage: StageResult, fit: TargetFit) -> dict[str, Any]:
    quality = fit.surrogate.quality
    scale, value = fit.target.model_scale, fit.measured.value
    _, variance = fit.surrogate.average(stage.best[None])
    own = float(np.sqrt(variance[0])) / slope(scale, value)
    noise = fit.surrogate.noise_sd / slope(scale, value)
    return {
        "label": fit.target.label,
        "points": quality.points,
        "runs": quality.runs,
        "q2": f"{quality.q2:.2f}",
        "z_rms": f"{quality.z_rms:.2f}",
        "inflation": f"{quality.inflation:.2f}",
        "noise": f"{noise:.2g} {fit.target.simulated_unit}",
        "limit": "surrogate" if own > fit.measured.se else "measurement",
    }


def _runs_sentence(result: Calibration) -> str:
    runs = result.runs
    failed = int((runs["status"] != "ok").sum())
    hours = float(runs["wall_s"].sum()) / 3600.0
    cost = f"{hours:.1f} h" if hours >= 1.0 else f"{60 * hours:.0f} min"
    verb = "run failed" if failed == 1 else "runs failed"
    return f"{len(runs)} runs, {cost} of computing on one core; {failed} {verb}."


def _failures(result: Calibration) -> list[dict[str, Any]]:
    runs = result.runs[result.runs["status"] != "ok"]
    names = list(dict.fromkeys(label.partition(" ")[0] for label in result.parameters))
    return [
        {
            "experiment": f"{row['experiment']}, {row['surface']}",
            "parameters": ", ".join(f"{n}={row[n]:.3g}" for n in names if n in row),
            "seed": row["seed"],
            "failure": row["failure"],
            "reason": row["reason"],
            "path": row["path"],
            "log": row["log_tail"],
        }
        for row in runs.to_dict("records")
    ]
