"""Several logs of one experiment: what they have in common, and how far they scatter."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.errors import CalibrationError
from calibrate.laboratory.scale.curve import Estimate, MassCurve
from calibrate.study.measured.repeats import mean_and_error

__all__ = ["QUANTITIES", "CurveTable", "Repeated", "curve_table", "quantity_of", "repeated"]

QUANTITIES: Final = {"time": "s", "onset": "s", "slope": "g/s", "plateau": "g"}
"""What a log tells, and its unit."""
_MOST_LEVELS: Final = 60
_STEPS: Final = (1.0, 2.0, 5.0, 10.0)
_RANGE: Final = 0.95
"""Part of the mass of the lightest log up to which a common curve goes."""


@dataclass(frozen=True)
class Repeated:
    """Mean of repeats.

    Attributes
    ----------
    value, se : float
        Mean and its standard error; of one log, what its readings leave open.
    repeats : int
        Logs behind a standard error; 0 for one log, whose repeats would scatter nobody knows how.
    """

    value: float
    se: float
    repeats: int


@dataclass(frozen=True)
class CurveTable:
    """Times at which masses lie on the scale; arrays have shape (L,), that of runs (L, n).

    Attributes
    ----------
    mass_g, time_s, se_s : ndarray
        Levels, mean times and their standard errors.
    runs_s : ndarray
        Times of each log.
    """

    mass_g: Array
    time_s: Array
    se_s: Array
    runs_s: Array


def quantity_of(curve: MassCurve, name: str, mass_g: float) -> Estimate:
    """Return one of the numbers in a log.

    Parameters
    ----------
    curve : MassCurve
    name : str
        One of `QUANTITIES`.
    mass_g : float
        Mass whose time is asked for.

    Raises
    ------
    CalibrationError
        When the log does not show it.
    """
    ways: dict[str, Callable[[], Estimate | None]] = {
        "time": lambda: curve.time_to(mass_g),
        "onset": lambda: curve.onset_s,
        "slope": lambda: curve.slope_g_s,
        "plateau": lambda: curve.plateau_g,
    }
    found = ways[name]()
    if found is None:
        msg = f"{curve.path}: shows no plateau: {'; '.join(curve.remarks)}; record longer"
        raise CalibrationError(msg)
    return found


def repeated(found: Sequence[Estimate]) -> Repeated:
    """Return the mean of repeats and its standard error.

    The error is that of their scatter, and never below what the readings themselves leave open:
    three equal times are luck, not knowledge.
    """
    read = math.sqrt(sum(one.se**2 for one in found)) / len(found)
    if len(found) == 1:
        return Repeated(found[0].value, read, 0)
    mean, se = mean_and_error([one.value for one in found])
    return Repeated(mean, max(se, read), len(found))


def curve_table(curves: Sequence[MassCurve]) -> CurveTable:
    """Return the common mass-time curve of several logs, at round masses.

    Raises
    ------
    CalibrationError
        When a log does not tell the time of a level.
    """
    highest = _RANGE * min(float(curve.rising_g[-1]) for curve in curves)
    raw = highest / _MOST_LEVELS
    power = 10.0 ** math.floor(math.log10(raw))
    step = power * next(one for one in _STEPS if one * power >= raw)
    levels = step * np.arange(1, int(highest / step) + 1)
    times = [[curve.time_to(float(level)) for curve in curves] for level in levels]
    means = [repeated(one) for one in times]
    return CurveTable(
        levels,
        np.array([one.value for one in means]),
        np.array([one.se for one in means]),
        np.array([[one.value for one in row] for row in times]),
    )
