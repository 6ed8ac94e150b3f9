"""The point of the paper: the least sum of squared relative residuals, its eq. 18.

The sum weighs all targets alike, also one whose measurement or surrogate knows little. It is given
beside the result, and the result itself is the most probable point.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy import ndimage
from scipy.optimize import minimize
from scipy.stats import qmc

from calibrate.arrays import Array

__all__ = ["minimise", "relative_residuals", "unit_points"]

GRID = 101
SCATTERED = 2048
STARTS = 12


def relative_residuals(predicted: Array, measured: Array) -> Array:
    """Return (predicted - measured) / measured, eq. 18 of Grobbel et al. 2019."""
    return np.asarray((predicted - measured) / measured)


def unit_points(size: int, grid: int, scattered: int = SCATTERED) -> Array:
    """Return points that cover the unit cube, (n, size): a grid up to the plane, else Sobol's.

    Parameters
    ----------
    size : int
        Number of parameters.
    grid : int
        Points of the grid along each axis.
    scattered : int
        Number of Sobol's points, a power of two.
    """
    if size > 2:
        return np.asarray(qmc.Sobol(size, scramble=False).random(scattered) + 0.5 / scattered)
    axis = np.linspace(0.0, 1.0, grid)
    return np.stack(np.meshgrid(*[axis] * size, indexing="ij"), axis=-1).reshape(-1, size)


def minimise(residuals: Callable[[Array], Array], size: int) -> tuple[Array, float]:
    """Minimise a sum of squares over the unit cube.

    Up to two parameters every cell of a grid is looked at; each local minimum of the grid, the
    best twelve at most, is the start of a bounded quasi-Newton search. So a second valley is not
    missed unless it is narrower than a hundredth of the box. With more parameters the starts are
    the best of points that fill the box.

    Parameters
    ----------
    residuals : callable
        Maps (k, d) points of the unit cube to (k, j) numbers.
    size : int
        Number d of parameters.

    Returns
    -------
    point : (d,) float64
    value : float
        The sum at that point.
    """

    def objective(u: Array) -> Array:
        return np.asarray(np.sum(residuals(u) ** 2, axis=1))

    points = unit_points(size, GRID)
    values = objective(points)
    starts = np.arange(len(points))
    if size <= 2:
        field = values.reshape((GRID,) * size)
        starts = np.flatnonzero(field <= ndimage.minimum_filter(field, size=3, mode="nearest"))
    starts = starts[np.argsort(values[starts])][:STARTS]
    found = [(points[k], float(values[k])) for k in starts]
    for start in points[starts]:
        end = minimize(
            lambda u: float(objective(u[None])[0]),
            start,
            method="L-BFGS-B",
            bounds=[(0.0, 1.0)] * size,
            options={"maxiter": 60},
        )
        found.append((np.asarray(end.x, float), float(end.fun)))
    return min(found, key=lambda pair: pair[1])
