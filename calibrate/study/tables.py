"""A CSV file of measured data: its rows with their lines, and the line that names its source."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from calibrate.errors import CalibrationError, suggest

__all__ = ["Row", "Table", "read_table", "text_of"]

LARGEST_TABLE: Final = 10_000_000
"""Bytes of a table; more are no means of measurements, and reading them would keep one waiting."""

REPEATS: Final = "repeats"
"""Column with the number of measurements behind a standard error."""

_LONGEST_SHOWN: Final = 60


@dataclass(frozen=True)
class Row:
    """A row of a CSV file.

    Attributes
    ----------
    place : str
        File and line, for messages.
    cells : mapping
        Column to what stands there, without spaces around it.
    """

    place: str
    cells: Mapping[str, str]

    def number(self, column: str) -> float:
        """Return a finite number.

        Raises
        ------
        CalibrationError
            With place, column and value.
        """
        text = self.cells[column]
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise self.wrong(column, "is not a number; write decimals with a point")
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
    """

    path: Path
    columns: tuple[str, ...]
    rows: tuple[Row, ...]
    source: str

    def need(self, columns: Iterable[str]) -> None:
        """Refuse a table that lacks a column.

        Raises
        ------
        CalibrationError
            With the missing column and the nearest one that is there.
        """
        for column in columns:
            if column not in self.columns:
                near = suggest(column, self.columns) or f"; it has {', '.join(self.columns)}"
                msg = f"{self.path}: no column '{column}'{near}"
                raise CalibrationError(msg)


def text_of(path: Path, largest: int, what: str) -> str:
    """Return the text of a file that a person wrote.

    Parameters
    ----------
    path : Path
    largest : int
        Most bytes that are read.
    what : str
        What it should be, for messages.

    Raises
    ------
    CalibrationError
        When it is no such file, too large, or no text in UTF-8; then with the line.
    """
    raw = bytes_of(path, largest, what)
    try:
        return raw.decode("utf-8-sig")  # spreadsheets put a byte order mark in front
    except UnicodeDecodeError as err:
        line = raw.count(b"\n", 0, err.start) + 1
        msg = (
            f"{path}:{line}: byte {raw[err.start]:#04x} is not UTF-8; save {what} as UTF-8 (a "
            "spreadsheet calls it 'CSV UTF-8')"
        )
        raise CalibrationError(msg) from err


def bytes_of(path: Path, largest: int, what: str) -> bytes:
    """Return the bytes of a regular file that is not too large.

    Raises
    ------
    CalibrationError
    """
    try:
        if path.exists() and not path.is_file():
            kind = "a directory" if path.is_dir() else "not a file"
            msg = f"{path}: cannot be read: it is {kind}; give the path of {what}"
            raise CalibrationError(msg)
        with path.open("rb") as file:
            raw = file.read(largest + 1)
    except (OSError, ValueError, RuntimeError) as err:  # ValueError: NUL; RuntimeError: link loop
        reason = getattr(err, "strerror", None) or err
        shown = str(path) if len(str(path)) <= 4 * _LONGEST_SHOWN else str(path)[:240] + "..."
        msg = f"{shown!r}" if "\0" in shown else shown
        msg += f": cannot be read ({reason}); give the path of {what}"
        raise CalibrationError(msg) from err
    if len(raw) > largest:
        msg = f"{path}: larger than {largest / 1e6:g} MB; that is not {what}"
        raise CalibrationError(msg)
    return raw


def read_table(path: Path) -> Table:
    """Read a CSV file.

    Raises
    ------
    CalibrationError
        When it cannot be read as CSV, with file and line.
    """
    text = text_of(path, LARGEST_TABLE, "a CSV file")
    lines = text.splitlines()
    first = lines[0].strip() if lines else ""
    source = first.removeprefix("#").strip() if first.startswith("#") else path.name
    head: tuple[str, ...] = ()
    rows = []
    for number, line in enumerate(lines, 1):
        if not line.strip() or line.startswith("#"):
            continue
        place = f"{path}:{number}"
        cells = _cells(place, line)
        if head:
            rows.append(Row(place, _paired(place, head, cells)))
        else:
            head = _head(place, cells)
    if not head:
        msg = f"{path}: holds no table; begin with a line of column names such as particle,surface"
        raise CalibrationError(msg)
    return Table(path, head, tuple(rows), source)


def _cells(place: str, line: str) -> list[str]:
    try:
        cells = next(csv.reader([line], skipinitialspace=True))
    except csv.Error as err:
        msg = f"{place}: cannot be read as CSV ({err}); save the table again"
        raise CalibrationError(msg) from err
    return [cell.strip() for cell in cells]


def _head(place: str, cells: list[str]) -> tuple[str, ...]:
    for mark, name in ((";", "semicolons"), ("\t", "tabs")):
        if len(cells) == 1 and mark in cells[0]:
            msg = f"{place}: columns are separated by {name}; separate them by commas"
            raise CalibrationError(msg)
    for cell in cells:
        if cell and cells.count(cell) > 1:
            msg = f"{place}: column '{cell}' appears twice; rename one"
            raise CalibrationError(msg)
    return tuple(cells)


def _paired(place: str, head: tuple[str, ...], cells: list[str]) -> dict[str, str]:
    if len(cells) != len(head):
        msg = (
            f"{place}: {len(cells)} cells under {len(head)} column names; write decimals with a "
            "point, and names that hold a comma in quotes"
        )
        raise CalibrationError(msg)
    return dict(zip(head, cells, strict=True))
