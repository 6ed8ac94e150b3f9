"""A joint calibration on the screen and, with the same words, in the report."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import pandas as pd
from rich.table import Table

from calibrate.questions.joint.check import CheckRow
from calibrate.questions.joint.result import JointResult
from calibrate.report.numbers import band, pair, signed
from calibrate.significance import deviation_percent, shown, significant
from calibrate.study.schema.targets import Target

__all__ = ["CheckWords", "UnknownWords", "check_words", "joint_tables", "unknown_words"]

NOT_DETERMINED = "not determined"


@dataclass(frozen=True)
class UnknownWords:
    """An unknown as a reader sees it.

    Attributes
    ----------
    name, value, interval_68, interval_90, staged, published : str
        What is not determined has neither value nor intervals, but says so. `staged` is what the
        stages of the study found, empty where they did not free it.
    determined : bool
    """

    name: str
    value: str
    interval_68: str
    interval_90: str
    staged: str
    published: str
    determined: bool


@dataclass(frozen=True)
class CheckWords:
    """A target of the final check as a reader sees it.

    Attributes
    ----------
    label, measured, predicted, simulated, z : str
    large : bool
        Whether the errors do not explain the deviation.
    """

    label: str
    measured: str
    predicted: str
    simulated: str
    z: str
    large: bool


def unknown_words(
    result: JointResult, staged: Mapping[str, float] | None = None
) -> list[UnknownWords]:
    """Return a row for every unknown.

    Parameters
    ----------
    result : JointResult
    staged : mapping, optional
        What stages of the same study found, by the study's label of a parameter.
    """
    found = []
    study = result.study
    labels = [study.label(*key) for key in study.free]
    values = {
        key: f"{staged[label]:.3g}" if staged and label in staged else ""
        for key, label in zip(result.posterior.names, labels, strict=False)
    }
    for name, row in result.table().iterrows():
        key, known = str(name), bool(row["determined"])
        spans = [result.posterior.interval(key, level) for level in (0.68, 0.90)]
        published = row["published"]
        found.append(
            UnknownWords(
                name=key,
                value=f"{row['best']:.4g}" if known else NOT_DETERMINED,
                interval_68=band(spans[0]) if known else "",
                interval_90=band(spans[1]) if known else "",
                staged=values.get(key, ""),
                published=f"{published:.3g}" if pd.notna(published) else "",
                determined=known,
            )
        )
    return found


def check_words(result: JointResult) -> list[CheckWords]:
    """Return a row for every target."""
    none = "every run failed" if result.checked else "not run"
    return [_check(row, result.study.target_named(row.name), none) for row in result.check]


def _check(row: CheckRow, target: Target, none: str) -> CheckWords:
    measured, predicted = pair((row.measured, row.measured_se), (row.predicted, row.predicted_sd))
    simulated, _ = pair((row.simulated, row.simulated_se), (row.measured, row.measured_se))
    unit = target.curve.x_unit if target.curve else ""
    where = f", at {row.level:g} {unit}" if math.isfinite(row.level) else ""
    return CheckWords(
        label=f"{row.label}{where}{'' if row.met else ' (not met)'}",
        measured=f"{measured} {row.unit}",
        predicted=predicted,
        simulated=simulated if row.seeds else none,
        z=shown(row.z),
        large=significant(row.z),
    )


def joint_tables(result: JointResult) -> list[Table]:
    """Return the unknowns with their intervals, and every target as measured and simulated."""
    unknowns = Table(title=f"{result.study.title}: all targets at once", title_justify="left")
    unknowns.add_column("unknown")
    words = unknown_words(result)
    known = ["published"] if any(one.published for one in words) else []
    for heading in ("value", "68 % interval", "90 % interval", *known):
        unknowns.add_column(heading, justify="right")
    for one in words:
        cells = (one.name, one.value, one.interval_68, one.interval_90, one.published)
        unknowns.add_row(*cells[: 4 + len(known)])
    seeds = result.study.design.check_seeds
    title = f"Check with the engine at these values, {seeds} seeds"
    check = Table(title=title if result.checked else "Expected", title_justify="left")
    check.add_column("target")
    for heading in ("measured", "posterior", "engine", "deviation", "z"):
        check.add_column(heading, justify="right")
    for row, said in zip(result.check, check_words(result), strict=True):
        deviation = signed(deviation_percent(row.simulated, row.measured), " %")
        check.add_row(said.label, said.measured, said.predicted, said.simulated, deviation, said.z)
    return [unknowns, check]
