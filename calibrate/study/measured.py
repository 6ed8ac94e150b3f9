"""Measured values of a study, read from its CSV files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from calibrate.errors import CalibrationError, suggest
from calibrate.study.model import Target
from calibrate.study.tables import Row, Table
from calibrate.study.units import factor, stated_unit
from liggghts_io.experiments import EXPERIMENTS

__all__ = ["Measured", "measured_value"]

LARGEST_SEM: Final = 3.0
"""Standard error over value beyond which a measurement says nothing, and is rather a misprint."""


@dataclass(frozen=True)
class Measured:
    """Mean of a measurement.

    Attributes
    ----------
    name : str
        Name of the target.
    value, sem : float
        Mean and its standard error, in the unit of the simulated value.
    source : str
        Where the number comes from, in the words of its file.
    repeats : int
        Measurements behind the standard error; 0 where the table does not say.
    """

    name: str
    value: float
    sem: float
    source: str
    repeats: int = 0


def measured_value(target: Target, particle: str, table: Table) -> Measured:
    """Read the measured value of a target, in the unit of the simulated one.

    Parameters
    ----------
    target : Target
    particle : str
        Name of the grains; the row is that of theirs and of the target's surface.
    table : Table
        The target's file.

    Raises
    ------
    CalibrationError
        With file, line, column and value when a column or row is missing, or a number is none
        that can have been measured.
    """
    table.need(("particle", "surface", target.column, target.sem_column))
    row = _row(particle, target, table)
    observable = EXPERIMENTS[target.experiment].observable(target.observable)
    by, sem_by = _factors(target)
    value, sem = row.number(target.column) * by, row.number(target.sem_column) * sem_by
    if not max(observable.low, 0.0) <= value <= observable.high or value == 0.0:
        limits = f"{observable.low:g} to {observable.high:g} {observable.unit}"
        what = f"{target.unit} is not a possible value of {target.observable}, {limits}"
        if value <= 0.0:
            what = f"{target.unit} is not a positive number, as {target.observable} has to be"
        raise row.wrong(target.column, what)
    if sem <= 0.0:
        what = "is not a positive number: a mean without error decides everything; give its error"
        raise row.wrong(target.sem_column, what)
    if sem > LARGEST_SEM * value:
        what = (
            f"is a standard error of {sem / value:.2g} times the value; a mean that is known so "
            "little is no target: check the column and its unit, or leave the target out"
        )
        raise row.wrong(target.sem_column, what)
    return Measured(target.name, value, sem, table.source, row.repeats())


def _factors(target: Target) -> tuple[float, float]:
    """Return by what value and standard error are multiplied.

    Raises
    ------
    CalibrationError
        When a unit does not fit, or the name of a column contradicts it.
    """
    wanted = target.simulated_unit
    said = stated_unit(target.column)
    if said is not None and said != target.unit:
        msg = (
            f"unit = '{target.unit}', but the name of column '{target.column}' says '{said}'; "
            "correct the unit, or rename the column"
        )
        raise CalibrationError(msg)
    try:
        return (
            factor(target.unit, wanted),
            factor(stated_unit(target.sem_column) or target.unit, wanted),
        )
    except CalibrationError as err:
        msg = f"unit of '{target.column}' or '{target.sem_column}': {err}"
        raise CalibrationError(msg) from err


def _row(particle: str, target: Target, table: Table) -> Row:
    """Return the one row of the study's particle and the target's surface."""
    wanted: Mapping[str, str] = {"particle": particle, "surface": target.surface}
    rows = [row for row in table.rows if wanted.items() <= row.cells.items()]
    if len(rows) != 1:
        near = suggest(particle, sorted({row.cells["particle"] for row in table.rows}))
        msg = (
            f"{table.path}: {len(rows)} rows for particle '{particle}', surface "
            f"'{target.surface}'; one is needed{near}"
        )
        raise CalibrationError(msg)
    return rows[0]
