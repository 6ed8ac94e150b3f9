"""Which unknowns move a number over their whole ranges: Sobol indices of an uncertain function.

The function is known as well as an emulator knows it. Its expected values give the indices; draws
of its error say how far they may be off, and how large an index that error alone would make.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from SALib.analyze import sobol as analysis
from SALib.sample import sobol as sampling

from calibrate.arrays import Array

__all__ = ["Indices", "sobol"]

POINTS: Final = 1024
"""Base points of the expected values, a power of two; 2 + K times as many are evaluated."""
FEW: Final = 128
DRAWS: Final = 100
"""Base points at which the error is drawn, jointly, and how often."""
LEVEL: Final = 0.9
RESAMPLES: Final = 200
"""Bootstrap samples behind the error of sampling."""


@dataclass(frozen=True)
class Indices:
    """Sobol indices of one output by K inputs.

    Attributes
    ----------
    first, total : (K,) float64
        Share of the variance by an input alone, and with all that it does together with others.
    first_span, total_span : (K, 2) float64
        90 % intervals: sampling and the function's error together.
    made : (K,) float64
        Total index that the function's error alone makes in one of ten cases; a smaller one means
        nothing.
    variance : float
        Of the expected values over the ranges.
    error_share : float
        Variance of the error over that of the function with its error.
    """

    first: Array
    total: Array
    first_span: Array
    total_span: Array
    made: Array
    variance: float
    error_share: float


def sobol(
    mean: Callable[[Array], Array],
    errors: Callable[[Array, int], Array],
    size: int,
    rng: np.random.Generator,
) -> Indices:
    """Return the Sobol indices of a function of the unit cube, all inputs uniform.

    Parameters
    ----------
    mean : callable
        Points (n, K) to expected values (n,), which must not all be equal.
    errors : callable
        Points (n, K) and a number D to draws of the error, jointly at all points, (D, n).
    size : int
        K.
    rng : numpy Generator

    References
    ----------
    Saltelli et al. 2010, Comput. Phys. Commun. 181, 259-270 (estimators, by SALib). Le Gratiet,
    Cannamela and Iooss 2014, SIAM/ASA J. Uncertainty Quantification 2, 336-363 (draws of the
    emulator).
    """
    problem = {"num_vars": size, "names": list(map(str, range(size))), "bounds": [[0, 1]] * size}
    y = mean(_points(problem, POINTS, rng))
    # SALib takes a seed of zero for none.
    found = analysis.analyze(
        problem, y, calc_second_order=False, num_resamples=RESAMPLES, conf_level=LEVEL,
        seed=int(rng.integers(1, 2**31)),
    )  # fmt: skip
    few = _points(problem, FEW, rng)
    expected, error = mean(few), errors(few, DRAWS)
    spans = {}
    ends = (0.5 - 0.5 * LEVEL, 0.5 + 0.5 * LEVEL)
    for name, estimate in (("S1", analysis.first_order), ("ST", analysis.total_order)):
        at_mean = _estimates(estimate, expected[None], size)
        moved = _estimates(estimate, expected + error, size) - at_mean
        low, high = np.quantile(moved, ends, axis=0)
        below = np.hypot(found[f"{name}_conf"], np.minimum(low, 0.0))
        above = np.hypot(found[f"{name}_conf"], np.maximum(high, 0.0))
        span = np.column_stack([found[name] - below, found[name] + above])
        spans[name] = np.clip(span, 0.0, 1.0)
    return Indices(
        np.clip(found["S1"], 0.0, 1.0),
        np.clip(found["ST"], 0.0, 1.0),
        spans["S1"],
        spans["ST"],
        _made(expected, error, size),
        float(np.var(y)),
        float(np.mean(error**2) / (np.var(y) + np.mean(error**2))),
    )


def _points(problem: dict[str, Any], count: int, rng: np.random.Generator) -> Array:
    """Return Saltelli's points, ((K + 2) * count, K): A, A with one column of B each, B."""
    return np.asarray(sampling.sample(problem, count, calc_second_order=False, seed=rng))


def _estimates(estimate: Callable[..., Array], y: Array, size: int) -> Array:
    """Return an index of every input for every draw, (D, K), from values (D, n)."""
    parts = y.reshape(len(y), -1, size + 2)
    parts = parts - parts.mean(axis=(1, 2), keepdims=True)  # first-order shares want it so
    first, last = parts[:, :, 0].T, parts[:, :, -1].T
    return np.column_stack([estimate(first, parts[:, :, 1 + k].T, last) for k in range(size)])


def _made(expected: Array, error: Array, size: int) -> Array:
    """Return the total index that the error makes by itself, exceeded in one of ten draws, (K,)."""
    parts = error.reshape(len(error), -1, size + 2)
    steps = np.mean((parts[:, :, :1] - parts[:, :, 1:-1]) ** 2, axis=1)  # (D, K)
    total = np.var(expected + error, axis=1)
    return np.asarray(np.quantile(0.5 * steps / total[:, None], LEVEL, axis=0))
