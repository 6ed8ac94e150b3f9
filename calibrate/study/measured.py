"""Measured values of a study, read from its CSV files."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from calibrate.errors import CalibrationError, suggest
from calibrate.study.load import data_file
from calibrate.study.model import Study, Target
from calibrate.study.tables import Table, read_table

__all__ = ["Measured", "read_measured"]


@dataclass(frozen=True)
class Measured:
    """Mean of a measurement.

    Attributes
    ----------
    name : str
        Name of the target.
    value, sem : float
        Mean and its standard error, in the target's unit.
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


def read_measured(study: Study, study_path: Path) -> dict[str, Measured]:
    """Read the measured value of every target; a file of several targets is read once.

    Parameters
    ----------
    study : Study
        Checked study.
    study_path : Path
        Its file; the CSV files lie beside it.

    Returns
    -------
    dict of str to Measured
        By target name, in the study's order.

    Raises
    ------
    CalibrationError
        When a column or row is missing, or a value is not a positive number.
    """
    files = dict.fromkeys(target.file for target in study.target)
    tables = {file: read_table(data_file(study_path, file)) for file in files}
    return {t.name: _measured(study, t, tables[t.file]) for t in study.target}


def _measured(study: Study, target: Target, table: Table) -> Measured:
    table.need(("particle", "surface", target.column, target.sem_column))
    row = _row(study, target, table)
    value = _positive(table.path, target.column, row[target.column])
    sem = _positive(table.path, target.sem_column, row[target.sem_column])
    repeats = int(row["repeats"]) if "repeats" in row else 0
    return Measured(target.name, value, sem, table.source, repeats)


def _row(study: Study, target: Target, table: Table) -> pd.Series:
    """Return the one row of the study's particle and the target's surface."""
    particles = table.rows["particle"]
    rows = table.rows[(particles == study.particle) & (table.rows["surface"] == target.surface)]
    if len(rows) != 1:
        near = suggest(study.particle, sorted(set(particles.astype(str))))
        msg = (
            f"{table.path}: {len(rows)} rows for particle '{study.particle}', surface "
            f"'{target.surface}'; one is needed{near}"
        )
        raise CalibrationError(msg)
    return rows.iloc[0]


def _positive(path: Path, column: str, raw: object) -> float:
    try:
        value = float(str(raw))
    except ValueError:
        value = math.nan
    if not (math.isfinite(value) and value > 0.0):
        msg = f"{path}: {column} = {raw!r} is not a positive number"
        raise CalibrationError(msg)
    return value
