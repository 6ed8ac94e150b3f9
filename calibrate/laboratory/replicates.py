"""Mean and standard error of repeated numbers: words of a command line, or rows of a table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from calibrate.errors import CalibrationError, unknown_name
from calibrate.study.measured.decimals import mark_of, number_in
from calibrate.study.measured.repeats import mean_and_error, refuse_rows_twice
from calibrate.study.measured.tables import Row, Table, read_table
from calibrate.study.units import stated_unit

__all__ = ["Replicates", "numbers_in_table", "numbers_in_words", "replicates"]


@dataclass(frozen=True)
class Replicates:
    """Repeats of a measurement.

    Attributes
    ----------
    values : tuple of float
    mean, se : float
        Mean and its standard error.
    """

    values: tuple[float, ...]
    mean: float
    se: float


def replicates(values: Sequence[float], where: str) -> Replicates:
    """Return mean and standard error of two or more numbers that are not all the same.

    Parameters
    ----------
    values : sequence of float
    where : str
        Where they stand, for messages.

    Raises
    ------
    CalibrationError
    """
    if len(values) < 2:
        msg = (
            f"{where}: {len(values)} number{'s' if len(values) != 1 else ''}; two repeats are the "
            "fewest that tell an error: give more, or the standard error of one with --se"
        )
        raise CalibrationError(msg)
    mean, se = mean_and_error(values)
    if se == 0.0:
        msg = (
            f"{where}: all {len(values)} repeats are {values[0]:g}, so that they tell no error; "
            "read them more finely, or give the standard error of the mean with --se"
        )
        raise CalibrationError(msg)
    return Replicates(tuple(values), mean, se)


def numbers_in_words(words: Sequence[str]) -> list[float]:
    """Return numbers of a command line, with decimal points or commas.

    Raises
    ------
    CalibrationError
        With the word.

    Examples
    --------
    >>> numbers_in_words(["10.1", "9.9"]), numbers_in_words(["10,1"])
    ([10.1, 9.9], [10.1])
    """
    mark, found = mark_of(words), []
    for word in words:
        value = number_in(word.strip(), mark)
        if isinstance(value, str):
            msg = f"{word!r} {value}"
            raise CalibrationError(msg)
        found.append(value)
    return found


def numbers_in_table(path: Path, column: str, where: Mapping[str, str]) -> tuple[list[float], str]:
    """Return the numbers of a column, one for each row that counts, and the unit its name says.

    Parameters
    ----------
    path : Path
        Table with a row per repeat.
    column : str
    where : mapping
        Column to what has to stand there; all rows count where it is empty.

    Raises
    ------
    CalibrationError
        With file, line, column and value.
    """
    table = read_table(path)
    name = table.column(column)
    rows = _rows(table, where)
    refuse_rows_twice(table, rows, name)
    return [row.number(name) for row in rows], stated_unit(name) or ""


def _rows(table: Table, where: Mapping[str, str]) -> tuple[Row, ...]:
    """Return the rows that count; say what there is where there are none."""
    found = table.rows
    for asked, word in where.items():
        column = table.column(asked)
        known = dict.fromkeys(row.cells[column] for row in found)
        if word not in known:
            msg = f"{table.path}: --where {asked}={word}: {unknown_name(word, known)}"
            raise CalibrationError(msg)
        found = tuple(row for row in found if row.cells[column] == word)
    return found
