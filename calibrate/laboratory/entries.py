"""Measured numbers in a table that a study reads, one row for each target."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from calibrate.errors import CalibrationError
from calibrate.study.measured.files import bytes_of, encoding_of, text_in
from calibrate.study.measured.tables import (
    LARGEST_TABLE,
    REPEATS,
    TARGET,
    UNIT,
    Table,
    full_lines,
    separator_of,
    table_of,
)

__all__ = ["SE", "VALUE", "Entry", "check_folder", "extended"]

VALUE: Final = "value"
SE: Final = "se"
ORIGIN: Final = "from"
_COLUMNS: Final = (TARGET, "material", "surface", VALUE, SE, UNIT, REPEATS, ORIGIN)
_NEEDED: Final = (TARGET, VALUE, SE, UNIT)
_SOURCE: Final = "# Measured by us; a row for each target, written by 'bulkcal measured'."
_DIGITS: Final = 8
_DIGITS_OF_SE: Final = 4


@dataclass(frozen=True)
class Entry:
    """A measured number.

    Attributes
    ----------
    target : str
        Name of the target in a study.
    material, surface : str
        Where it was measured; empty where the study has one only.
    value, se : float
        Mean and standard error, in the unit.
    unit : str
    repeats : int
        Measurements behind the standard error; 0 where nobody says.
    origin : str
        Where it comes from, in words.
    """

    target: str
    material: str
    surface: str
    value: float
    se: float
    unit: str
    repeats: int
    origin: str


def check_folder(option: str, path: Path) -> None:
    """Refuse a path at which no file can be written.

    Parameters
    ----------
    option : str
        With which the file was named, for messages.
    path : Path

    Raises
    ------
    CalibrationError
    """
    try:
        folder, taken = path.parent, path.is_dir()
        there = folder.is_dir()
    except (OSError, ValueError) as err:
        msg = f"{option} {str(path)!r}: cannot be used ({err}); name another file"
        raise CalibrationError(msg) from err
    if taken or not path.name:
        msg = f"{option} {path}: is a directory; name a file in it"
        raise CalibrationError(msg)
    if not there:
        msg = f"{option} {path}: no directory {folder}; make it, or name another file"
        raise CalibrationError(msg)


def extended(path: Path, entry: Entry) -> bytes:
    """Return what a table of measured numbers holds with one more; the file stays as it is.

    What stands in it stays byte for byte; the new row has its separator, decimal mark, letters and
    ends of lines.

    Parameters
    ----------
    path : Path
        A table that was written here before, or a file that is not there yet.
    entry : Entry

    Raises
    ------
    CalibrationError
        When the file is another table, cannot be written, or has the target already.
    """
    if not path.exists():
        head = ",".join(_COLUMNS)
        return f"{_SOURCE}\n{head}\n{_row(entry, _COLUMNS, ',', '.')}\n".encode()
    raw = bytes_of(path, LARGEST_TABLE, "a table of measured numbers")
    text = text_in(path, raw)
    table = table_of(path, text)
    _check(path, table, entry)
    separator = separator_of(full_lines(path, text)[0][0][1])
    end = "\r\n" if "\r\n" in text else "\n"
    between = "" if text.endswith(("\n", "\r")) else end
    row = _row(entry, table.columns, separator, table.marks[VALUE] or ".")
    try:
        added = (between + row + end).encode(encoding_of(raw))
    except UnicodeEncodeError as err:
        letters = err.object[err.start : err.end]
        msg = f"{path}: its letters have no {letters!r}; save it as UTF-8, or name another --out"
        raise CalibrationError(msg) from err
    return raw + added


def _check(path: Path, table: Table, entry: Entry) -> None:
    """Refuse a table in which the entry cannot stand."""
    missing = [name for name in _NEEDED if name not in table.columns]
    if missing:
        msg = (
            f"{path}: has no column '{missing[0]}', so it was not written by 'bulkcal measured'; "
            "name another --out"
        )
        raise CalibrationError(msg)
    for row in table.rows:
        if row.cells[TARGET] == entry.target:
            cells = row.cells
            msg = (
                f"{row.place}: has '{entry.target}' already ({cells[VALUE]} ± {cells[SE]} "
                f"{cells[UNIT]}); take that line out if it is to be replaced, or choose another "
                "--name"
            )
            raise CalibrationError(msg)
    if not os.access(path, os.W_OK):
        msg = f"{path}: is not to be written; change its rights, or name another --out"
        raise CalibrationError(msg)


def _row(entry: Entry, columns: tuple[str, ...], separator: str, mark: str) -> str:
    """Return an entry as a line of a table."""
    cells: Mapping[str, str] = {
        TARGET: entry.target,
        "material": entry.material,
        "surface": entry.surface,
        VALUE: f"{entry.value:.{_DIGITS}g}".replace(".", mark),
        SE: f"{entry.se:.{_DIGITS_OF_SE}g}".replace(".", mark),
        UNIT: entry.unit,
        REPEATS: str(entry.repeats) if entry.repeats else "",
        ORIGIN: " ".join(entry.origin.split()),
    }
    line = io.StringIO()
    writer = csv.writer(line, delimiter=separator, lineterminator="")
    writer.writerow([cells.get(column, "") for column in columns])
    return line.getvalue()
