"""The empty scale under a log: where the mass rises, what was there before, and how it drifts."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, overload

import numpy as np
from scipy.optimize import isotonic_regression

from calibrate.arrays import Array
from calibrate.errors import CalibrationError
from calibrate.laboratory.scale.clean import CleanLog
from calibrate.laboratory.scale.noise import Line, rest_of

__all__ = ["Base", "Rise", "base_of", "rise_of"]

_ENDS: Final = 3
"""Readings at either end whose median is the level there."""
_STEADY: Final = (0.2, 0.8)
_MARGIN: Final = 0.15
"""Part of the rise that is kept clear of: first and last grains come slowly."""
_FIRST_GRAINS: Final = 0.01
"""Part of the rise at which the first grains have surely come."""
_REST_SIGMAS: Final = 3.0
"""Standard deviations of a reading, beside a step of the scale, by which an empty one may rise."""
_SIGMA_PER_SECOND_DIFFERENCE: Final = 1.4826 / 6.0**0.5
"""Of a reading over the median size of second differences, in which a steady flow is not."""
_FLOWS: Final = 0.5
"""Part of the usual change between readings from which a first change is flow."""
_LEAST_REST: Final = 3
_LEAST_DRIFT: Final = 8
"""Readings at rest that tell a level, and those that tell a drift."""
_UNIFORM: Final = 12.0
"""Variance of what is rounded to a step: the step squared over twelve."""
_LEAST_RISE: Final = 10.0
"""Steps of the scale, or standard deviations: less is no rise."""
_DRIFT_SIGMAS: Final = 3.0
_DRIFT_SPAN: Final = 0.2
"""Part of the rise that the scale must have been at rest to say how it drifts."""


@dataclass(frozen=True)
class Rise:
    """Where the mass rises in a log; masks have shape (n,).

    Attributes
    ----------
    begin_s, end_s : float
        Where the line of the flow meets the levels before and after.
    before, after : ndarray of bool
        Readings at rest.
    """

    begin_s: float
    end_s: float
    before: Array
    after: Array


@dataclass(frozen=True)
class Base:
    """The reading of the scale without what flows: a level and its drift.

    Attributes
    ----------
    middle_s, level_g, drift_g_s : float
        Level at a time; the drift is zero where none is visible.
    level_variance, drift_variance : float
        Independent of each other.
    remark : str
        What a user should know of it.
    """

    middle_s: float
    level_g: float
    drift_g_s: float
    level_variance: float
    drift_variance: float
    remark: str = ""

    @property
    def drifts(self) -> bool:
        """Whether a drift was taken off."""
        return self.drift_g_s != 0.0

    @overload
    def at(self, time_s: float) -> float: ...

    @overload
    def at(self, time_s: Array) -> Array: ...

    def at(self, time_s: float | Array) -> float | Array:
        """Return the reading of the empty scale [g]."""
        return self.level_g + self.drift_g_s * (time_s - self.middle_s)

    def variance_at(self, time_s: float) -> float:
        """Return its variance [g2]."""
        return self.level_variance + self.drift_variance * (time_s - self.middle_s) ** 2

    def shifted(self, zero_s: float) -> Base:
        """Return the same with times that count from another zero."""
        return replace(self, middle_s=self.middle_s - zero_s)


def rise_of(path: Path, log: CleanLog) -> Rise:
    """Find where the mass rises.

    Raises
    ------
    CalibrationError
        When it does not.
    """
    time, mass = log.time_s, log.mass_g
    low, high = float(np.median(mass[:_ENDS])), float(np.median(mass[-_ENDS:]))
    scatter = float(np.median(np.abs(np.diff(mass))))
    still = float(np.median(np.abs(np.diff(mass[: max(_ENDS, len(mass) // 10)]))))
    if high - low < _LEAST_RISE * max(log.tick_g, min(scatter, still)) or high <= low:
        msg = f"{path}: the mass goes from {low:.4g} to {high:.4g} g, which is no flow onto a scale"
        raise CalibrationError(msg)
    rising = isotonic_regression(mass).x
    inside = [int(np.searchsorted(rising, low + part * (high - low))) for part in _STEADY]
    first, last = max(inside[0] - 1, 0), min(inside[1], len(mass) - 1)
    slope = (rising[last] - rising[first]) / (time[last] - time[first])
    middle = 0.5 * (time[first] + time[last])
    level = 0.5 * (rising[first] + rising[last])
    begin, end = middle - (level - low) / slope, middle + (high - level) / slope
    margin = _MARGIN * (end - begin)
    before, after = time < begin - margin, time > end + margin
    empty = _without_grains(log, rising, after)
    if np.count_nonzero(before) < _LEAST_REST:
        before = empty & (rising < low + _FIRST_GRAINS * (high - low)) & (time < begin)
    elif np.count_nonzero(after) >= _LEAST_DRIFT:
        before &= empty
    return Rise(float(begin), float(end), before, after)


def _without_grains(log: CleanLog, rising: Array, after: Array) -> Array:
    """Return which readings show no grain yet, (n,) bool: those of a first trickle do.

    They rise by no more than scatter, and the drift that the scale shows after the flow.
    """
    time, mass = log.time_s, log.mass_g
    drift = 0.0
    if np.count_nonzero(after) >= _LEAST_DRIFT:
        rest = rest_of(time[after], mass[after])
        drift = max(rest.slope_g_s + _DRIFT_SIGMAS * float(rest.covariance[1, 1]) ** 0.5, 0.0)
    limit = rising[0] + log.tick_g + _REST_SIGMAS * _scatter(mass) + drift * (time - time[0])
    return np.asarray(np.logical_and.accumulate(rising <= limit))


def _scatter(mass: Array) -> float:
    """Return the standard deviation of a reading at the calmer end of a log [g]."""
    part = max(_LEAST_DRIFT, len(mass) // 10)
    ends = (np.diff(one, 2) for one in (mass[:part], mass[-part:]))
    return _SIGMA_PER_SECOND_DIFFERENCE * min(float(np.median(np.abs(one))) for one in ends)


def base_of(path: Path, log: CleanLog, rise: Rise) -> Base:
    """Return the empty scale, from its readings at rest before the mass rises.

    A drift is taken off where the scale was at rest long enough to show it, before or after, and
    it is more than three of its standard errors. What falls late onto the scale looks like drift
    after the rise, so that nothing is taken from there alone, nor where the two differ.

    Raises
    ------
    CalibrationError
        When the mass flows from the first reading on, so that nothing tells the empty scale.
    """
    time, mass = log.time_s, log.mass_g
    count = int(np.count_nonzero(rise.before))
    if count < _LEAST_REST:
        return _hardly_known(path, log, rise)
    before = rest_of(time[rise.before], mass[rise.before])
    drift, variance = _drift(time, mass, rise, before)
    level_variance = float(before.covariance[0, 0]) + log.tick_g**2 / _UNIFORM
    return Base(before.middle_s, before.level_g, drift, level_variance, variance)


def _hardly_known(path: Path, log: CleanLog, rise: Rise) -> Base:
    """Return the empty scale of a log with less than three readings of it."""
    time, mass = log.time_s, log.mass_g
    flows = (time > rise.begin_s) & (time < rise.end_s)
    usual = float(np.median(np.diff(mass[flows]))) if np.count_nonzero(flows) > 1 else np.inf
    tared = abs(mass[0]) <= _FIRST_GRAINS * float(np.ptp(mass))
    if mass[1] - mass[0] > _FLOWS * usual and not tared:
        msg = (
            f"{path}: the mass rises from the first reading on ({mass[0]:.4g} g), so that nothing "
            "tells the empty scale; start the log before the first grains arrive"
        )
        raise CalibrationError(msg)
    count = int(np.count_nonzero(rise.before))
    seen = mass[rise.before] if count else mass[:1]
    what = ("no reading", "1 reading", "2 readings")[count]
    remark = f"{what} before the mass rises; {seen.mean():.4g} g is taken for the empty scale"
    variance = float(np.var(seen)) + log.tick_g**2 / _UNIFORM
    return Base(float(time[0]), float(seen.mean()), 0.0, variance, 0.0, remark)


def _drift(time: Array, mass: Array, rise: Rise, before: Line) -> tuple[float, float]:
    """Return the drift that is taken off, and its variance."""
    if np.count_nonzero(rise.before) < _LEAST_DRIFT:
        return 0.0, 0.0
    rests = [(before, float(np.ptp(time[rise.before])))]
    if np.count_nonzero(rise.after) >= _LEAST_DRIFT:
        after = rest_of(time[rise.after], mass[rise.after])
        apart = abs(after.slope_g_s - before.slope_g_s)
        if apart**2 <= _DRIFT_SIGMAS**2 * (after.covariance[1, 1] + before.covariance[1, 1]):
            rests.append((after, float(np.ptp(time[rise.after]))))
    if sum(span for _, span in rests) < _DRIFT_SPAN * (rise.end_s - rise.begin_s):
        return 0.0, 0.0
    known = np.array([max(float(line.covariance[1, 1]), np.finfo(float).tiny) for line, _ in rests])
    slopes = np.array([line.slope_g_s for line, _ in rests])
    variance = 1.0 / float(np.sum(1.0 / known))
    drift = variance * float(np.sum(slopes / known))
    if drift**2 <= _DRIFT_SIGMAS**2 * variance:
        return 0.0, 0.0
    return drift, variance
