"""Probability of one or two parameters on a grid: what contour figures and intervals are read from.

Two parameters can be looked at everywhere, so nothing is left to a sampler's luck, and lines of
equal probability are smooth. The probability itself is that of `calibrate.inference`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from calibrate.arrays import Array
from calibrate.inference.intervals import LEVELS, Interval, most_probable

__all__ = ["GridPosterior", "grid_posterior"]

COARSE: Final = 61
FINE: Final = 121
SPLIT: Final = 40  # points of an interval's search per cell of the grid
KEEP: Final = 12.0  # log-likelihood below the best at which the grid is cut: exp(-12) = 6e-6


@dataclass(frozen=True, eq=False)
class GridPosterior:
    """Probability of one or two parameters on a grid in the unit square.

    Attributes
    ----------
    axes : tuple of (n,) float64
        Grid of each parameter, scaled to [0, 1].
    density : (n,) or (n, n) float64
        Probability of each cell, sum 1.
    """

    axes: tuple[Array, ...]
    density: Array

    @property
    def size(self) -> int:
        """Number of parameters."""
        return len(self.axes)

    def marginal(self, parameter: int) -> Array:
        """Return the probability of one parameter on its axis, (n,)."""
        others = tuple(i for i in range(self.size) if i != parameter)
        return np.asarray(self.density.sum(axis=others))

    def interval(self, parameter: int, level: float) -> Interval:
        """Return the span of the most probable values that together hold `level`.

        The wider level always contains the narrower one, also when the probability has two
        humps; the span then holds somewhat more than `level`.
        """
        axis = self.axes[parameter]
        # Finer than the likelihood; the nodes of its grid, and so the peak, are among the points.
        fine = np.linspace(axis[0], axis[-1], SPLIT * (axis.size - 1) + 1)
        half = 0.5 * (fine[1] - fine[0])
        edges = np.clip(np.append(fine - half, fine[-1] + half), 0.0, 1.0)
        share = np.interp(fine, axis, self.marginal(parameter))
        return most_probable(edges, share, level, 0.0, 1.0)

    def best(self) -> Array:
        """Return the most probable values that lie in all 68 % intervals, (d,).

        The most probable pair of all may lie outside the interval of one of its values, because
        an interval counts all values of the other parameter: in a bent or sheared region the
        peak can stand where few pairs are. At least 36 % of the probability lies in both
        intervals, and wider intervals contain them, so this point is inside every interval that
        is given with it.
        """
        spans = [self.interval(i, LEVELS[0]) for i in range(self.size)]
        allowed = self.density
        for i, (axis, span) in enumerate(zip(self.axes, spans, strict=True)):
            half = 0.5 * (axis[1] - axis[0])
            inside = (axis >= span.low - half) & (axis <= span.high + half)
            shape = [-1 if k == i else 1 for k in range(self.size)]
            allowed = np.where(inside.reshape(shape), allowed, -1.0)
        index = np.unravel_index(int(np.argmax(allowed)), allowed.shape)
        cell = [axis[k] for axis, k in zip(self.axes, index, strict=True)]
        return np.asarray(np.clip(cell, [s.low for s in spans], [s.high for s in spans]))

    def level_of(self, share: float) -> float:
        """Return the density above which the cells hold `share` of the probability."""
        sorted_density = np.sort(self.density.ravel())[::-1]
        index = int(np.searchsorted(np.cumsum(sorted_density), share))
        return float(sorted_density[min(index, sorted_density.size - 1)])

    def regions(self, share: float = 0.90) -> int:
        """Return into how many separate patches the most probable `share` falls."""
        touching = np.ones((3,) * self.size)
        _, count = ndimage.label(self.density >= self.level_of(share), touching)
        return int(count)

    def sample(self, count: int, rng: np.random.Generator, flatten: float = 1.0) -> Array:
        """Draw points, (count, d) in the unit square.

        ``flatten`` below 1 draws from the density to that power, to look around the optimum.
        """
        weight = self.density.ravel() ** flatten
        index = rng.choice(weight.size, size=count, p=weight / weight.sum())
        cells = np.unravel_index(index, self.density.shape)
        points = np.column_stack([axis[k] for axis, k in zip(self.axes, cells, strict=True)])
        step = np.array([a[1] - a[0] for a in self.axes])
        moved = points + (rng.random(points.shape) - 0.5) * step
        return np.asarray(np.clip(moved, 0.0, 1.0))


def grid_posterior(
    function: Callable[[Array], Array],
    size: int,
    rough: Callable[[Array], Array] | None = None,
) -> GridPosterior:
    """Evaluate a log density on the unit square, then again on the part that matters.

    Parameters
    ----------
    function : callable
        Maps (k, d) points to (k,) log densities.
    size : int
        Number d of parameters, 1 or 2.
    rough : callable, optional
        A faster one, right to some units, that says where to look.
    """
    look = rough or function
    axes = tuple(np.linspace(0.0, 1.0, COARSE) for _ in range(size))
    for _ in range(2):  # the second zoom serves likelihoods narrower than a coarse cell
        values = _on_grid(look, axes)
        keep = values > values.max() - KEEP
        across = [tuple(k for k in range(size) if k != i) for i in range(size)]
        spans = [np.flatnonzero(keep.any(axis=others)) for others in across]
        axes = tuple(_zoom(axis, span) for axis, span in zip(axes, spans, strict=True))
    values = _on_grid(look, axes)
    if rough is not None:
        matters = values > values.max() - KEEP
        values = np.where(matters, values, -np.inf)
        values[matters] = function(_points_of(axes)[matters.ravel()])
    density = np.exp(values - values.max())
    return GridPosterior(axes, density / density.sum())


def _points_of(axes: tuple[Array, ...]) -> Array:
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    return grid.reshape(-1, len(axes))


def _on_grid(function: Callable[[Array], Array], axes: tuple[Array, ...]) -> Array:
    return function(_points_of(axes)).reshape([len(axis) for axis in axes])


def _zoom(axis: Array, span: NDArray[np.intp]) -> Array:
    low, high = max(span[0] - 1, 0), min(span[-1] + 1, len(axis) - 1)
    return np.linspace(axis[low], axis[high], FINE)
