"""The point of the paper: the least sum of squared relative residuals, its eq. 18.

The sum weighs all targets alike, also one whose measurement or surrogate knows little. It is given
beside the result, and the result itself is the most probable point (`posterior`).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy import ndimage
from scipy.optimize import minimize

from calibrate.arrays import Array

__all__ = ["minimise", "relative_residuals"]

GRID = 101
STARTS = 12


def relative_residuals(predicted: Array, measured: Array) -> Array:
    """Return (predicted - measured) / measured, eq. 18 of Grobbel et al. 2019."""
    return np.asarray((predicted - measured) / measured)


def minimise(predict: Callable[[Array], Array], measured: Array) -> tuple[Array, float]:
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
    return min(found, key=lambda pair: pair[1])
