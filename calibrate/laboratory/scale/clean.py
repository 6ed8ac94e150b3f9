"""What is no reading of the flow is taken out of a log: rows twice, bumps, a scale handled."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np
from scipy.ndimage import maximum_filter, median_filter

from calibrate.arrays import Array
from calibrate.errors import CalibrationError
from calibrate.laboratory.instrument.series import Series
from calibrate.laboratory.scale.timing import renewed

__all__ = ["CleanLog", "cleaned"]

_LEAST_ROWS: Final = 8
_BUMP_S: Final = 1.0
"""Twice the longest bump that is taken out: a running median sees through less than half of it."""
_LEAST_WINDOW: Final = 7
_LOCAL: Final = 31
"""Readings over which the scatter is told that a bump has to exceed."""
_BUMP_SIGMAS: Final = 6.0
_SIGMA_PER_MAD: Final = 1.4826
_BUMP_TICKS: Final = 4.0
"""Of the scale: less is rounding."""
_BUMP_SHARE: Final = 0.002
"""Of the range of a log: less moves nothing, and among few readings is no more than scatter."""
_PASSES: Final = 20
_LARGEST: Final = 0.6
"""Part of the largest bump within a window from which one goes at once."""
_STEP_SHARE: Final = 0.01
"""Of the range of a log: what falls by more within a second did not flow."""
_STEP_SIGMAS: Final = 8.0
_STEP_RATIO: Final = 4.0
"""Times what came in the seconds before and after: what rises by more did not flow either."""
_AT_REST: Final = 0.05
"""Part of a step that may flow in as much time beside it, if the scale is at rest there."""
_NO_TIME: Final = 1e-12
"""Beyond either end of a log, where nothing changes."""
_SECOND_RISE: Final = 0.1
"""Part of the rise that may lie on the other side of a step."""


@dataclass(frozen=True)
class CleanLog:
    """Readings of one rise of the mass; arrays have shape (n,).

    Attributes
    ----------
    time_s, mass_g : ndarray
        Times rise.
    tick_s, tick_g : float
        Steps in which the times of readings are known, and in which the scale tells masses.
    twice, old, bumps, handled : int
        Rows taken out: repeated ones, those that repeat a reading because the scale had no new one,
        those of bumps, those before and after handling.
    """

    time_s: Array
    mass_g: Array
    tick_s: float
    tick_g: float
    twice: int
    old: int
    bumps: int
    handled: int


def cleaned(series: Series) -> CleanLog:
    """Take out of a log what is no reading of the flow.

    Rows with one time become one, with their mean. Rows in which a slow scale says the same again
    are left out, and what the others are late in the mean is taken off. A reading far from the
    running median of its neighbours is a bump. Where the mass falls, or rises at once while nothing
    flows, somebody tared the scale or put something on it; what counts is the side on which it
    rises.

    Parameters
    ----------
    series : Series
        Mass [g].

    Raises
    ------
    CalibrationError
        When too few rows are left, or the scale was handled while the mass rose; with the line.
    """
    time, first, inverse = np.unique(series.time_s, return_index=True, return_inverse=True)
    mass = np.bincount(inverse, series.values) / np.bincount(inverse)
    rows, tick_s = len(time), series.tick_s
    if (slow := renewed(time, mass, series.tick)) is not None:
        time, mass, first = time[slow.keep] - slow.late_s, mass[slow.keep], first[slow.keep]
        tick_s = max(tick_s, slow.tick_s)
    _enough(series, len(time))
    old = rows - len(time)
    window = _window(time)
    keep = _without_bumps(mass, window, series.tick)
    bumps = int(np.count_nonzero(~keep))
    time, mass, first = time[keep], mass[keep], first[keep]
    begin, end = _rise(series, time, mass, first, window)
    if end - begin < _LEAST_ROWS:
        msg = (
            f"{series.path}: the mass rises in {end - begin} readings only, the others are taken "
            "for handling of the scale; is this the log of a flow onto a scale?"
        )
        raise CalibrationError(msg)
    return CleanLog(
        time[begin:end],
        mass[begin:end],
        tick_s=tick_s,
        tick_g=series.tick,
        twice=len(series.time_s) - rows,
        old=old,
        bumps=bumps,
        handled=len(time) - (end - begin),
    )


def _enough(series: Series, count: int) -> None:
    if count < _LEAST_ROWS:
        msg = (
            f"{series.path}: readings at {count} different times; at least {_LEAST_ROWS} are "
            "needed: let the scale send more per second"
        )
        raise CalibrationError(msg)


def _window(time: Array) -> int:
    """Return the odd number of readings in the window of the running median."""
    count = round(_BUMP_S / float(np.median(np.diff(time))))
    return max(_LEAST_WINDOW, min(count, len(time) // 2) // 2 * 2 + 1)


def _without_bumps(mass: Array, window: int, tick_g: float) -> Array:
    """Return which readings stay, (n,) bool.

    A bump draws the median of its neighbours towards it; so the largest go first, and the others
    are looked at again without them.
    """
    keep = np.ones(len(mass), dtype=bool)
    for _ in range(_PASSES):
        off, limit = _off_neighbours(mass[keep], window, tick_g)
        bumps = (off > limit) & (off >= _LARGEST * maximum_filter(off, window))
        if not bumps.any():
            break
        keep[np.flatnonzero(keep)[bumps]] = False
    edges = np.flatnonzero(np.diff(np.concatenate([[0], (~keep).astype(int), [0]])))
    for begin, end in zip(edges[::2], edges[1::2], strict=True):
        if end - begin > window:  # a step, eaten from its edges: not for this to judge
            keep[begin:end] = True
    return keep


def _off_neighbours(mass: Array, window: int, tick_g: float) -> tuple[Array, Array]:
    """Return how far readings lie from the median of their neighbours, and how far they may."""
    smooth = median_filter(mass, window, mode="nearest")
    off = np.abs(mass - smooth)
    usual = _SIGMA_PER_MAD * median_filter(off, max(_LOCAL, window), mode="nearest")
    least = max(_BUMP_TICKS * tick_g, _BUMP_SHARE * float(np.ptp(smooth)))
    return off, np.maximum(_BUMP_SIGMAS * usual, least)


def _rise(series: Series, time: Array, mass: Array, first: Array, window: int) -> tuple[int, int]:
    """Return the first reading of the part in which the mass rises, and the one behind its end."""
    lag = max(3, round(_BUMP_S / float(np.median(np.diff(time)))))
    smooth = median_filter(mass, min(window, 2 * lag + 1), mode="nearest")
    scatter = float(np.sqrt(np.mean((mass - smooth) ** 2)))
    steps = _steps(
        time, smooth, lag, max(_STEP_SHARE * float(np.ptp(smooth)), _STEP_SIGMAS * scatter)
    )
    if not steps:
        return 0, len(time)
    edges = [(0, steps[0][0] + 1)]
    edges += [(a[1], b[0] + 1) for a, b in pairwise(steps)]
    edges += [(steps[-1][1], len(time))]
    rises = [float(np.ptp(smooth[a:b])) if b - a > lag else 0.0 for a, b in edges]
    best = int(np.argmax(rises))
    for side, step in ((best - 1, best - 1), (best + 1, best)):
        if 0 <= side < len(rises) and rises[side] > _SECOND_RISE * rises[best]:
            begin, end = steps[step]
            change = smooth[end] - smooth[begin]
            msg = (
                f"{series.places[first[begin]]}: the mass {'rises' if change > 0 else 'falls'} by "
                f"{abs(change):.3g} g at once, between two parts in which it flows; cut the log so "
                "that one of them is left, or repeat the run"
            )
            raise CalibrationError(msg)
    return edges[best]


def _steps(time: Array, smooth: Array, lag: int, limit: float) -> list[tuple[int, int]]:
    """Return where a scale was handled: last reading before and first one after each step.

    Rises are judged by their rates, so that a gap in the readings of a flow is none.

    Parameters
    ----------
    time, smooth : (n,) float64
        Times [s] and readings without bumps [g].
    lag : int
        Readings within which a step happens.
    limit : float
        Smallest step [g].
    """
    if len(smooth) <= lag:
        return []
    padded, clock = (np.pad(one, lag, mode="edge") for one in (smooth, time))
    apart = (padded[lag:] - padded[:-lag], np.maximum(clock[lag:] - clock[:-lag], _NO_TIME))
    changes, rates = apart[0], apart[0] / apart[1]
    change, rate = changes[lag:-lag], rates[lag:-lag]
    beside = np.maximum(np.abs(rates[: -2 * lag]), np.abs(rates[2 * lag :]))
    at_rest = (change > limit) & (_AT_REST * rate > beside)
    in_flow = (np.abs(changes[: -2 * lag]) > limit) & (rate > _STEP_RATIO * beside)
    stepped = np.concatenate([[0], ((change < -limit) | at_rest | in_flow).astype(int), [0]])
    edges = np.flatnonzero(np.diff(stepped))
    return [(int(a), int(b) - 1 + lag) for a, b in zip(edges[::2], edges[1::2], strict=True)]
