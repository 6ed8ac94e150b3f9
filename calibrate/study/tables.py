"""A CSV file of measured data: its rows, and the line that names its source."""

from __future__ import annotations

import io
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from calibrate.errors import CalibrationError, suggest

__all__ = ["Table", "read_table"]


@dataclass(frozen=True)
class Table:
    """A CSV file.

    Attributes
    ----------
    path : Path
        Where it lies, for messages.
    rows : DataFrame
        Its rows; lines that begin with ``#`` are comments.
    source : str
        Its first line when that is a comment, which names the source; else the file's name.
    """

    path: Path
    rows: pd.DataFrame
    source: str

    def need(self, columns: Iterable[str]) -> None:
        """Refuse a table that lacks a column.

        Raises
        ------
        CalibrationError
            With the missing column and the nearest one that is there.
        """
        known = [str(c) for c in self.rows.columns]
        for column in columns:
            if column not in known:
                near = suggest(column, known) or f"; it has {', '.join(known)}"
                msg = f"{self.path}: no column '{column}'{near}"
                raise CalibrationError(msg)


def read_table(path: Path) -> Table:
    """Read a CSV file.

    Raises
    ------
    CalibrationError
        When it cannot be read as CSV.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")  # spreadsheets put a byte order mark in front
        rows = pd.read_csv(io.StringIO(text), comment="#")
    except (ValueError, OSError) as err:
        msg = f"{path}: cannot be read as CSV: {err}"
        raise CalibrationError(msg) from err
    first = text.partition("\n")[0].strip()
    source = first.removeprefix("#").strip() if first.startswith("#") else path.name
    return Table(path, rows, source)
