"""Repeats of a measurement: their mean and its standard error."""

from __future__ import annotations

import math
import statistics
from collections.abc import Sequence
from typing import Final

from calibrate.errors import CalibrationError
from calibrate.study.measured.tables import Row, Table
from liggghts_io.decimals import number_in

__all__ = ["groups_apart", "mean_and_error", "refuse_rows_twice"]

_LEAST_OF_A_GROUP: Final = 2
_APART: Final = 5.0
"""Standard deviations within groups by which means of repeats of one thing do not differ."""


def mean_and_error(values: Sequence[float]) -> tuple[float, float]:
    """Return mean and standard error of the mean of two or more values.

    Examples
    --------
    >>> mean_and_error([9.0, 11.0])
    (10.0, 1.0)
    """
    return statistics.fmean(values), statistics.stdev(values) / math.sqrt(len(values))


def groups_apart(table: Table, rows: Sequence[Row], column: str) -> str:
    """Say which words tell repeats apart in groups that are none of one another; empty if none do.

    Walls and materials are known by their heads; this finds what stands under any other one.

    Parameters
    ----------
    table : Table
    rows : sequence of Row
        Repeats.
    column : str
        Holds their numbers.
    """
    for name in table.columns:
        groups: dict[str, list[float]] = {}
        for row in rows:
            groups.setdefault(row.cells[name], []).append(row.number(column))
        words = all(isinstance(number_in(word, ""), str) for word in groups)
        few = min(map(len, groups.values()), default=0) < _LEAST_OF_A_GROUP
        if name == column or len(groups) < 2 or few or not words:
            continue
        within = math.sqrt(statistics.fmean(map(statistics.variance, groups.values())))
        means = {word: statistics.fmean(values) for word, values in groups.items()}
        low, high = min(means, key=means.__getitem__), max(means, key=means.__getitem__)
        if means[high] - means[low] > _APART * within:
            return (
                f"{table.path.name}: repeats of '{low}' and '{high}' in column '{name}' are "
                f"{means[low]:.4g} and {means[high]:.4g}, farther apart than they scatter; if "
                "these are several walls or materials, their mean is that of none"
            )
    return ""


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
