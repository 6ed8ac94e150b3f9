"""One quantity over time, from the file of an instrument: columns found, units converted."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.errors import CalibrationError, unknown_name
from calibrate.laboratory.instrument.cells import (
    decimals_in,
    is_reading,
    is_stamp,
    seconds_in,
)
from calibrate.laboratory.instrument.quantities import TIME, Quantity, is_named, unit_in_name
from calibrate.laboratory.instrument.sheet import Sheet, read_sheet
from calibrate.study.measured.tables import Row, Table

__all__ = ["Form", "Series", "read_series"]

_DAY: Final = 86400.0
_HALF_DAY: Final = 43200.0
"""A time of day that falls by more has passed midnight."""
_LARGEST: Final = 1e12
"""Of any number in base units: seconds since 1970 are 2e9; beyond are cells that are garbage."""
_SHORTEST_S: Final = 1e-6
"""Of a log: a shorter one has its times in another unit."""


@dataclass(frozen=True)
class Form:
    """What a user says of the columns of a log; empty where the file says it itself.

    Attributes
    ----------
    time_column, column : str
        Names of the columns of time and of what was measured.
    time_unit, unit : str
        Their units.
    """

    time_column: str = ""
    column: str = ""
    time_unit: str = ""
    unit: str = ""


@dataclass(frozen=True)
class Series:
    """A quantity over time, row by row as it stands in a file; arrays have shape (n,).

    Attributes
    ----------
    path : Path
    quantity : Quantity
    time_s : ndarray
        As the log counts; time stamps in seconds of the day. It never falls.
    values : ndarray
        In the base unit of the quantity.
    places : tuple of str
        File and line of each row, for messages.
    stamped : bool
        Whether the times are time stamps.
    tick_s, tick : float
        Steps in which times and values are written, in their base units.
    """

    path: Path
    quantity: Quantity
    time_s: Array
    values: Array
    places: tuple[str, ...]
    stamped: bool
    tick_s: float
    tick: float


def read_series(path: Path, quantities: Sequence[Quantity], form: Form) -> Series:
    """Read time and one of several quantities from the log of an instrument.

    Parameters
    ----------
    path : Path
    quantities : sequence of Quantity
        What the other column may be.
    form : Form

    Raises
    ------
    CalibrationError
        With file, line or column, value and remedy.
    """
    sheet = read_sheet(path)
    table = sheet.table
    time = _time_column(sheet, form)
    column, quantity = _value_column(sheet, quantities, form, time)
    by = _factor(sheet, column, quantity, form.unit)
    values = _numbers(table, column, quantity, by)
    stamped = any(is_stamp(row.cells[time]) for row in table.rows)
    if stamped:
        seconds, size = _stamps(table.rows, time), 1.0
    else:
        size = _factor(sheet, time, TIME, form.time_unit)
        seconds = _numbers(table, time, TIME, size)
    for row, step in zip(table.rows[1:], np.diff(seconds), strict=True):
        if step < 0.0:
            raise row.wrong(
                time,
                "is earlier than the row before; a log goes forward: sort it, or correct the head "
                "where columns are swapped",
            )
    if 0.0 < (span := float(seconds[-1] - seconds[0])) < _SHORTEST_S:
        msg = f"{path}: lasts {span:.2g} s from first to last row; give the unit of '{time}'"
        raise CalibrationError(msg)
    places = tuple(row.place for row in table.rows)
    ticks = size * _tick(table, time), by * _tick(table, column)
    return Series(path, quantity, seconds, values, places, stamped, *ticks)


def _numbers(table: Table, column: str, quantity: Quantity, by: float) -> Array:
    """Return a column in base units, (n,)."""
    found = np.array([row.number(column) for row in table.rows]) * by
    for k in np.flatnonzero(np.abs(found) > _LARGEST)[:1]:
        raise table.rows[k].wrong(
            column,
            f"is {found[k]:.2g} {quantity.unit}, which no instrument shows; correct the cell or "
            f"the unit ({quantity.unit_option})",
        )
    return found


def _readable(table: Table) -> list[str]:
    """Return the columns that begin with a reading."""
    return [name for name in table.columns if is_reading(table.rows[0].cells[name])]


def _time_column(sheet: Sheet, form: Form) -> str:
    table = sheet.table
    if form.time_column:
        return table.column(form.time_column)
    known = _readable(table)
    stamps = [name for name in known if is_stamp(table.rows[0].cells[name])]
    return (
        _the_one(sheet, TIME, stamps)
        or _the_one(sheet, TIME, _with_unit(sheet, known, TIME))
        or _the_one(sheet, TIME, [name for name in known if is_named(name, TIME)])
        or known[0]  # of a log without names
    )


def _value_column(
    sheet: Sheet, quantities: Sequence[Quantity], form: Form, time: str
) -> tuple[str, Quantity]:
    """Return the column of what was measured, and what it is."""
    table = sheet.table
    if form.column:
        column = table.column(form.column)
        return column, _quantity_of(sheet, column, quantities, form.unit)
    known = [name for name in _readable(table) if name != time]
    ways: tuple[Callable[[str, Quantity], bool], ...] = (
        lambda name, one: bool(_said(sheet, name, one)) and is_named(name, one),
        lambda name, one: bool(_said(sheet, name, one)),
        is_named,
    )
    for way in ways:
        fits = [name for name in known if any(way(name, one) for one in quantities)]
        if column := _the_one(sheet, quantities[0], fits):
            return column, _quantity_of(sheet, column, quantities, form.unit)
    if len(known) == 1:
        return known[0], _quantity_of(sheet, known[0], quantities, form.unit)
    words = " or ".join(one.name for one in quantities)
    msg = (
        f"{table.path}: no column says that it is the {words}; it has "
        f"{', '.join(table.columns)}: name it with {quantities[0].column_option}"
    )
    raise CalibrationError(msg)


def _the_one(sheet: Sheet, quantity: Quantity, names: Sequence[str]) -> str:
    """Return the only name, empty where there is none."""
    if len(names) > 1:
        called = [name for name in names if is_named(name, quantity)]
        if len(called) == 1:
            return called[0]
        msg = (
            f"{sheet.table.path}: columns {', '.join(names)} may all be the {quantity.name}; name "
            f"the one with {quantity.column_option}"
        )
        raise CalibrationError(msg)
    return names[0] if names else ""


def _with_unit(sheet: Sheet, names: Sequence[str], quantity: Quantity) -> list[str]:
    return [name for name in names if _said(sheet, name, quantity)]


def _said(sheet: Sheet, column: str, quantity: Quantity) -> str:
    """Return the unit of a column: in its name, behind its numbers, or in the column behind it."""
    if unit := unit_in_name(column, quantity):
        return unit
    if sheet.units.get(column, "") in quantity.units:
        return sheet.units[column]
    behind = sheet.table.columns[sheet.table.columns.index(column) + 1 :][:1]
    words = {row.cells[name] for name in behind for row in sheet.table.rows}
    word = words.pop() if len(words) == 1 else ""
    return word if word in quantity.units else ""


def _quantity_of(sheet: Sheet, column: str, quantities: Sequence[Quantity], unit: str) -> Quantity:
    """Return what a column holds, by its unit, or else by its name."""
    if len(quantities) == 1:
        return quantities[0]
    by_unit = [one for one in quantities if unit in one.units or _said(sheet, column, one)]
    by_name = [one for one in by_unit or quantities if is_named(column, one)]
    found = by_name or by_unit
    if len(found) == 1:
        return found[0]
    words = " or ".join(one.name for one in quantities)
    units = ", ".join(name for one in quantities for name in one.units)
    msg = (
        f"{sheet.table.path}: column '{column}' does not say whether it is {words}; give its unit "
        f"with {quantities[0].unit_option}, one of {units}"
    )
    raise CalibrationError(msg)


def _factor(sheet: Sheet, column: str, quantity: Quantity, given: str) -> float:
    """Return by what a column is multiplied to be in base units."""
    place, said = sheet.table.path, _said(sheet, column, quantity)
    if given and given not in quantity.units:
        msg = f"{quantity.unit_option} {given}: {unknown_name(given, quantity.units)}"
        raise CalibrationError(msg)
    if given and said and quantity.units[given] != quantity.units[said]:
        msg = (
            f"{place}: column '{column}' is in {said}, and {quantity.unit_option} says {given}; "
            "leave the option out, or correct the head"
        )
        raise CalibrationError(msg)
    if not given and not said:
        msg = (
            f"{place}: column '{column}' does not say its unit; give it with "
            f"{quantity.unit_option}, one of {', '.join(quantity.units)}, or write it in the head: "
            f"{quantity.name} [{quantity.unit}]"
        )
        raise CalibrationError(msg)
    return quantity.units[given or said]


def _stamps(rows: Sequence[Row], column: str) -> Array:
    """Return time stamps in seconds; what passes midnight goes on counting."""
    cells = [row.cells[column] for row in rows]
    stopwatch = any(cell.count(":") == 1 and ("." in cell or "," in cell) for cell in cells)
    seconds = np.empty(len(rows))
    for k, row in enumerate(rows):
        value = seconds_in(cells[k], stopwatch=stopwatch)
        if isinstance(value, str):
            raise row.wrong(column, value)
        seconds[k] = value
    fallen = np.diff(seconds, prepend=seconds[0]) < -_HALF_DAY
    return seconds + _DAY * np.cumsum(fallen)


def _tick(table: Table, column: str) -> float:
    """Return the step of the last decimal in a column."""
    return 10.0 ** -max(decimals_in(row.cells[column]) for row in table.rows)
