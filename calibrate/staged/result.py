"""What a stage found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd

from calibrate.arrays import Array
from calibrate.inference import Interval
from calibrate.staged.crossing import Verdict
from calibrate.staged.problem import StagePosterior
from calibrate.staged.samples import Freed, Planned
from calibrate.staged.surrogates.emulated import TargetSurrogate
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
        Of a curve the mean over its levels, taken on the model scale.
    surrogate : TargetSurrogate
    predicted, predicted_sd : float
        Prediction at the found values and its error, in the target's unit; as `measured`.
    z : float
        Predicted minus measured, in standard errors of both together, as a normal deviate; of a
        curve where it is furthest off, as unlikely as that is among so many levels.
    """

    target: Target
    measured: Measured
    surrogate: TargetSurrogate
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
    best : (d,) float64
        Most probable point within all 68 % intervals, in the unit cube.
    found : mapping
        Parameter to its value there, in its own unit.
    intervals : mapping
        Parameter to level to interval, in the parameter's own unit; each holds the value.
    least_squares : mapping
        Parameter to its value where the sum of squared relative residuals is least (eq. 18).
    objective : float
        That sum.
    posterior : StagePosterior
    verdict : Verdict
    planned : tuple of Planned
        What was run.
    runs : DataFrame
        Results in the same order.
    undetermined : tuple of str
        Parameters on which the data say nothing, of a stage that frees three or more.
    """

    stage: Stage
    freed: Freed
    fits: tuple[TargetFit, ...]
    best: Array
    found: Mapping[str, float]
    intervals: Mapping[str, Mapping[float, Interval]]
    least_squares: Mapping[str, float]
    objective: float
    posterior: StagePosterior
    verdict: Verdict
    planned: tuple[Planned, ...]
    runs: pd.DataFrame
    undetermined: tuple[str, ...] = ()

    def samples(self, count: int, rng: np.random.Generator) -> Array:
        """Draw parameters from the posterior, (count, d) in their own units."""
        return self.freed.values(self.posterior.sample(count, rng))
