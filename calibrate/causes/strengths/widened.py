"""Draws of a strength, made as uncertain as strengths have proved to be."""

from __future__ import annotations

from typing import Final

import numpy as np

from calibrate.arrays import Array

__all__ = ["widened"]

FACTOR: Final = 1.25
"""In the fifth and sixth blind suite 90 % intervals held 222 of 280 strengths; with this factor
they would have held 249 (`docs/challenge.md`). What a cause does is learnt from few runs, and less
certain than they say."""


def widened(draws: Array, low: float, high: float) -> Array:
    """Return draws of a strength, spread about their median by `FACTOR`.

    Parameters
    ----------
    draws : (n,) float64
        In the cause's unit.
    low, high : float
        Limits of the strength, which the result keeps.

    Examples
    --------
    >>> widened(np.array([1.0, 2.0, 3.0]), 0.9, 9.0).tolist()
    [0.9, 2.0, 3.25]
    """
    middle = np.median(draws)
    return np.asarray(np.clip(middle + FACTOR * (draws - middle), low, high))
