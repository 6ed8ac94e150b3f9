"""Intervals of two parameters from a likelihood on a grid.

The likelihood of a stage compares the measured means with the surrogates:

    y ~ N(m(theta), diag(s^2 + L v(theta)) + B C B')

with s the standard error of the measurement, v the variance of the surrogate (it holds the seed
noise of its runs), L its inflation from left-out points, and B C B' what the uncertainty of earlier
stages does to all targets together. The prior is flat inside the box. Not in it: errors of the
apparatus or of the contact law, and parameters held at assumed values.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from calibrate.arrays import Array

__all__ = ["LEVELS", "Interval", "Posterior", "grid_posterior", "log_likelihood"]

LEVELS = (0.68, 0.90, 0.95)
COARSE, FINE = 61, 121
SPLIT = 40  # points of an interval's search per cell of the grid
FLAT = 1e-9  # relative difference of probabilities that rounding makes
KEEP = 12.0  # log-likelihood below the best at which the grid is cut: exp(-12) = 6e-6


@dataclass(frozen=True)
class Interval:
    """Span that holds a share of the probability.

    Attributes
    ----------
    low, high : float
    open_low, open_high : bool
        Whether it ends there only because the box does.
    """

    low: float
    high: float
    open_low: bool
    open_high: bool


@dataclass(frozen=True)
class Posterior:
    """Probability of two parameters on a grid in the unit square.

    Attributes
    ----------
    axes : two (n,) float64
        Grid of each parameter, scaled to [0, 1].
    density : (n, n) float64
        Probability of each cell, sum 1.
    """

    axes: tuple[Array, Array]
    density: Array

    def interval(self, parameter: int, level: float) -> Interval:
        """Return the span of the most probable values that together hold `level`.

        The wider level always contains the narrower one, also when the probability has two
        humps; the span then holds somewhat more than `level`.
        """
        axis = self.axes[parameter]
        # Finer than the likelihood; the nodes of its grid, and so the peak, are among the points.
        fine = np.linspace(axis[0], axis[-1], SPLIT * (axis.size - 1) + 1)
        marginal = np.interp(fine, axis, self.density.sum(axis=1 - parameter))
        falling = np.sort(marginal)[::-1]
        cumulative = np.cumsum(falling) / falling.sum()
        last = falling[min(int(np.searchsorted(cumulative, level)), falling.size - 1)]
        # Equally probable values are all kept: of a flat probability the whole range remains.
        kept = np.flatnonzero(marginal >= last * (1.0 - FLAT))
        half = 0.5 * (fine[1] - fine[0])
        low, high = (float(x) for x in np.clip([fine[kept[0]] - half, fine[kept[-1]] + half], 0, 1))
        # Half a per cent of the box is no distance; the interval then ends because the box does.
        return Interval(low, high, open_low=low < 5e-3, open_high=high > 0.995)

    def best(self) -> Array:
        """Return the most probable pair of values that lies in both 68 % intervals, (2,).

        The most probable pair of all may lie outside the interval of one of its values, because
        an interval counts all values of the other parameter: in a bent or sheared region the
        peak can stand where few pairs are. At least 36 % of the probability lies in both
        intervals, and wider intervals contain them, so this point is inside every interval that
        is given with it.
        """
        spans = [self.interval(i, LEVELS[0]) for i in range(2)]
        inside = [
            (axis >= span.low - 0.5 * (axis[1] - axis[0]))
            & (axis <= span.high + 0.5 * (axis[1] - axis[0]))
            for axis, span in zip(self.axes, spans, strict=True)
        ]
        allowed = np.where(inside[0][:, None] & inside[1][None, :], self.density, -1.0)
        index = np.unravel_index(int(np.argmax(allowed)), allowed.shape)
        cell = [axis[k] for axis, k in zip(self.axes, index, strict=True)]
        return np.asarray(np.clip(cell, [s.low for s in spans], [s.high for s in spans]))

    def mean(self) -> Array:
        """Return the mean of the two parameters, (2,)."""
        return np.array(
            [np.sum(self.density.sum(axis=1 - i) * self.axes[i]) for i in range(2)], dtype=float
        )

    def covariance(self) -> Array:
        """Return the covariance of the two parameters, (2, 2)."""
        grid = np.stack(np.meshgrid(*self.axes, indexing="ij"), axis=-1).reshape(-1, 2)
        centred = grid - self.mean()
        return np.asarray((centred * self.density.reshape(-1, 1)).T @ centred)

    def level_of(self, share: float) -> float:
        """Return the density above which the cells hold `share` of the probability."""
        sorted_density = np.sort(self.density.ravel())[::-1]
        index = int(np.searchsorted(np.cumsum(sorted_density), share))
        return float(sorted_density[min(index, sorted_density.size - 1)])

    def regions(self, share: float = 0.90) -> int:
        """Return into how many separate patches the most probable `share` falls."""
        _, count = ndimage.label(self.density >= self.level_of(share), np.ones((3, 3)))
        return int(count)

    def sample(self, count: int, rng: np.random.Generator, flatten: float = 1.0) -> Array:
        """Draw points, (count, 2) in the unit square.

        ``flatten`` below 1 draws from the density to that power, to look around the optimum.
        """
        weight = self.density.ravel() ** flatten
        index = rng.choice(weight.size, size=count, p=weight / weight.sum())
        i, j = np.unravel_index(index, self.density.shape)
        points = np.column_stack([self.axes[0][i], self.axes[1][j]])
        step = np.array([a[1] - a[0] for a in self.axes])
        moved = points + (rng.random(points.shape) - 0.5) * step
        return np.asarray(np.clip(moved, 0.0, 1.0))


def log_likelihood(residual: Array, variance: Array, common: Array) -> Array:
    """Return the logarithm of the normal likelihood, up to a constant.

    Parameters
    ----------
    residual : (k, j) float64
        Predicted minus measured for k points and j targets.
    variance : (k, j) float64
        Variance of each target on its own.
    common : (j, j) float64
        Covariance that all points share.

    Returns
    -------
    (k,) float64
    """
    size = residual.shape[1]
    covariance = common[None] + variance[:, :, None] * np.eye(size)[None]
    solved = np.linalg.solve(covariance, residual[:, :, None])[:, :, 0]
    _, logdet = np.linalg.slogdet(covariance)
    return np.asarray(-0.5 * (np.sum(residual * solved, axis=1) + logdet))


def grid_posterior(function: Callable[[Array], Array]) -> Posterior:
    """Evaluate a log-likelihood on the unit square, then again on the part that matters.

    Parameters
    ----------
    function : callable
        Maps (k, 2) points to (k,) log-likelihoods.
    """
    axes = (np.linspace(0.0, 1.0, COARSE), np.linspace(0.0, 1.0, COARSE))
    for _ in range(2):  # the second zoom serves likelihoods narrower than a coarse cell
        values = _on_grid(function, axes)
        keep = values > values.max() - KEEP
        spans = [np.flatnonzero(keep.any(axis=1 - i)) for i in range(2)]
        axes = (_zoom(axes[0], spans[0]), _zoom(axes[1], spans[1]))
    values = _on_grid(function, axes)
    density = np.exp(values - values.max())
    return Posterior(axes, density / density.sum())


def _on_grid(function: Callable[[Array], Array], axes: tuple[Array, Array]) -> Array:
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    return function(grid.reshape(-1, 2)).reshape(grid.shape[:2])


def _zoom(axis: Array, span: NDArray[np.intp]) -> Array:
    low, high = max(span[0] - 1, 0), min(span[-1] + 1, len(axis) - 1)
    return np.linspace(axis[low], axis[high], FINE)
