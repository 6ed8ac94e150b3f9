"""Emulators whose every answer is known in closed form, and problems made of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy import stats

from calibrate.arrays import Array
from calibrate.emulator.types import Inputs, Prediction
from calibrate.inference.priors import Prior
from calibrate.inference.problem import Place, Problem, Reading, Source
from calibrate.inference.space import Space, Unknown


@dataclass(frozen=True)
class LinearEmulator:
    """y = offset + slopes u + effects strengths, known up to a variance and factors."""

    slopes: Array  # (M, d)
    offset: Array  # (M,)
    variance: Array  # (M,)
    factors: Array  # (M, F)
    effects: Array = field(default_factory=lambda: np.zeros((0, 0)))  # (M, m)

    def predict(self, inputs: Inputs) -> Prediction:
        """Return the same uncertainty everywhere."""
        n = len(inputs.u)
        mean = self.offset + inputs.u @ self.slopes.T
        if self.effects.size:
            mean = mean + inputs.strengths @ self.effects.T
        return Prediction(
            mean,
            np.repeat(self.variance[None], n, axis=0),
            np.repeat(self.factors[None], n, axis=0),
        )


@dataclass(frozen=True)
class CurvedEmulator:
    """Any function of the inputs, known exactly."""

    function: Callable[[Array], Array]  # (n, d) -> (n, M)

    def predict(self, inputs: Inputs) -> Prediction:
        """Return no uncertainty."""
        mean = self.function(inputs.u)
        return Prediction(mean, np.zeros_like(mean), np.zeros((*mean.shape, 0)))


def linear(slopes, variance=0.0, factors=None) -> LinearEmulator:
    slopes = np.atleast_2d(np.asarray(slopes, dtype=float))
    rows = len(slopes)
    return LinearEmulator(
        slopes,
        np.zeros(rows),
        np.full(rows, variance),
        np.zeros((rows, 0)) if factors is None else np.asarray(factors),
    )


def scalars(y, se, repeats=0, shared=()) -> tuple[Reading, ...]:
    """Return a reading for each number."""
    return tuple(
        Reading(f"t{k}", slice(k, k + 1), np.array([v]), np.array([s]), repeats, tuple(shared))
        for k, (v, s) in enumerate(zip(y, se, strict=True))
    )


def normal_space(size: int, more: tuple[Unknown, ...] = ()) -> Space:
    """Return unknowns with unit-normal priors."""
    own = tuple(Unknown(f"x{i}", "", Prior.normal(0.0, 1.0)) for i in range(size))
    return Space((*own, *more))


def box_space(size: int) -> Space:
    """Return unknowns with flat priors on [0, 1]."""
    return Space(tuple(Unknown(f"x{i}", "", Prior.uniform(0.0, 1.0)) for i in range(size)))


def direct(size: int) -> tuple[Source, ...]:
    """Return the unknowns as they are."""
    return tuple(Source(i) for i in range(size))


def problem_of(space: Space, emulator, readings, size: int | None = None) -> Problem:
    sources = direct(space.size if size is None else size)
    return Problem(space, (Place("here", emulator, sources, (), tuple(readings)),))


def exact(slopes: Array, y: Array, cov: Array) -> tuple[Array, Array, float]:
    """Return mean, covariance and log evidence under a unit-normal prior."""
    inverse = np.linalg.inv(cov)
    posterior = np.linalg.inv(slopes.T @ inverse @ slopes + np.eye(slopes.shape[1]))
    total = cov + slopes @ slopes.T
    evidence = float(stats.multivariate_normal.logpdf(y, np.zeros(len(y)), total))
    return posterior @ slopes.T @ inverse @ y, posterior, evidence
