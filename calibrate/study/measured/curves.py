"""Measured curves, read at the levels at which they are compared.

A table may give y against x, or x against y as a scale records mass over time; the units of its
columns say which.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.errors import CalibrationError
from calibrate.study.measured.assigned import Around, check_units, rows_here
from calibrate.study.measured.tables import Row, Table
from calibrate.study.schema.materials import Material
from calibrate.study.schema.targets import Target
from calibrate.study.units import dimension, factor, stated_unit
from liggghts_io.experiments import Curve

__all__ = ["MeasuredCurve", "first_time", "measured_curve"]

_MIN_ROWS: Final = 3
_LEAST_SLOPE: Final = 1e-9
"""Keeps the error of a level finite where a curve is flat [unit of the column per unit of x]."""
_GAP: Final = 10.0
"""Times the median distance of rows beyond which nobody knows what a curve does in between."""


@dataclass(frozen=True)
class MeasuredCurve:
    """A measured curve at the levels that it reaches; arrays have shape (L,).

    Attributes
    ----------
    levels : ndarray
        In the unit of the curve's x, rising.
    values, se : ndarray
        y there and its standard error, in the unit of the curve.
    repeats : int
        Measurements behind the standard errors; 0 where nobody says.
    source : str
        Where it comes from, in the words of its file.
    """

    levels: Array
    values: Array
    se: Array
    repeats: int
    source: str = ""


@dataclass(frozen=True)
class _Sheet:
    """Rows of a curve: what stands in its x column, in the curve's units, and how to read it."""

    table: Table
    rows: tuple[Row, ...]
    across: Array
    swapped: bool


def measured_curve(
    target: Target, material: Material, table: Table, around: Around | None = None
) -> MeasuredCurve:
    """Read a measured curve.

    Parameters
    ----------
    target : Target
        A target whose observable is a curve.
    material : Material
        Its material; rows are those of it and of the target's surface, as far as the table says.
    table : Table
        Its file.
    around : Around, optional
        The rest of the study.

    Raises
    ------
    CalibrationError
        With file, line, column and value when a column is missing, a number is none, the curve
        has a gap or goes backwards, a unit does not fit, or no level is reached.
    """
    kind = target.curve
    if kind is None:
        msg = f"target '{target.name}' is no curve"
        raise CalibrationError(msg)
    levels = np.array(target.levels or kind.levels, dtype=float)
    names = [table.column(name) for name in target.columns or [target.column or ""]]
    rows = rows_here(target, material, table, around)
    for said in (stated_unit(name) or target.unit for name in names):
        if said:
            check_units(table, rows, said)
    sheet = _sheet(target, kind, table, rows, names)
    if target.columns:
        columns = [_column(sheet, kind, name, levels)[0] for name in names]
        found = np.array(columns)
        values = found.mean(axis=0)
        se = found.std(axis=0, ddof=1) / math.sqrt(len(names))
        repeats = len(names)
    else:
        error = table.column(target.se_column or "")
        values, se = _column(sheet, kind, names[0], levels, error)
        repeats = sheet.rows[0].repeats() if target.repeats is None else target.repeats
    reached = np.isfinite(values)
    if not reached.any():
        msg = (
            f"{table.path}: reaches none of the levels {_list(levels)} {kind.x_unit} at which it "
            "is compared; give levels that lie on it"
        )
        raise CalibrationError(msg)
    if not np.all(se[reached] > 0.0):
        msg = (
            f"{table.path}: no error at the level {_list(levels[reached][se[reached] <= 0.0])} "
            f"{kind.x_unit}: a mean without error decides everything; give its error"
        )
        raise CalibrationError(msg)
    return MeasuredCurve(levels[reached], values[reached], se[reached], repeats, table.source)


def _list(levels: Array) -> str:
    return ", ".join(f"{level:g}" for level in levels)


def _sheet(
    target: Target, kind: Curve, table: Table, rows: tuple[Row, ...], names: Sequence[str]
) -> _Sheet:
    """Return the rows of a curve, their x rising and without a gap."""
    column = table.column(target.x_column or "")
    swapped = _swapped(target, kind, column, names[0], table)
    if len(rows) < _MIN_ROWS:
        msg = f"{table.path}: rows of a curve: {len(rows)}; at least three are needed"
        raise CalibrationError(msg)
    by = _factor(column, kind.unit if swapped else kind.x_unit)
    across = np.array([row.number(column) * by for row in rows])
    for k, row in enumerate(rows):
        if k and across[k] <= across[k - 1]:
            again = "stands still" if across[k] == across[k - 1] else "goes backwards"
            raise row.wrong(column, f"is not above the row before: the curve {again}; it must rise")
    steps = np.diff(across)
    for row, step in zip(rows[1:], steps, strict=True):
        if step > _GAP * float(np.median(steps)):
            raise row.wrong(column, "comes after a gap of ten times the usual distance; fill it")
    return _Sheet(table, rows, across, swapped)


def _swapped(target: Target, kind: Curve, x: str, y: str, table: Table) -> bool:
    """Return whether a table gives x over y, as its units say."""
    said = dimension(stated_unit(y) or target.unit or ""), dimension(stated_unit(x) or "")
    straight = dimension(kind.unit), dimension(kind.x_unit)
    if straight[0] == straight[1]:
        return False
    turned = straight[::-1]
    fits = [all(s in ("", w) for s, w in zip(said, way, strict=True)) for way in (straight, turned)]
    if fits == [True, True]:
        msg = (
            f"{table.path}: columns '{x}' and '{y}' do not say their units; write them behind the "
            f"names, such as '{kind.x_name}_{kind.x_unit}', so that it is clear which is which"
        )
        raise CalibrationError(msg)
    if fits == [False, False]:
        msg = (
            f"{table.path}: columns '{x}' and '{y}' are in other units than {kind.name}, which "
            f"has {kind.unit} against {kind.x_unit}"
        )
        raise CalibrationError(msg)
    return fits[1]


def _factor(column: str, unit: str) -> float:
    try:
        return factor(stated_unit(column) or unit, unit)
    except CalibrationError as err:
        msg = f"unit of '{column}': {err}"
        raise CalibrationError(msg) from err


def _column(
    sheet: _Sheet, kind: Curve, name: str, levels: Array, error: str = ""
) -> tuple[Array, Array]:
    """Return a column at the levels and its error there; nan where it does not reach.

    The error of y at a level of x, in a table of x over y, is that of x over the slope.
    """
    unit = kind.x_unit if sheet.swapped else kind.unit
    y = np.array([row.number(name) for row in sheet.rows]) * _factor(name, unit)
    se = np.zeros_like(y)
    if error:
        se = np.array([row.number(error) for row in sheet.rows]) * _factor(error, unit)
        for row, one in zip(sheet.rows, se, strict=True):
            if one < 0.0:
                raise row.wrong(error, "is negative; give the standard error")
    if not sheet.swapped:
        outside = (levels < sheet.across[0]) | (levels > sheet.across[-1])
        values = np.where(outside, np.nan, np.interp(levels, sheet.across, y))
        return values, np.interp(levels, sheet.across, se)
    for k, row in enumerate(sheet.rows):
        if y[k] < (y[k - 1] if k else 0.0):
            raise row.wrong(name, f"is less than above; the {kind.x_name} must not fall")
    inside = (levels >= y[0]) & (levels <= y[-1])
    at = np.array([first_time(sheet.across, y, one) if ok else np.nan
                   for one, ok in zip(levels, inside, strict=True)])  # fmt: skip
    slope = np.interp(at, sheet.across, np.gradient(y, sheet.across))
    return at, np.interp(at, sheet.across, se) / np.maximum(slope, _LEAST_SLOPE)


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
