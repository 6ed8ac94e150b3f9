"""The parameters that come nearest to all targets of a stage."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy import ndimage
from scipy.optimize import minimize

from calibrate.arrays import Array
from calibrate.staged.posterior import Posterior

__all__ = ["best_point", "minimise", "relative_residuals"]

GRID = 101
STARTS = 12
SAME = 1e-6  # a tenth of a per cent in every residual, less than any surrogate knows


def relative_residuals(predicted: Array, measured: Array) -> Array:
    """Return (predicted - measured) / measured, eq. 18 of Grobbel et al. 2019."""
    return np.asarray((predicted - measured) / measured)


def minimise(
    predict: Callable[[Array], Array],
    measured: Array,
    weight: Callable[[Array], float] | None = None,
) -> tuple[Array, float]:
    """Minimise the sum of squared relative residuals over the unit square.

    Every cell of a grid is looked at; each local minimum of the grid, the best twelve at most, is
    the start of a bounded quasi-Newton search. So a second valley is not missed unless it is
    narrower than a hundredth of the box.

    Parameters
    ----------
    predict : callable
        Maps (k, 2) points of the unit square to (k, j) predicted values.
    measured : (j,) float64
        Targets, not zero.
    weight : callable, optional
        Decides between points that meet all targets equally well, as two crossings of the same
        lines do: the one with the larger weight is taken.

    Returns
    -------
    point : (2,) float64
    value : float
        The sum at that point.
    """

    def objective(u: Array) -> Array:
        return np.asarray(np.sum(relative_residuals(predict(u), measured) ** 2, axis=1))

    axis = np.linspace(0.0, 1.0, GRID)
    points = np.stack(np.meshgrid(axis, axis, indexing="ij"), axis=-1).reshape(-1, 2)
    values = objective(points)
    lowest = ndimage.minimum_filter(values.reshape(GRID, GRID), size=3, mode="nearest").ravel()
    starts = np.flatnonzero(values <= lowest)
    starts = starts[np.argsort(values[starts])][:STARTS]
    found = [(points[k], float(values[k])) for k in starts]
    for start in points[starts]:
        end = minimize(
            lambda u: float(objective(u[None])[0]),
            start,
            method="L-BFGS-B",
            bounds=[(0.0, 1.0)] * 2,
            options={"maxiter": 60},
        )
        found.append((np.asarray(end.x, float), float(end.fun)))
    best = min(found, key=lambda pair: pair[1])
    equal = [pair for pair in found if pair[1] <= best[1] + SAME]
    return max(equal, key=lambda pair: weight(pair[0])) if weight else best


def best_point(
    predict: Callable[[Array], Array], measured: Array, posterior: Posterior
) -> tuple[Array, float]:
    """Minimise the relative residuals where the errors allow the parameters to be.

    The sum weighs all targets alike, also one whose surrogate knows little. Where its minimum
    leaves the most probable 90 %, the best point inside them is taken instead.

    Parameters
    ----------
    predict, measured
        As for `minimise`.
    posterior : Posterior
        Probability of the parameters.

    Returns
    -------
    point : (2,) float64
    value : float
    """
    point, value = minimise(predict, measured, posterior.mass_near)
    if posterior.holds(point, 0.90):
        return point, value
    inside = posterior.density >= posterior.level_of(0.90)
    i, j = np.nonzero(inside)
    cells = np.column_stack([posterior.axes[0][i], posterior.axes[1][j]])
    sums = np.sum(relative_residuals(predict(cells), measured) ** 2, axis=1)
    best = int(np.argmin(sums))
    return cells[best], float(sums[best])
