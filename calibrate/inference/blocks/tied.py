"""Tied unknowns seen from their own range: w with Phi(w) the value on the unit range.

A flat prior of the value is the unit normal of w. Given mean and spread of its tie, w has a
density that is known exactly and nearly normal.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from scipy import special

from calibrate.arrays import Array
from calibrate.inference.priors import TINY, truncated_normal

__all__ = ["delta_coordinate", "moments", "relative_log_density"]

_NODES, _WEIGHTS = np.polynomial.hermite_e.hermegauss(7)
_P: Final = special.ndtr(_NODES)
_SHARE: Final = _WEIGHTS / _WEIGHTS.sum()
_HALF_LOG_2PI: Final = 0.5 * math.log(2.0 * math.pi)
_EDGE: Final = 1e-12  # of the range: nothing is told between values nearer to its end


def moments(mean: Array, spread: Array) -> tuple[Array, Array]:
    """Return mean and standard deviation of w, any shape, for mean and spread of the tie."""
    low, high = -mean / spread, (1.0 - mean) / spread
    delta = truncated_normal(_P, low[..., None], high[..., None])
    unit = np.clip(mean[..., None] + spread[..., None] * delta, _EDGE, 1.0 - _EDGE)
    w = special.ndtri(unit)
    centre = w @ _SHARE
    wide = np.sqrt((w - centre[..., None]) ** 2 @ _SHARE)
    return centre, np.maximum(wide, _EDGE)


def relative_log_density(w: Array, mean: Array, spread: Array) -> Array:
    """Return the log of the density of w over that of the unit normal."""
    inside = special.ndtr((1.0 - mean) / spread) - special.ndtr(-mean / spread)
    delta = (special.ndtr(w) - mean) / spread
    return np.asarray(-0.5 * delta**2 - _HALF_LOG_2PI - np.log(spread * inside))


def delta_coordinate(w: Array, mean: Array, spread: Array) -> Array:
    """Return the coordinate of `Space.from_normal` that stands for w."""
    below = special.ndtr(-mean / spread)
    inside = special.ndtr((1.0 - mean) / spread) - below
    share = (special.ndtr((special.ndtr(w) - mean) / spread) - below) / inside
    return np.asarray(special.ndtri(np.clip(share, TINY, 1.0 - TINY)))
