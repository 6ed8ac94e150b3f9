"""Repeats of a measurement: their mean and its standard error."""

from __future__ import annotations

import math
import statistics
from collections.abc import Sequence

from calibrate.errors import CalibrationError
from calibrate.study.measured.tables import Row, Table

__all__ = ["mean_and_error", "refuse_rows_twice"]


def mean_and_error(values: Sequence[float]) -> tuple[float, float]:
    """Return mean and standard error of the mean of two or more values.

    Examples
    --------
    >>> mean_and_error([9.0, 11.0])
    (10.0, 1.0)
    """
    return statistics.fmean(values), statistics.stdev(values) / math.sqrt(len(values))


def refuse_rows_twice(table: Table, rows: Sequence[Row], column: str) -> None:
    """Refuse repeats of which two are the same row; a table of values alone may hold equal ones.

    Raises
    ------
    CalibrationError
        With both lines.
    """
    seen: dict[tuple[str, ...], Row] = {}
    for row in rows:
        cells = tuple(row.cells.values())
        if cells in seen and {*table.columns} - {column, "particle", "material", "surface"}:
            msg = f"{row.place}: is the same as {seen[cells].place}; a repeat counts once"
            raise CalibrationError(msg)
        seen[cells] = row
