"""Intervals of one unknown from its samples."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy import ndimage

from calibrate.arrays import Array

__all__ = ["LEVELS", "Interval", "most_probable", "regions", "shortest"]

LEVELS: Final = (0.68, 0.90, 0.95)
"""Probabilities of the intervals that are printed."""

_BINS: Final = 400
_SMOOTH: Final = 0.6  # of Silverman's bandwidth, so that two humps stay two
_REACH: Final = 4.0  # bandwidths beyond the outermost sample
_AT_END: Final = 5e-3  # half a per cent of the range is no distance from its end
_GAP: Final = 0.05  # of the range, below which two humps are one region
_FLAT: Final = 1e-9  # relative difference of probabilities that rounding makes


@dataclass(frozen=True)
class Interval:
    """Span that holds a share of the probability.

    Attributes
    ----------
    low, high : float
    open_low, open_high : bool
        Whether it ends there only because the range does.
    """

    low: float
    high: float
    open_low: bool
    open_high: bool


def density(samples: Array, low: float, high: float) -> tuple[Array, Array]:
    """Return edges, (b + 1,), and probabilities, (b,), of the smoothed histogram of samples.

    Parameters
    ----------
    samples : (n,) float64
    low, high : float
        Ends of the range, at which the density is mirrored; may be infinite.
    """
    quartiles = np.percentile(samples, [25.0, 75.0])
    width = min(float(np.std(samples)), float(quartiles[1] - quartiles[0]) / 1.34)
    width = max(width, 1e-12 * (1.0 + float(np.abs(samples).max())))
    band = _SMOOTH * 0.9 * width * len(samples) ** -0.2
    start = max(low, float(samples.min()) - _REACH * band)
    end = min(high, float(samples.max()) + _REACH * band)
    end = max(end, start + 2.0 * _REACH * band * 1e-3)
    counts, edges = np.histogram(samples, bins=_BINS, range=(start, end))
    sigma = band / (edges[1] - edges[0])
    smooth = ndimage.gaussian_filter1d(counts.astype(float), sigma, mode="reflect")
    return edges, np.asarray(smooth / smooth.sum())


def shortest(samples: Array, level: float, low: float = -np.inf, high: float = np.inf) -> Interval:
    """Return the span of the most probable values that together hold `level`.

    A wider level always contains a narrower one, also when the probability has two humps; the
    span then holds somewhat more than `level`.

    Parameters
    ----------
    samples : (n,) float64
        Draws of equal weight, on the scale on which the prior is spaced.
    level : float
        Probability, such as 0.9.
    low, high : float
        Ends of the range.
    """
    return most_probable(*density(samples, low, high), level, low, high)


def most_probable(
    edges: Array, share: Array, level: float, low: float = -np.inf, high: float = np.inf
) -> Interval:
    """Return the span of the most probable cells that together hold `level`.

    Parameters
    ----------
    edges : (b + 1,) float64
        Ends of the cells, rising.
    share : (b,) float64
        Probability of each cell, up to a factor.
    level : float
        Probability, such as 0.9.
    low, high : float
        Ends of the range.
    """
    kept = np.flatnonzero(_kept(share, level))
    return _span(edges, kept, low, high)


def regions(
    samples: Array, level: float, low: float = -np.inf, high: float = np.inf
) -> list[Interval]:
    """Return the separate spans of the most probable values, with the parameters of `shortest`.

    Together they hold `level`, or somewhat more: a gap of less than a twentieth of the range is
    none.
    """
    edges, share = density(samples, low, high)
    kept = np.flatnonzero(_kept(share, level))
    gap = _GAP * (edges[-1] - edges[0]) / (edges[1] - edges[0])
    parts = np.split(kept, np.flatnonzero(np.diff(kept) > max(gap, 1.0)) + 1)
    return [_span(edges, part, low, high) for part in parts]


def _kept(share: Array, level: float) -> Array:
    """Return which cells are the most probable that together hold `level`."""
    falling = np.sort(share)[::-1]
    cumulative = np.cumsum(falling) / falling.sum()
    last = falling[min(int(np.searchsorted(cumulative, level)), len(falling) - 1)]
    # Equally probable values are all kept: of a flat probability the whole range remains.
    return np.asarray(share >= last * (1.0 - _FLAT))


def _span(edges: Array, kept: Array, low: float, high: float) -> Interval:
    """Return the interval from the first to the last of the kept cells."""
    near = _AT_END * (high - low)
    left, right = float(edges[kept[0]]), float(edges[kept[-1] + 1])
    return Interval(left, right, open_low=left <= low + near, open_high=right >= high - near)
