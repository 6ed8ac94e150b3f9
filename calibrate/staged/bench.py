"""What all steps of a stage share, before its runs and after they have surrogates."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.emulator.types import Inputs
from calibrate.inference import Problem
from calibrate.scales import backward, forward, slope
from calibrate.significance import joint_dof, normal_score
from calibrate.staged.earlier import Earlier
from calibrate.staged.optimum import minimise, relative_residuals
from calibrate.staged.problem import (
    StagePosterior,
    common_covariance,
    posterior_of,
    stage_problem,
    with_errors_at,
)
from calibrate.staged.samples import Freed
from calibrate.staged.surrogates.emulated import TargetSurrogate
from calibrate.study.data import StudyData
from calibrate.study.measured.scalars import Measured
from calibrate.study.schema.stages import Stage
from calibrate.study.schema.targets import Target

__all__ = ["Bench", "Fitted"]

FAR: Final = 5.0
"""Standard deviations beyond which no surrogate error is a likely reason."""


@dataclass(frozen=True)
class Bench:
    """A stage before its runs.

    Attributes
    ----------
    data : StudyData
    stage : Stage
    freed : Freed
    earlier : Earlier
        Result of the stages before.
    """

    data: StudyData
    stage: Stage
    freed: Freed
    earlier: Earlier

    @property
    def targets(self) -> list[Target]:
        """Targets of the stage."""
        return [self.data.study.target_named(name) for name in self.stage.targets]

    def levels(self, target: Target) -> Array:
        """Return the measured values of a target at its levels, (L,); a number has one."""
        if target.is_curve:
            return self.data.curves[target.name].values
        return np.array([self.data.scalars[target.name].value])

    def measured(self, target: Target) -> Measured:
        """Return a measured target; of a curve the mean over its levels on the model scale."""
        if not target.is_curve:
            return self.data.scalars[target.name]
        curve, scale = self.data.curves[target.name], target.model_scale
        value = float(backward(scale, np.mean(forward(scale, curve.values), keepdims=True))[0])
        steps = np.array([slope(scale, float(one)) for one in curve.values])
        error = math.sqrt(float(np.sum((curve.se * steps) ** 2))) / len(steps)
        return Measured(value, error / slope(scale, value), curve.repeats, curve.source)


@dataclass(frozen=True, eq=False)
class Fitted:
    """A stage whose runs have surrogates.

    Attributes
    ----------
    bench : Bench
    surrogates : tuple of TargetSurrogate
        In the order of the targets.
    """

    bench: Bench
    surrogates: tuple[TargetSurrogate, ...]

    @property
    def problem(self) -> Problem:
        """The stage for the common likelihood."""
        bench = self.bench
        return stage_problem(bench.data, bench.targets, bench.freed, self.surrogates, bench.earlier)

    def averages(self, u: Array) -> Array:
        """Return the predicted targets in their units, (k, j), at points (k, d)."""
        pairs = zip(self.bench.targets, self.surrogates, strict=True)
        return np.column_stack(
            [backward(target.model_scale, one.average(u)[0]) for target, one in pairs]
        )

    def least_squares(self) -> tuple[Array, float]:
        """Return point and sum of the least squares of eq. 18; a curve counts as one target."""

        def residuals(u: Array) -> Array:
            columns = []
            for target, one in zip(self.bench.targets, self.surrogates, strict=True):
                measured = self.bench.levels(target)
                predicted = backward(target.model_scale, one.predict(Inputs.at(u)).mean)
                columns.append(relative_residuals(predicted, measured) / math.sqrt(len(measured)))
            return np.concatenate(columns, axis=1)

        return minimise(residuals, len(self.bench.freed.keys))

    def posterior(self, rng: np.random.Generator) -> StagePosterior:
        """Return the posterior of the free parameters."""
        problem, (optimum, _) = self.problem, self.least_squares()
        if max(np.abs(t).max() for t, _ in self._ratios(problem, optimum)) > FAR:
            problem = with_errors_at(problem, optimum)
        return posterior_of(problem, self.bench.freed, rng)

    def z(self, u: Array) -> list[Array]:
        """Return predicted minus measured at a point, (L,) for each target, as normal deviates."""
        return [
            np.array([normal_score(float(t), one) for t, one in zip(ratio, dof, strict=True)])
            for ratio, dof in self._ratios(self.problem, u)
        ]

    def _ratios(self, problem: Problem, u: Array) -> Sequence[tuple[Array, list[float]]]:
        """Return predicted minus measured over the errors, and their degrees of freedom."""
        found = []
        for place in problem.places:
            (reading,) = place.readings
            prediction = place.emulator.predict(Inputs.at(u[None]))
            own = prediction.total[0] + np.diag(common_covariance(reading))
            ratio = (prediction.mean[0] - reading.y) / np.sqrt(own + reading.se**2)
            known = math.inf if reading.repeats == 0 else reading.repeats - 1.0
            dof = [
                joint_dof((float(se), known), (math.sqrt(rest), math.inf))
                for se, rest in zip(reading.se, own, strict=True)
            ]
            found.append((ratio, dof))
        return found
