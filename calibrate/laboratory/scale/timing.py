"""When readings were taken: stamps coarser than the log, and a scale slower than the log.

A computer notes more readings than the scale takes, and often with the whole second only. Both
shift a flow in time, each run by as much, so that no repeat would show it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.laboratory.instrument.series import Series

__all__ = ["Renewed", "renewed", "with_spread_stamps"]

_FLOW: Final = (0.15, 0.85)
"""Part of the range of masses in which readings tell how the log was made."""
_LEAST_ROWS: Final = 8
_LEAST_STAMPS: Final = 4
_MOST: Final = 0.5
"""Part of the rows, or stamps, in a flow that has to show it."""
_LEAST_TICKS: Final = 3.0
"""Of the scale, between readings: less is rounding, and equal readings are no old ones."""
_LATER: Final = 1.9
"""Times the usual time between readings: then a reading is a new one, though it says the same."""


@dataclass(frozen=True)
class Renewed:
    """The rows in which a scale tells a reading for the first time.

    Attributes
    ----------
    keep : (n,) ndarray of bool
    late_s : float
        By how much later than its reading a row is, in the mean.
    tick_s : float
        Step in which the times of readings are known.
    """

    keep: Array
    late_s: float
    tick_s: float


def with_spread_stamps(series: Series) -> Series:
    """Return a log whose rows have times of their own, where several have one stamp.

    Rows of one stamp are laid evenly over its step, as they were taken: from the stamp on where
    it is a time of day in whole seconds, which clocks cut off, and around it where it is a rounded
    number. A log whose stamps have one mass each stays as it is.

    Parameters
    ----------
    series : Series
        Mass [g].
    """
    groups, first, count = np.unique(series.time_s, return_index=True, return_counts=True)
    different = np.maximum.reduceat(series.values, first) > np.minimum.reduceat(
        series.values, first
    )
    flows = _flowing(series.values)[first]
    if np.count_nonzero(flows) < _LEAST_STAMPS or np.mean(different[flows]) < _MOST:
        return series
    usual, step = int(np.median(count)), float(np.median(np.diff(groups)))
    places = np.arange(len(series.time_s)) - np.repeat(first, count)
    places[: count[0]] += max(0, usual - int(count[0]))  # the log began within its first stamp
    rows = count.copy()
    rows[[0, -1]] = np.maximum(rows[[0, -1]], usual)
    cut_off = series.stamped and series.tick_s >= 1.0
    begin = groups - (0.0 if cut_off else 0.5 * step)
    time = np.repeat(begin, count) + step * (places + 0.5) / np.repeat(rows, count)
    return replace(series, time_s=time, tick_s=step / usual)


def _flowing(mass: Array) -> Array:
    """Return which rows lie in the rise of the mass, (n,) bool."""
    low, high = float(np.min(mass)), float(np.max(mass))
    above = mass > low + _FLOW[0] * (high - low)
    below = mass < low + _FLOW[1] * (high - low)
    return np.asarray(above & below)


def renewed(time: Array, mass: Array, tick_g: float) -> Renewed | None:
    """Return which rows are new readings, where a scale tells its mass less often than it is asked.

    In a flow most rows are then equal to those before, and the others differ by many steps of the
    scale. A row in which the mass has changed is late by half the time between rows, in the mean.

    Parameters
    ----------
    time, mass : (n,) float64
        Times rise.
    tick_g : float
        Step in which the scale tells masses.

    Returns
    -------
    Renewed, optional
        None for a log whose rows are readings of their own.
    """
    inside = _flowing(mass)[1:]
    change = np.abs(np.diff(mass))
    if np.count_nonzero(inside) < _LEAST_ROWS:
        return None
    new = change[inside] > 0.0
    steps = change[inside][new]
    if np.mean(new) > _MOST or not len(steps) or np.median(steps) < _LEAST_TICKS * tick_g:
        return None
    usual = float(np.median(np.diff(time[1:][inside & (change > 0.0)])))
    keep = np.zeros(len(time), dtype=bool)
    last = -np.inf
    for k in range(len(time)):
        if k == 0 or change[k - 1] > 0.0 or time[k] - last >= _LATER * usual:
            keep[k], last = True, time[k]
    apart = float(np.median(np.diff(time)))
    return Renewed(keep, 0.5 * apart, apart)
