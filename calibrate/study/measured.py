"""Measured values of a study, read from its CSV files."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from calibrate.errors import CalibrationError, suggest
from calibrate.study.load import data_file
from calibrate.study.model import Study, Target

__all__ = ["Measured", "read_measured", "source_line"]


@dataclass(frozen=True)
class Measured:
    """Mean of a measurement and the standard error of that mean, in the target's unit."""

    name: str
    value: float
    sem: float
    source: str


def read_measured(study: Study, study_path: Path) -> dict[str, Measured]:
    """Read the measured value of every target.

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
    return {t.name: _read(study, t, data_file(study_path, t.file)) for t in study.target}


def _read(study: Study, target: Target, path: Path) -> Measured:
    try:
        table = pd.read_csv(path, comment="#")
    except (ValueError, OSError) as err:
        msg = f"{path}: cannot be read as CSV: {err}"
        raise CalibrationError(msg) from err
    columns = [str(c) for c in table.columns]
    for column in ("particle", "surface", target.column, target.sem_column):
        if column not in columns:
            msg = f"{path}: no column '{column}'{suggest(column, columns)}"
            raise CalibrationError(msg)
    rows = table[(table["particle"] == study.particle) & (table["surface"] == target.surface)]
    if len(rows) != 1:
        particles = sorted(set(table["particle"].astype(str)))
        msg = (
            f"{path}: {len(rows)} rows for particle '{study.particle}', surface "
            f"'{target.surface}'; one is needed{suggest(study.particle, particles)}"
        )
        raise CalibrationError(msg)
    value = _positive(path, target.column, rows[target.column].iloc[0])
    sem = _positive(path, target.sem_column, rows[target.sem_column].iloc[0])
    return Measured(target.name, value, sem, source_line(path))


def _positive(path: Path, column: str, raw: object) -> float:
    try:
        value = float(str(raw))
    except ValueError:
        value = math.nan
    if not (math.isfinite(value) and value > 0.0):
        msg = f"{path}: {column} = {raw!r} is not a positive number"
        raise CalibrationError(msg)
    return value


def source_line(path: Path) -> str:
    """Return the first comment line of a CSV file, which names its source."""
    with path.open(encoding="utf-8") as file:
        first = file.readline().strip()
    return first.removeprefix("#").strip() if first.startswith("#") else path.name
