"""Measured numbers of a study: given in it, read from a table, or taken from repeats."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from calibrate.errors import CalibrationError, suggest
from calibrate.scales import forward
from calibrate.study.measured.assigned import (
    Around,
    check_units,
    refuse_shared_rows,
    rows_here,
)
from calibrate.study.measured.repeats import groups_apart, mean_and_error, refuse_rows_twice
from calibrate.study.measured.tables import TARGET, Row, Table
from calibrate.study.schema.materials import Material
from calibrate.study.schema.targets import Target
from calibrate.study.units import factor, stated_unit
from liggghts_io.experiments import Observable

__all__ = ["Measured", "given_value", "impossible", "measured_value"]

LARGEST_SE: Final = 3.0
"""Standard error over value beyond which a measurement says nothing, and is rather a misprint."""


@dataclass(frozen=True)
class Measured:
    """Mean of a measurement.

    Attributes
    ----------
    value, se : float
        Mean and its standard error, in the unit of the simulated value.
    repeats : int
        Measurements behind the standard error; 0 where nobody says.
    source : str
        Where the number comes from, in the words of its file.
    doubt : str
        What is odd about the repeats behind it; empty where nothing is.
    """

    value: float
    se: float
    repeats: int = 0
    source: str = ""
    doubt: str = ""


def given_value(target: Target, source: str) -> Measured:
    """Return the value that a target gives itself, in the unit of the simulated one.

    Raises
    ------
    CalibrationError
        When it is none that can have been measured.
    """
    if not target.value and not target.se:  # as a new study has it
        msg = f"{target.name!r} is still to be filled in: its value and se are 0"
        raise CalibrationError(msg)
    by = factor(target.unit or "", target.simulated_unit)
    value, se = (target.value or 0.0) * by, (target.se or 0.0) * by
    given = ("value", target.value, _not_possible(target, value)), (
        "se", target.se, _no_error(target, value, se),
    )  # fmt: skip
    wrong = [f"{name} = {number:g} {what}" for name, number, what in given if what]
    if wrong:
        raise CalibrationError("; ".join(wrong))
    return Measured(value, se, target.repeats or 0, source)


def measured_value(
    target: Target, material: Material, table: Table, around: Around | None = None
) -> Measured:
    """Read the measured value of a target, in the unit of the simulated one.

    Parameters
    ----------
    target : Target
    material : Material
        The target's; rows are those of it and of the target's surface, as far as the table says.
    table : Table
        The target's file.
    around : Around, optional
        The rest of the study.

    Raises
    ------
    CalibrationError
        With file, line, column and value when a column or row is missing, nobody knows which rows
        are the target's, or a number is none that can have been measured.
    """
    column = table.column(target.column or "")
    rows = rows_here(target, material, table, around)
    if around is not None:
        refuse_shared_rows(target, table, around)
    check_units(table, rows, target.unit or "")
    by = _factor(target, column)
    if target.se_column is None:
        return _mean(target, table, rows, column, by)
    error = table.column(target.se_column)
    if len(rows) != 1:
        raise _not_one(target, material, table, rows)
    row = rows[0]
    value, se = row.number(column) * by, row.number(error) * _factor(target, error, strict=False)
    if wrong := _not_possible(target, value):
        raise row.wrong(column, wrong)
    if wrong := _no_error(target, value, se):
        raise row.wrong(error, wrong)
    repeats = row.repeats() if target.repeats is None else target.repeats
    return Measured(value, se, repeats, table.source)


def _mean(target: Target, table: Table, rows: Sequence[Row], column: str, by: float) -> Measured:
    """Return mean and standard error of the mean of repeats, one in each row."""
    where = f"for {target.material} on {target.surface}"
    if len(rows) < 2:
        msg = (
            f"{table.path}: {len(rows)} rows {where}; without se_column the rows are repeats, and "
            "two are the fewest that tell an error"
        )
        raise CalibrationError(msg)
    refuse_rows_twice(table, rows, column)
    values = [row.number(column) * by for row in rows]
    for row, value in zip(rows, values, strict=True):
        if wrong := _not_possible(target, value):
            raise row.wrong(column, wrong)
    mean, se = mean_and_error(values)
    if wrong := _no_error(target, mean, se):
        msg = f"{table.path}: the {len(rows)} repeats {where} give se = {se:g}, which {wrong}"
        raise CalibrationError(msg)
    return Measured(mean, se, len(values), table.source, groups_apart(table, rows, column))


def impossible(target: Target, value: float, se: float) -> str:
    """Return why a value with its standard error cannot be a target; empty if it can."""
    return _not_possible(target, value) or _no_error(target, value, se)


def _not_possible(target: Target, value: float) -> str:
    """Return why a value cannot have been measured; empty if it can."""
    one: Observable = target.observed
    if value <= 0.0 <= one.low:
        return f"{target.unit} is not a positive number, as {one.name} has to be"
    if one.low <= value <= one.high and np.isfinite(forward(target.model_scale, np.array(value))):
        return ""
    return (
        f"{target.unit} is not a possible value of {one.name}, {one.low:g} to {one.high:g} "
        f"{one.unit}"
    )


def _no_error(target: Target, value: float, se: float) -> str:
    """Return what is wrong with a standard error; empty if nothing is."""
    if se <= 0.0:
        return "is not a positive number: a mean without error decides everything; give its error"
    if target.observed.low >= 0.0 and se > LARGEST_SE * value > 0.0:
        return (
            f"is a standard error of {se / value:.2g} times the value; a mean "
            "that is known so little is no target: check the column and its unit, or leave the "
            "target out"
        )
    return ""


def _factor(target: Target, column: str, *, strict: bool = True) -> float:
    """Return by what a column is multiplied.

    Raises
    ------
    CalibrationError
        When a unit does not fit, or the name of the column of values contradicts it.
    """
    said = stated_unit(column)
    if strict and said is not None and said != target.unit:
        msg = (
            f"unit = '{target.unit}', but the name of column '{column}' says '{said}'; correct "
            "the unit, or rename the column"
        )
        raise CalibrationError(msg)
    try:
        return factor(said or target.unit or "", target.simulated_unit)
    except CalibrationError as err:
        msg = f"unit of '{column}': {err}"
        raise CalibrationError(msg) from err


def _not_one(
    target: Target, material: Material, table: Table, rows: Sequence[Row]
) -> CalibrationError:
    """Return the refusal of no row, or of several."""
    lines = ", ".join(row.place.rpartition(":")[2] for row in rows)
    which = f" (lines {lines})" if rows else ""
    if TARGET in table.columns:
        called = sorted({row.cells[TARGET] for row in table.rows})
        near = "" if target.name in called else suggest(target.name, called)
        where = f"target '{target.name}' of '{material.called}' on '{target.surface}'"
    else:
        column = "particle" if "particle" in table.columns else "material"
        known = sorted({row.cells[column] for row in table.rows if column in row.cells})
        near = "" if rows else suggest(material.called, known)
        where = f"{column} '{material.called}', surface '{target.surface}'"
    msg = f"{table.path}: {len(rows)} rows for {where}{which}; one is needed{near}"
    return CalibrationError(msg)
