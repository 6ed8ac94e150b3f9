"""Search for the hyperparameters of a covariance: largest posterior density, exact gradients.

The priors are weak and say what is usual of outputs with unit variance over unit ranges: some
bends over a range, not hundreds; some per cent of noise, not exactly none. They matter with fewer
runs than ten per input, where the likelihood alone would take luck for landscape.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.linalg import lapack
from scipy.optimize import minimize

from calibrate.arrays import Array
from calibrate.emulator.covariance import Design, Hyper, covariance, fixed, gradient

__all__ = ["Task", "objective", "search", "task_of"]


@dataclass(frozen=True)
class _Kind:
    """Prior and limits of the logarithm of a hyperparameter.

    Attributes
    ----------
    centre, spread : float
        Normal prior of the logarithm about that of `centre`.
    low, high : float
    """

    centre: float
    spread: float
    low: float
    high: float


LENGTH: Final = _Kind(1.5, 0.7, 0.1, 30.0)
SURFACE: Final = _Kind(0.5, 1.5, 1e-4, 1e2)
BEND: Final = _Kind(0.05, 1.5, 1e-5, 1e2)
OFFSET: Final = _Kind(0.02, 2.0, 1e-7, 2.0)
NOISE: Final = _Kind(0.05, 2.5, 1e-7, 4.0)
SHORT: Final = 0.4
"""Second start: lengths as short as this, in case the first ends in a plane and noise."""
STEPS: Final = 200
GRID: Final = 50
"""Logarithms lie on fiftieths: far finer than runs tell them. Where a search ends is the
processor's in the fifth digit, now and then, and other digits become other runs."""
OFFSET_AT: Final = -2
"""Place of the offset among the hyperparameters; the noise is the last."""


@dataclass(frozen=True)
class Task:
    """What a likelihood is computed from.

    Attributes
    ----------
    design : Design
    y : (n,) float64
        Standardised.
    trend : (n, n) float64
        `fixed` of the design.
    same : (n, n) bool
        `Design.same_seed`.
    free : (p,) bool
        Which entries are searched for.
    start, spread, low, high : (p,) float64
        Of logarithms; the start is also the centre of the prior.
    """

    design: Design
    y: Array
    trend: Array
    same: Array
    free: Array
    start: Array
    spread: Array
    low: Array
    high: Array


def _unpack(theta: Array, inputs: int) -> Hyper:
    values = np.exp(theta)
    return Hyper(
        values[:inputs],
        float(values[inputs]),
        values[inputs + 1 : -2],
        float(values[-2]),
        float(values[-1]),
    )


def objective(free: Array, task: Task) -> tuple[float, Array]:
    """Return minus the log posterior density and its gradient."""
    theta = task.start.copy()
    theta[task.free] = free
    hyper = _unpack(theta, task.design.u.shape[1])
    total, parts = covariance(hyper, task.design, task.trend, task.same)
    total[np.diag_indices_from(total)] += hyper.noise
    factor, failed = lapack.dpotrf(total, lower=1, overwrite_a=1)
    if failed:
        return 1e25, np.zeros_like(free)
    log_determinant = 2.0 * np.log(np.diag(factor)).sum()
    inverse, _ = lapack.dpotri(factor, lower=1, overwrite_c=1)
    inverse = np.tril(inverse)
    inverse += np.tril(inverse, -1).T
    weights = inverse @ task.y
    value = 0.5 * (task.y @ weights + log_determinant)
    inverse -= np.multiply.outer(weights, weights)
    slopes = gradient(hyper, task.design, parts, inverse)
    spread = task.spread[task.free]
    away = (free - task.start[task.free]) / spread
    value += 0.5 * float(away @ away)
    return float(value), slopes[task.free] + away / spread


def task_of(design: Design, y: Array) -> Task:
    """Return what the likelihood of runs is computed from.

    Parameters
    ----------
    design : Design
        n runs.
    y : (n,) float64
        Outputs with zero mean and unit variance.
    """
    inputs, effects = design.u.shape[1], design.strengths.shape[1]
    kinds = [LENGTH] * inputs + [SURFACE] + [BEND] * effects + [OFFSET, NOISE]
    start, same = np.log([kind.centre for kind in kinds]), design.same_seed
    free = np.full(len(kinds), fill_value=True)
    if int(same.sum()) == len(y):  # no two runs share a seed: offsets are part of the noise
        free[OFFSET_AT], start[OFFSET_AT] = False, -np.inf
    return Task(
        design,
        y,
        fixed(design),
        same,
        free,
        start,
        np.array([kind.spread for kind in kinds]),
        np.log([kind.low for kind in kinds]),
        np.log([kind.high for kind in kinds]),
    )


def search(design: Design, y: Array) -> Hyper:
    """Return the most probable hyperparameters.

    Parameters
    ----------
    design : Design
        n runs.
    y : (n,) float64
        Outputs with zero mean and unit variance.
    """
    task, inputs = task_of(design, y), design.u.shape[1]
    limits = list(zip(task.low[task.free], task.high[task.free], strict=True))
    short = task.start.copy()
    short[:inputs] = np.log(SHORT)
    found = [
        minimize(
            objective,
            begin[task.free],
            (task,),
            jac=True,
            method="L-BFGS-B",
            bounds=limits,
            options={"maxiter": STEPS},
        )
        for begin in (task.start, short)
    ]
    theta = task.start.copy()
    best = min(found, key=lambda one: float(one.fun)).x
    on_grid = np.round(best * GRID) / GRID
    theta[task.free] = np.clip(on_grid, task.low[task.free], task.high[task.free])
    return _unpack(theta, inputs)
