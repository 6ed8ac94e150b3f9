"""A joint calibration on the screen and, with the same words, in the report."""

from __future__ import annotations

import math
from dataclasses import dataclass

import pandas as pd
from rich.table import Table

from calibrate.questions.joint.check import CheckRow
from calibrate.questions.joint.result import JointResult
from calibrate.report.numbers import band, pair, signed
from calibrate.significance import shown, significant

__all__ = ["CheckWords", "UnknownWords", "check_words", "joint_tables", "unknown_words"]

NOT_DETERMINED = "not determined"


@dataclass(frozen=True)
class UnknownWords:
    """An unknown as a reader sees it.

    Attributes
    ----------
    name, value, interval_68, interval_90, published : str
        What is not determined has neither value nor intervals, but says so.
    determined : bool
    """

    name: str
    value: str
    interval_68: str
    interval_90: str
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


def unknown_words(result: JointResult) -> list[UnknownWords]:
    """Return a row for every unknown."""
    found = []
    table = result.table()
    for name, row in table.iterrows():
        key = str(name)
        published = row["published"]
        number = f"{published:.3g}" if pd.notna(published) else ""
        if not row["determined"]:
            found.append(UnknownWords(key, NOT_DETERMINED, "", "", number, determined=False))
            continue
        narrow, wide = (band(result.posterior.interval(key, level)) for level in (0.68, 0.90))
        value = f"{row['best']:.4g}"
        found.append(UnknownWords(key, value, narrow, wide, number, determined=True))
    return found


def check_words(result: JointResult) -> list[CheckWords]:
    """Return a row for every target."""
    return [_check(row) for row in result.check]


def _check(row: CheckRow) -> CheckWords:
    measured, predicted = pair((row.measured, row.measured_se), (row.predicted, row.predicted_sd))
    simulated, _ = pair((row.simulated, row.simulated_se), (row.measured, row.measured_se))
    where = f" at {row.level:g}" if math.isfinite(row.level) else ""
    return CheckWords(
        label=f"{row.label}{where}",
        measured=f"{measured} {row.unit}",
        predicted=predicted,
        simulated=simulated if row.seeds else "every run failed",
        z=shown(row.z),
        large=significant(row.z),
    )


def joint_tables(result: JointResult) -> list[Table]:
    """Return the unknowns with their intervals, and every target as measured and simulated."""
    unknowns = Table(title=f"{result.study.title}: all targets at once", title_justify="left")
    unknowns.add_column("unknown")
    for heading in ("value", "68 % interval", "90 % interval", "published"):
        unknowns.add_column(heading, justify="right")
    for one in unknown_words(result):
        unknowns.add_row(one.name, one.value, one.interval_68, one.interval_90, one.published)
    seeds = result.study.design.check_seeds
    check = Table(
        title=f"Check with the engine at these values, {seeds} seeds", title_justify="left"
    )
    check.add_column("target")
    for heading in ("measured", "posterior", "engine", "deviation", "z"):
        check.add_column(heading, justify="right")
    for row, words in zip(result.check, check_words(result), strict=True):
        percent = 100.0 * (row.simulated - row.measured) / row.measured if row.measured else None
        deviation = "" if percent is None else signed(percent, " %")
        check.add_row(
            words.label, words.measured, words.predicted, words.simulated, deviation, words.z
        )
    return [unknowns, check]
