"""Mass-time curves as the times at which fixed masses are reached."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from calibrate.arrays import Array

__all__ = ["CURVE_LEVELS_G", "first_time"]

CURVE_LEVELS_G: Final = (25, 50, 75, 100)
"""Grams on the scale at which a mass-time curve is read."""


def first_time(time: Array, mass: Array, level: float) -> float:
    """First time at which `mass` reaches `level`, linear between points; nan if never."""
    reached = np.flatnonzero(mass >= level)
    if len(reached) == 0:
        return math.nan
    k = int(reached[0])
    if k == 0:
        return float(time[0])
    share = (level - mass[k - 1]) / (mass[k] - mass[k - 1])
    return float(time[k - 1] + share * (time[k] - time[k - 1]))
