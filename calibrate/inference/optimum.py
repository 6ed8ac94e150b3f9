"""The values that are printed as the result: in the middle of what is probable."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np
from scipy import optimize

from calibrate.arrays import Array
from calibrate.inference.intervals import LEVELS
from calibrate.inference.posterior import interval_of
from calibrate.inference.sampler.target import Target
from calibrate.inference.space import Space

__all__ = ["best_values"]

_STEP: Final = 1e-3  # of a posterior deviation
_ITERATIONS: Final = 40
_STARTS: Final = 500  # samples among which the start is looked for


def best_values(target: Target, samples: Array) -> Array:
    """Return the medians, (K,), where they are probable together, else the most probable values.

    Medians are the better guess of every value alone, and rarely a worse one of what follows from
    all of them (`benchmarks/joint_planted.py`). Where probability lies in several regions or along
    a bent ridge the medians may lie where there is none: they count as probable when they are so at
    least as much as a draw of normal probability on average, K/2 nats below the best. Otherwise
    these are the most probable values that lie in every printed 68 % interval. Wider intervals
    contain the 68 % ones, so the point lies in every interval that is given with it.

    Parameters
    ----------
    target : Target
    samples : (n, K) float64
        Values of equal weight.
    """
    space = target.problem.space
    units = space.units(samples)
    low, high = _box(space, samples)

    def score(x: Array) -> Array:
        values = space.values_of(np.clip(x, low, high))
        return np.asarray(target.log_likelihood(values) + space.log_density(values))

    middle = np.clip(np.median(units, axis=0), low, high)
    x = _most_probable(score, np.clip(units[:_STARTS], low, high), units.std(axis=0), (low, high))
    if np.diff(score(np.stack([x, middle])))[0] > -0.5 * space.size:
        x = middle
    ends = [_box_values(space, samples, i) for i in range(space.size)]
    best = space.values_of(x[None])[0]
    # The way from units to values and back may cost the last digit at an end of an interval.
    return np.array([np.clip(v, *end) for v, end in zip(best, ends, strict=True)])


def _most_probable(
    score: Callable[[Array], Array], starts: Array, spread: Array, box: tuple[Array, Array]
) -> Array:
    """Return the point of a box, (K,), where the score is highest, from the best of the starts."""
    low, high = box
    width = np.maximum(spread, np.finfo(float).eps)

    def fall(x: Array) -> tuple[float, Array]:
        ahead = np.minimum(x + _STEP * width, high)
        behind = np.maximum(x - _STEP * width, low)
        points = np.concatenate([x[None], _one_by_one(x, ahead), _one_by_one(x, behind)])
        f = score(points)
        span = np.maximum(ahead - behind, np.finfo(float).tiny)
        slope = (f[1 : 1 + len(x)] - f[1 + len(x) :]) / span
        return -float(f[0]), -slope * width

    found = optimize.minimize(
        lambda s: fall(s * width),
        starts[int(np.argmax(score(starts)))] / width,
        jac=True,
        method="L-BFGS-B",
        bounds=list(zip(low / width, high / width, strict=True)),
        options={"maxiter": _ITERATIONS},
    )
    return np.asarray(np.clip(found.x * width, low, high))


def _one_by_one(x: Array, moved: Array) -> Array:
    """Return copies of x, (K, K), with one coordinate moved in each."""
    return np.where(np.eye(len(x), dtype=bool), moved, x)


def _box_values(space: Space, samples: Array, column: int) -> tuple[float, float]:
    """Return where a value may lie: in its 68 % interval, or among its samples for a nuisance."""
    if column in space.asked:
        span = interval_of(space, samples, column, LEVELS[0])
        return span.low, span.high
    return float(samples[:, column].min()), float(samples[:, column].max())


def _box(space: Space, samples: Array) -> tuple[Array, Array]:
    """Return the ends of all `_box_values` on the unit ranges."""
    ends = np.array([_box_values(space, samples, i) for i in range(space.size)])
    return space.units(ends[None, :, 0])[0], space.units(ends[None, :, 1])[0]
