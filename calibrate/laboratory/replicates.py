"""Mean and standard error of repeated numbers: words of a command line, or rows of a table."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from calibrate.errors import CalibrationError, unknown_name
from calibrate.study.measured.assigned import HEADS, alike, column_in_other_words
from calibrate.study.measured.repeats import groups_apart, mean_and_error, refuse_rows_twice
from calibrate.study.measured.tables import MATERIAL, SURFACE, UNIT, Row, Table, read_table
from calibrate.study.units import stated_unit
from liggghts_io.decimals import mark_of, number_in

__all__ = ["Column", "Replicates", "numbers_in_table", "numbers_in_words", "replicates"]


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


@dataclass(frozen=True)
class Column:
    """Numbers in a column of a table.

    Attributes
    ----------
    numbers : tuple of float
    unit : str
        As the name of the column or a column ``unit`` says; empty where neither does.
    doubt : str
        What is odd about them as repeats; empty where nothing is.
    """

    numbers: tuple[float, ...]
    unit: str
    doubt: str


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


def numbers_in_table(
    path: Path, column: str, where: Mapping[str, str], surface: str = "", material: str = ""
) -> Column:
    """Return the numbers of a column, one for each row that counts, and their unit.

    Parameters
    ----------
    path : Path
        Table with a row per repeat.
    column : str
    where : mapping
        Column to what has to stand there; all rows count where it is empty.
    surface, material : str, optional
        Wall and bulk solid whose rows count, as far as the table tells them apart.

    Raises
    ------
    CalibrationError
        With file, line, column and value; also where rows of several walls or materials count.
    """
    table = read_table(path)
    name = table.column(column)
    rows = _rows(table, where)
    taken = {table.column(asked) for asked in where}
    for what, word in ((SURFACE, surface), (MATERIAL, material)):
        rows = _rows_of(table, rows, what, word, taken)
    refuse_rows_twice(table, rows, name)
    numbers = tuple(row.number(name) for row in rows)
    return Column(numbers, _unit(rows, name), groups_apart(table, rows, name))


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


def _rows_of(
    table: Table, rows: tuple[Row, ...], what: str, word: str, taken: Collection[str]
) -> tuple[Row, ...]:
    """Return the rows of one wall or material; nobody wants the mean of several.

    Parameters
    ----------
    table : Table
    rows : tuple of Row
    what : {"surface", "material"}
    word : str
        The one that is asked for, empty where none is.
    taken : collection of str
        Columns of which --where has chosen already.
    """
    columns = [column for column in HEADS[what] if column in table.columns]
    if not columns:
        other = column_in_other_words(table, rows, what, [word] if word else [])
        columns = [other] if other else []
    for column in columns:
        known = dict.fromkeys(row.cells[column] for row in rows)
        one = len(known) == 1 and (not word or column not in HEADS[what] or "" in known)
        if column in taken or one:
            continue
        if not word:
            shown = ", ".join(f"'{one}'" for one in known)
            msg = (
                f"{table.path}: column '{column}' holds {shown}; say whose rows count with "
                f"--{what} or --where {column}={next(iter(known))}"
            )
            raise CalibrationError(msg)
        if not any(alike(one, word) for one in known):
            msg = (
                f"{table.path}: --{what} {word}: no row of column '{column}' (if it has another "
                f"name there, add --where {column}=NAME): {unknown_name(word, known)}"
            )
            raise CalibrationError(msg)
        exact = word in known
        rows = tuple(
            row for row in rows
            if row.cells[column] == word or (not exact and alike(row.cells[column], word))
        )  # fmt: skip
    return rows


def _unit(rows: Sequence[Row], column: str) -> str:
    """Return the unit of a column, from its name or the cells of a column for it.

    Raises
    ------
    CalibrationError
        Where they say several.
    """
    said = stated_unit(column) or ""
    for row in rows:
        cell = row.cells.get(UNIT, "")
        if cell and said and cell != said:
            msg = f"but '{said}' is said by the name of column '{column}' or a row above; use one"
            raise row.wrong(UNIT, msg)
        said = said or cell
    return said
