"""Mass-time curves, measured or simulated, as the times at which fixed masses are reached."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.errors import CalibrationError
from calibrate.scales import scale_of
from calibrate.study.model import Curve
from calibrate.study.tables import Table
from calibrate.study.units import factor, stated_unit

__all__ = [
    "CURVE_SCALE",
    "CURVE_TIMES",
    "CurveTime",
    "MeasuredCurve",
    "first_time",
    "measured_curve",
    "times_of",
]

CURVE_LEVELS_G: Final = (25, 50, 75, 100)
"""Grams on the scale at which a mass-time curve is read."""
CURVE_TIMES: Final = {f"t{level}_s": float(level) for level in CURVE_LEVELS_G}
"""Name of each such time, as an observable, and its mass [g]."""
CURVE_SCALE: Final = scale_of("s")
"""Scale of all of them, whatever the study says of a target that the curve replaces."""

_MIN_ROWS: Final = 3
_LEAST_SLOPE: Final = 1e-9  # [g/s]; keeps the error of a time finite where the curve is flat


@dataclass(frozen=True)
class MeasuredCurve:
    """A measured mass-time curve; arrays have shape (n,), n at least 3.

    Attributes
    ----------
    time_s : ndarray
        Rising times [s].
    mass_g, sem_g : ndarray
        Mean mass on the scale and its standard error [g]; the mass never falls.
    repeats : int
        Measurements behind the standard errors; 0 where the table does not say.
    """

    time_s: Array
    mass_g: Array
    sem_g: Array
    repeats: int


@dataclass(frozen=True)
class CurveTime:
    """Time at which a curve reaches a mass.

    Attributes
    ----------
    name : str
        Name as an observable, for example ``t50_s``.
    time_s, sem_s : float
        Time and its standard error [s].
    """

    name: str
    time_s: float
    sem_s: float


def measured_curve(curve: Curve, table: Table) -> MeasuredCurve:
    """Read a measured curve; columns whose names end in another unit are converted.

    Parameters
    ----------
    curve : Curve
    table : Table
        Its file.

    Raises
    ------
    CalibrationError
        With file, line, column and value when a column is missing, a number is none, times do
        not rise, masses fall, or a unit does not fit.
    """
    wanted = ((curve.time_column, "s"), (curve.mass_column, "g"), (curve.sem_column, "g"))
    table.need(column for column, _ in wanted)
    columns = []
    for column, unit in wanted:
        by = factor(stated_unit(column) or unit, unit)
        columns.append(np.array([row.number(column) * by for row in table.rows], dtype=float))
    time, mass, sem = columns
    if len(time) < _MIN_ROWS:
        msg = f"{table.path}: {len(time)} rows; times must rise, with at least three rows"
        raise CalibrationError(msg)
    for k, row in enumerate(table.rows):
        if k and time[k] <= time[k - 1]:
            raise row.wrong(curve.time_column, "is not later than the row above; times must rise")
        if mass[k] < (mass[k - 1] if k else 0.0):
            raise row.wrong(curve.mass_column, "is less than above; masses must not fall")
        if sem[k] < 0.0:
            raise row.wrong(curve.sem_column, "is negative; give the standard error of the mass")
    return MeasuredCurve(time, mass, sem, table.rows[0].repeats())


def times_of(curve: MeasuredCurve) -> list[CurveTime]:
    """Return the times at which a curve reaches the fixed masses that lie on it.

    The error of a time is that of the mass at that time over the slope of the curve.
    """
    time, mass = curve.time_s, curve.mass_g
    found = []
    for name, level in CURVE_TIMES.items():
        if not mass[0] <= level <= mass[-1]:
            continue
        at = first_time(time, mass, level)
        flow = float(np.interp(at, time, np.gradient(mass, time)))
        error = float(np.interp(at, time, curve.sem_g)) / max(flow, _LEAST_SLOPE)
        found.append(CurveTime(name, at, error))
    return found


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
