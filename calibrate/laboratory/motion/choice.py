"""How many harmonics of a motion are worth keeping.

A harmonic is kept if it predicts readings that it has not seen: the record is cut into ten pieces
in the order of time, each is predicted from the other nine, and of the numbers of harmonics that
are as good as the best, within one standard error over the pieces, the smallest is taken (the rule
of Breiman et al. 1984). More harmonics would follow the noise, and a plate that follows noise
shakes grains that the real one did not shake.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.laboratory.motion.harmonics import fit_at, highest_frequency

__all__ = ["most_harmonics", "prediction_errors", "worth_keeping"]

_PIECES: Final = 10
_MOST_READINGS: Final = 4000
_READINGS_PER_NUMBER: Final = 2.0
"""Readings for each number that is fitted, at least."""


def most_harmonics(time: Array, period_s: float, limit: int) -> int:
    """Return how many harmonics the readings can tell from each other, at least one."""
    by_rate = int(highest_frequency(time) * period_s)
    by_count = int((len(time) / _READINGS_PER_NUMBER - 4.0) / 2.0)
    return max(1, min(limit, by_rate, by_count))


def prediction_errors(time: Array, values: Array, period_s: float, most: int) -> Array:
    """Return the mean squares by which left-out pieces are missed.

    Parameters
    ----------
    time, values : (n,) float64
    period_s : float
    most : int
        Harmonics up to which is tried.

    Returns
    -------
    (most, 10) float64
    """
    step = math.ceil(len(time) / _MOST_READINGS)
    pieces = np.array_split(np.arange(0, len(time), step), _PIECES)
    errors = np.empty((most, _PIECES))
    for column, piece in enumerate(pieces):
        seen = np.setdiff1d(np.concatenate(pieces), piece)
        for count in range(1, most + 1):
            fit = fit_at(time[seen], values[seen], period_s, count)
            missed = values[piece] - fit.motion(time[piece]) - fit.slow(time[piece])
            errors[count - 1, column] = np.mean(missed**2)
    return errors


def worth_keeping(errors: Array) -> int:
    """Return the smallest number of harmonics that predicts as well as the best.

    Parameters
    ----------
    errors : (K, m) float64
        As `prediction_errors` returns them.

    Examples
    --------
    >>> worth_keeping(np.array([[9.0, 7.0, 8.0], [1.0, 3.0, 2.0], [1.0, 2.0, 2.1]]))
    2
    """
    best = int(np.argmin(errors.mean(axis=1)))
    worse = errors - errors[best]
    chance = worse.std(axis=1, ddof=1) / math.sqrt(errors.shape[1])
    return 1 + int(np.argmax(worse.mean(axis=1) <= chance))
