"""A CSV file of measured data: its rows with their lines, and the line that names its source."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from calibrate.errors import CalibrationError, suggest
from calibrate.study.measured.files import bytes_of, text_in
from calibrate.study.units import bare_name
from liggghts_io.decimals import Mark, marks_of, number_in

__all__ = [
    "LARGEST_TABLE",
    "MATERIAL",
    "PARTICLE",
    "REPEATS",
    "SURFACE",
    "TARGET",
    "UNIT",
    "Row",
    "Table",
    "cells_of",
    "full_lines",
    "read_table",
    "separator_of",
    "table_from",
    "table_of",
]

LARGEST_TABLE: Final = 10_000_000
"""Bytes of a table; more are no means of measurements, and reading them would keep one waiting."""

PARTICLE: Final = "particle"
MATERIAL: Final = "material"
SURFACE: Final = "surface"
"""Columns with the bulk solid, under either name, and with the wall of a row."""
REPEATS: Final = "repeats"
"""Column with the number of measurements behind a standard error."""
TARGET: Final = "target"
"""Column with the name of the target that a row is for; then other cells may be left empty."""
UNIT: Final = "unit"
"""Column with the unit of a row's value and error."""
_OWN_HEADS: Final = (PARTICLE, MATERIAL, SURFACE, REPEATS, TARGET, UNIT)
"""Columns with a meaning of their own, which people write with capitals too."""

_LONGEST_SHOWN: Final = 60
_SEPARATORS: Final = ("\t", ";", ",")
"""What may separate columns, in the order in which the head is searched for it."""


@dataclass(frozen=True)
class Row:
    """A row of a CSV file.

    Attributes
    ----------
    place : str
        File and line, for messages.
    cells : mapping
        Column to what stands there, without spaces around it.
    marks : mapping
        Column to its decimal mark.
    """

    place: str
    cells: Mapping[str, str]
    marks: Mapping[str, Mark] = field(default_factory=dict)

    def number(self, column: str) -> float:
        """Return a finite number.

        Raises
        ------
        CalibrationError
            With place, column and value.
        """
        value = number_in(self.cells[column], self.marks.get(column, ""))
        if isinstance(value, str):
            raise self.wrong(column, value)
        return value

    def repeats(self) -> int:
        """Return the measurements behind a standard error, 0 where the table does not say.

        Raises
        ------
        CalibrationError
            With place and value.
        """
        text = self.cells.get(REPEATS, "")
        if text and not (text.isdecimal() and len(text) < 10 and int(text) > 0):
            raise self.wrong(REPEATS, "is not a whole number from 1; leave it empty if unknown")
        return int(text or 0)

    def wrong(self, column: str, what: str) -> CalibrationError:
        """Return the refusal of a cell."""
        text = self.cells[column]
        shown = text if len(text) <= _LONGEST_SHOWN else text[:_LONGEST_SHOWN] + "..."
        return CalibrationError(f"{self.place}: {column} = {shown!r} {what}")


@dataclass(frozen=True)
class Table:
    """A CSV file.

    Attributes
    ----------
    path : Path
        Where it lies, for messages.
    columns : tuple of str
    rows : tuple of Row
        Lines that begin with ``#`` are comments.
    source : str
        Its first line when that is a comment, which names the source; else the file's name.
    marks : mapping
        Column to its decimal mark.
    """

    path: Path
    columns: tuple[str, ...]
    rows: tuple[Row, ...]
    source: str
    marks: Mapping[str, Mark] = field(default_factory=dict)

    def column(self, name: str) -> str:
        """Return the column of that name, which may be given without its unit in brackets.

        Capitals count where two names differ in nothing else.

        Raises
        ------
        CalibrationError
            With the missing column and the nearest one that is there.
        """
        if name in self.columns:
            return name
        bare = [one for one in self.columns if bare_name(one) == name]
        plain = name.strip().casefold()
        alike = [
            one for one in self.columns if plain in (one.casefold(), bare_name(one).casefold())
        ]
        for found in (bare, alike):
            if len(found) == 1:
                return found[0]
        near = suggest(name, self.columns) or f"; it has {', '.join(self.columns)}"
        msg = f"{self.path}: no column '{name}'{near}"
        raise CalibrationError(msg)


def read_table(path: Path) -> Table:
    """Read a CSV file as spreadsheets and people write it.

    Columns are separated by commas, semicolons or tabs; decimals have a point, or a comma where
    that leaves no doubt.

    Raises
    ------
    CalibrationError
        When it cannot be read as CSV, with file and line.
    """
    return table_of(path, text_in(path, bytes_of(path, LARGEST_TABLE, "a CSV file")))


def table_of(path: Path, text: str) -> Table:
    """Return the table in the text of a CSV file, as `read_table`."""
    full, source = full_lines(path, text)
    if not full:
        msg = f"{path}: holds no table; begin with a line of column names such as particle,surface"
        raise CalibrationError(msg)
    separator = separator_of(full[0][1])
    head, *bodies = [(place, cells_of(place, line, separator)) for place, line in full]
    own = [cell.casefold() if cell.casefold() in _OWN_HEADS else cell for cell in head[1]]
    return table_from(path, (head[0], own), bodies, source)


def full_lines(path: Path, text: str) -> tuple[list[tuple[str, str]], str]:
    """Return the lines of a table that are neither empty nor comments, and what its source is.

    Parameters
    ----------
    path : Path
        Where the text stands; places of lines are told with it.
    text : str

    Returns
    -------
    lines : list of (str, str)
        Place and line.
    source : str
        The first line when that is a comment, else the file's name.
    """
    lines = text.splitlines()
    first = lines[0].strip() if lines else ""
    source = first.removeprefix("#").strip(" ,;\t") if first.startswith("#") else path.name
    full = [
        (f"{path}:{number}", line)
        for number, line in enumerate(lines, 1)
        if line.strip(" ,;\t") and not line.startswith("#")
    ]
    return full, source


def separator_of(head: str) -> str:
    """Return what separates the columns of a table with that head."""
    return next((one for one in _SEPARATORS if one in head), ",")


def table_from(
    path: Path, head: tuple[str, list[str]], bodies: Iterable[tuple[str, list[str]]], source: str
) -> Table:
    """Return the table of a head and of rows, each with its place.

    Raises
    ------
    CalibrationError
        When columns have no names of their own, or a row has other cells than the head.
    """
    rows_of_cells = list(bodies)
    # A spreadsheet's empty columns are in all rows; a decimal comma shifts the cells of one.
    fewest = min((len(cells) for _, cells in rows_of_cells), default=0)
    widest = max(len(head[1]), fewest if len(rows_of_cells) > 1 else len(head[1]) + 1)
    columns = _head(*head)
    paired = [(place, _paired(place, columns, cells, widest)) for place, cells in rows_of_cells]
    marks = marks_of({name: [cells[name] for _, cells in paired] for name in columns})
    rows = tuple(Row(place, cells, marks) for place, cells in paired)
    return Table(path, columns, rows, source, marks)


def cells_of(place: str, line: str, separator: str) -> list[str]:
    """Return the cells of a line, without spaces around them.

    Raises
    ------
    CalibrationError
        When it cannot be read as CSV.
    """
    try:
        cells = next(csv.reader([line], delimiter=separator, skipinitialspace=True))
    except csv.Error as err:
        msg = f"{place}: cannot be read as CSV ({err}); save the table again"
        raise CalibrationError(msg) from err
    return [cell.strip() for cell in cells]


def _head(place: str, cells: list[str]) -> tuple[str, ...]:
    while cells and not cells[-1]:  # a spreadsheet's empty columns
        cells.pop()
    for cell in cells:
        if cells.count(cell) > 1:
            what = f"column '{cell}' appears twice" if cell else "two columns have no name"
            msg = f"{place}: {what}; rename one"
            raise CalibrationError(msg)
    return tuple(cells)


def _paired(place: str, head: tuple[str, ...], cells: list[str], widest: int) -> dict[str, str]:
    count = len(cells)
    while len(head) < len(cells) <= widest and not cells[-1]:
        cells.pop()
    if len(cells) != len(head):
        msg = (
            f"{place}: {count} cells under {len(head)} column names; write decimals with a "
            "point, and names that hold a comma in quotes"
        )
        raise CalibrationError(msg)
    return dict(zip(head, cells, strict=True))
