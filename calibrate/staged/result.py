"""What a stage found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd

from calibrate.arrays import Array
from calibrate.staged.crossing import Verdict
from calibrate.staged.design import from_unit
from calibrate.staged.posterior import Interval, Posterior
from calibrate.staged.samples import Freed, Planned
from calibrate.staged.surface import Surrogate
from calibrate.study.measured.scalars import Measured
from calibrate.study.schema.stages import Stage
from calibrate.study.schema.targets import Target

__all__ = ["StageResult", "TargetFit"]


@dataclass(frozen=True)
class TargetFit:
    """A target of a stage with its surrogate and what it says at the found values.

    Attributes
    ----------
    target : Target
    measured : Measured
    surrogate : Surrogate
    predicted, predicted_sd : float
        Prediction at the found values and its error, in the target's unit.
    z : float
        Predicted minus measured, in standard errors of both together.
    """

    target: Target
    measured: Measured
    surrogate: Surrogate
    predicted: float
    predicted_sd: float
    z: float


@dataclass(frozen=True)
class StageResult:
    """Result of a stage.

    Attributes
    ----------
    stage : Stage
    freed : Freed
    fits : tuple of TargetFit
        In the order of the stage's targets.
    best : (2,) float64
        Most probable point within all intervals, in the unit square; see `Posterior.best`.
    found : mapping
        Parameter to its value there, in its own unit.
    intervals : mapping
        Parameter to level to interval, in the parameter's own unit; each holds the value.
    least_squares : mapping
        Parameter to its value where the sum of squared relative residuals is least (eq. 18).
    objective : float
        That sum.
    posterior : Posterior
    verdict : Verdict
    planned : tuple of Planned
        What was run.
    runs : DataFrame
        Results in the same order.
    """

    stage: Stage
    freed: Freed
    fits: tuple[TargetFit, ...]
    best: Array
    found: Mapping[str, float]
    intervals: Mapping[str, Mapping[float, Interval]]
    least_squares: Mapping[str, float]
    objective: float
    posterior: Posterior
    verdict: Verdict
    planned: tuple[Planned, ...]
    runs: pd.DataFrame

    def samples(self, count: int, rng: np.random.Generator) -> Array:
        """Draw parameters from the posterior, (count, 2) in their own units."""
        return from_unit(self.posterior.sample(count, rng), self.freed.bounds)
