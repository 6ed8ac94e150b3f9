"""How uncertain lines and levels of a log are, whose errors are not independent of each other.

Readings scatter, each on its own (variance sigma^2), and the flow itself is uneven, so that the
mass wanders about its line as a random walk (variance D per second). Least squares alone would take
the second for the first, and a slope for ten times better known than it is.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.optimize import nnls

from calibrate.arrays import Array

__all__ = ["Line", "Noise", "line_of", "noise_about", "rest_of"]

_PARTS: Final = 8
"""Of a piece of a log: over such a part the wandering is told from scatter."""
_TAKEN: Final = 0.8
"""Part of the wandering over a whole piece that is lost on its line: 2 L / T - 1.2 L / T."""
_FEW: Final = 30
"""Readings that cannot tell wandering from scatter: then the worse of the two is assumed."""
_CLIPPED: Final = 5.0
"""Times the median, 3.4 standard deviations: what is left of a bump counts no more than that."""
_BINS: Final = 100
"""Rows are put together before errors are computed, which costs the square of their number."""


@dataclass(frozen=True)
class Noise:
    """What makes readings differ from a straight line.

    Attributes
    ----------
    variance : float
        Of a reading [g2].
    walk : float
        Variance of the mass per second of flow [g2/s].
    between : float
        Variance of the mass at any time, as two readings around it tell it [g2].
    """

    variance: float
    walk: float
    between: float


@dataclass(frozen=True)
class Line:
    """A straight line through readings.

    Attributes
    ----------
    middle_s : float
        Time at which `level_g` is given.
    level_g, slope_g_s : float
    covariance : (2, 2) ndarray
        Of level and slope.
    """

    middle_s: float
    level_g: float
    slope_g_s: float
    covariance: Array


def noise_about(time: Array, mass: Array) -> Noise:
    """Tell scatter from wandering by how differences grow with the time between two readings.

    The mean square of a difference over a time L is 2 sigma^2 + D L, less what the straight line
    through n readings over a time T takes of it, D L (0.8 L / T). Both are fitted from one reading
    apart to an eighth of T, each in proportion to how well it is known; if the flow wanders more
    over the longest of these times, that counts.

    Parameters
    ----------
    time, mass : (n,) float64
        A piece of a log that should be straight, n at least 4.
    """
    off = mass - np.polyval(np.polyfit(time - time[0], mass, 1), time - time[0])
    near, whole = float(np.mean(np.diff(time))), float(time[-1] - time[0])
    most = max(np.log2(whole / _PARTS / near), 1.0)
    lags, squares = _differences(time, off, near * 2.0 ** np.arange(np.floor(most) + 1.0))
    grows = lags * (1.0 - _TAKEN * lags / whole)
    weights = 1.0 / np.maximum(squares * np.sqrt(lags), np.finfo(float).tiny)
    model = np.stack([2.0 * np.ones_like(lags), grows], axis=1)
    (variance, walk), _ = nnls(model * weights[:, None], squares * weights)
    longest = (squares[-1] - squares[0]) / (grows[-1] - grows[0])
    if len(time) < _FEW:
        longest = squares[0] / near
    return Noise(float(variance), float(max(walk, longest)), float(squares[0]) / 2.0)


def _differences(time: Array, off: Array, lags: Array) -> tuple[Array, Array]:
    """Return the times between pairs of readings, and the mean squares of their differences.

    What is left of a bump is clipped.
    """
    found = []
    for lag in lags:
        later = np.searchsorted(time, time + 0.9 * lag)
        pairs = np.flatnonzero(later < len(time))
        apart, change = time[later[pairs]] - time[pairs], off[later[pairs]] - off[pairs]
        limit = _CLIPPED * float(np.median(np.abs(change))) or np.inf
        clipped = np.clip(change, -limit, limit)
        found.append((float(np.mean(apart)), float(np.mean(clipped**2))))
    return np.array(found)[:, 0], np.array(found)[:, 1]


def line_of(time: Array, mass: Array, noise: Noise) -> Line:
    """Return the least-squares line through readings, with the errors that the noise gives it.

    Parameters
    ----------
    time, mass : (n,) float64
        n at least 2.
    noise : Noise
    """
    pieces = np.array_split(np.arange(len(time)), min(len(time), _BINS))
    counts = np.array([len(piece) for piece in pieces])
    at = np.array([time[piece].mean() for piece in pieces])
    level = np.array([mass[piece].mean() for piece in pieces])
    middle = float(np.average(at, weights=counts))
    root = np.sqrt(counts)[:, None]
    solve = np.linalg.pinv(root * np.stack([np.ones_like(at), at - middle], axis=1)) * root.T
    walked = noise.walk * np.minimum.outer(at - at[0], at - at[0])
    covariance = solve @ (np.diag(noise.variance / counts) + walked) @ solve.T
    found = solve @ level
    return Line(middle, float(found[0]), float(found[1]), covariance)


def rest_of(time: Array, mass: Array) -> Line:
    """Return level and drift of a scale at rest; neighbours that agree count less than one each.

    Parameters
    ----------
    time, mass : (n,) float64
        n at least 3.
    """
    middle = float(time.mean())
    shifted = time - middle
    spread = float(np.sum(shifted**2))
    level, slope = float(mass.mean()), float(shifted @ mass) / spread
    off = mass - level - slope * shifted
    total = float(off @ off)
    follows = max(0.0, float(off[1:] @ off[:-1]) / total) if total > 0.0 else 0.0
    variance = total / max(1, len(time) - 2) * (1.0 + follows) / max(1.0 - follows, 1.0 / len(time))
    return Line(middle, level, slope, variance * np.diag([1.0 / len(time), 1.0 / spread]))
