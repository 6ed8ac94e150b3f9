"""Final check: the simulator itself at the found parameters, as Table B.8 of the paper."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from calibrate.runs.runner import Runner
from calibrate.staged.placed import at_place, placed
from calibrate.staged.significance import joint_dof, normal_score, significant
from calibrate.study.cases import Values, case_spec
from calibrate.study.measured.scalars import Measured
from calibrate.study.model import Study, places_of
from calibrate.study.places import Place

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

    @property
    def deviation_percent(self) -> float:
        """Simulated minus measured, in per cent of the measured value."""
        return 100.0 * (self.simulated / self.measured - 1.0)

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
    study: Study,
    measured: Mapping[str, Measured],
    values: Values,
    runner: Runner,
) -> tuple[list[CheckRow], pd.DataFrame]:
    """Simulate every experiment of the study at the found parameters with several seeds.

    Parameters
    ----------
    study : Study
        The study; ``check_seeds`` of its design says how many seeds.
    measured : mapping
        Measured values by target name.
    values : mapping
        Found parameters by name and instance.
    runner : Runner
        Runs cases.

    Returns
    -------
    rows : list of CheckRow
        One per measured number, in the study's order.
    runs : DataFrame
        The runs, with the study's name of material and surface.
    """
    seeds = range(study.design.check_seeds)
    places = [place for place in places_of(study.numbers) for _ in seeds]
    specs = [
        case_spec(study, place, values, study.run.seed + CHECK_SEED + i)
        for place, i in zip(places, [*seeds] * len(places), strict=False)
    ]
    runs = placed(runner(specs, "Final check at the found parameters"), places)
    used = {name for stage in study.stages for name in stage.targets}
    rows = []
    for target in study.numbers:
        at = Place(target.material, target.surface, target.experiment)
        here = runs[at_place(runs, at) & (runs["status"] == "ok")]
        known = target.observable in here.columns
        shown = here[target.observable].dropna().to_numpy(float) if known else np.empty(0)
        mean, error = _mean_and_error(list(shown))
        fact = measured[target.name]
        rows.append(
            CheckRow(
                name=target.name,
                label=target.label,
                unit=target.simulated_unit,
                used=target.name in used,
                measured=fact.value,
                measured_se=fact.se,
                repeats=fact.repeats,
                simulated=mean,
                simulated_se=error,
                seeds=len(shown),
            )
        )
    return rows, runs


def _mean_and_error(values: Sequence[float]) -> tuple[float, float]:
    """Return mean and standard error; the error of a single value is not known (nan)."""
    if not values:
        return float("nan"), float("nan")
    mean = float(np.mean(values))
    if len(values) == 1:
        return mean, float("nan")
    return mean, float(np.std(values, ddof=1) / np.sqrt(len(values)))
