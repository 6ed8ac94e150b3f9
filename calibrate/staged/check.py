"""Final check: the simulator itself at the found parameters, as Table B.8 of the paper."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from calibrate.questions.core.forms import Emulated
from calibrate.questions.core.from_study import forms_of, levels_of, place_of
from calibrate.questions.core.runs import CurveReader, make_runs, read_stored_curve
from calibrate.runs.runner import Runner
from calibrate.significance import deviation_percent, joint_dof, normal_score, significant
from calibrate.staged.placed import at_place, placed
from calibrate.study.cases import Values, case_spec
from calibrate.study.data import StudyData
from calibrate.study.measured.scalars import Measured
from calibrate.study.model import places_of
from calibrate.study.schema.targets import Target

__all__ = ["CHECK_SEED", "CheckRow", "run_check"]

CHECK_SEED = 900_000  # far from the seeds of the stages: the check sees runs no fit has seen
FEWEST = 2  # runs that tell a scatter


@dataclass(frozen=True)
class CheckRow:
    """Measured and simulated value of one target at the found parameters.

    Attributes
    ----------
    name, label, unit : str
        As in the study.
    used : bool
        Whether a stage uses the target.
    measured, measured_se : float
        Mean and its standard error.
    repeats : int
        Measurements behind that error; 0 where it is not said, and the error counts as known.
    simulated, simulated_se : float
        Mean over seeds and its standard error; nan when every run failed.
    seeds : int
        Runs behind the mean.
    level : float
        Of a curve, where it is furthest off; nan for a number.
    """

    name: str
    label: str
    unit: str
    used: bool
    measured: float
    measured_se: float
    repeats: int
    simulated: float
    simulated_se: float
    seeds: int
    level: float = math.nan

    @property
    def deviation_percent(self) -> float:
        """Simulated minus measured, in per cent of the size of the measured value."""
        return deviation_percent(self.simulated, self.measured)

    @property
    def z(self) -> float:
        """Simulated minus measured in standard errors of both, as a normal deviate.

        Standard errors of few runs and repeats are uncertain themselves; the ratio follows
        Student's distribution, and is turned into the normal deviate of equal probability.
        """
        if self.seeds < FEWEST:
            return math.nan
        both = math.hypot(self.measured_se, self.simulated_se)
        known = math.inf if self.repeats < FEWEST else self.repeats - 1.0
        dof = joint_dof((self.measured_se, known), (self.simulated_se, self.seeds - 1.0))
        return normal_score((self.simulated - self.measured) / both, dof)

    @property
    def significant(self) -> bool:
        """Whether `z` is more than the errors explain."""
        return significant(self.z)


def run_check(
    data: StudyData,
    values: Values,
    runner: Runner,
    read: CurveReader = read_stored_curve,
) -> tuple[list[CheckRow], pd.DataFrame]:
    """Simulate every experiment of the study at the found parameters with several seeds.

    Parameters
    ----------
    data : StudyData
        The study, whose ``check_seeds`` say how many seeds, and what was measured.
    values : mapping
        Found parameters by name and instance.
    runner : Runner
        Runs cases.
    read : CurveReader
        Reads curves of finished cases.

    Returns
    -------
    rows : list of CheckRow
        One per target, in the study's order; of a curve where it is furthest off.
    runs : DataFrame
        The runs, with the study's name of material and surface.
    """
    study = data.study
    seeds = range(study.design.check_seeds)
    places = [place for place in places_of(study.targets) for _ in seeds]
    specs = [
        case_spec(study, place, values, study.run.seed + CHECK_SEED + i)
        for place, i in zip(places, [*seeds] * len(places), strict=False)
    ]
    label = "Final check at the found parameters"
    runs = placed(make_runs(specs, label, runner, forms_of(data), read).table, places)
    used = {name for stage in study.stages for name in stage.targets}
    rows = []
    for target in study.targets:
        here = runs[at_place(runs, place_of(target)) & (runs["status"] == "ok")]
        levels = [
            _row(target, column, fact, here, level, used=target.name in used)
            for column, level, fact in _facts(data, target)
        ]
        rows.append(max(levels, key=lambda row: abs(row.z) if math.isfinite(row.z) else -1.0))
    return rows, runs


def _facts(data: StudyData, target: Target) -> list[tuple[str, float, Measured]]:
    """Return column in a table of runs, level and measured value of each number of a target."""
    if not target.is_curve:
        return [(target.observable, math.nan, data.scalars[target.name])]
    curve, levels = data.curves[target.name], levels_of(data, target)
    where = Emulated(target.observable, target.model_scale, slice(0, len(levels)), levels)
    return [
        (column, level, Measured(float(value), float(se), curve.repeats, curve.source))
        for column, level, value, se in zip(
            where.table_columns, levels, curve.values, curve.se, strict=True
        )
    ]


def _row(
    target: Target, column: str, fact: Measured, here: pd.DataFrame, level: float, *, used: bool
) -> CheckRow:
    """Return the row of one number; `here` are the runs that can show it."""
    known = column in here.columns
    shown = here[column].dropna().to_numpy(float) if known else np.empty(0)
    mean, error = _mean_and_error(list(shown))
    at = (
        "" if math.isnan(level) else f", at {level:g} {target.curve.x_unit if target.curve else ''}"
    )
    return CheckRow(
        name=target.name,
        label=f"{target.label}{at}",
        unit=target.simulated_unit,
        used=used,
        measured=fact.value,
        measured_se=fact.se,
        repeats=fact.repeats,
        simulated=mean,
        simulated_se=error,
        seeds=len(shown),
        level=level,
    )


def _mean_and_error(values: Sequence[float]) -> tuple[float, float]:
    """Return mean and standard error; the error of a single value is not known (nan)."""
    if not values:
        return float("nan"), float("nan")
    mean = float(np.mean(values))
    if len(values) == 1:
        return mean, float("nan")
    return mean, float(np.std(values, ddof=1) / np.sqrt(len(values)))
