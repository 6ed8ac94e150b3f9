"""Read the tables that both engines write while they run: fix print, thermo, counted grains."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from liggghts_io.errors import CaseError, DamagedFile, nearest
from liggghts_io.measure.counts import text_of
from liggghts_io.measure.thermo import numbers_in, thermo_tables

FloatArray = npt.NDArray[np.float64]
THERMO: Final = "log.liggghts"
"""Name under which the thermo tables of a run are found."""

_SHOWN: Final = 60  # characters of a wrong line in a message
_VECTORS: Final = "Number-of-rows"  # in a title of `fix ave/time`
_COUNTED_HEAD: Final = "# ID "
_COUNTED: Final = ("time_s", "diameter_m", "x_m", "y_m", "z_m")
"""What a row of counted grains begins with, behind the id, where `writeTime` is asked for."""


def read_series(path: Path, density: float) -> dict[str, FloatArray]:
    """Return the columns of a table that an engine wrote.

    Parameters
    ----------
    path : Path
        A file of `fix print`, of `fix massflow/mesh ... writeTime`, or `log.liggghts`.
    density : float
        Of the grains [kg/m3], for the mass of counted ones.

    Returns
    -------
    dict of str to (n,) float64
        Columns of a printed table have the names of its title, if that has as many words, and
        their numbers, from "1"; those of the log the names of the thermo table; counted grains,
        in order of time, have `time_s`, `diameter_m`, `x_m`, `y_m`, `z_m`, and `mass_kg` and
        `number`, the sums up to each.

    Raises
    ------
    DamagedFile
        If the file is missing, cut short or no such table.
    """
    text = text_of(path)
    if text and not text.endswith("\n"):
        msg = f"{path}: cut short; run the case again"
        raise DamagedFile(msg)
    lines = text.splitlines()
    if path.name == THERMO:
        return _thermo(path, lines)
    if lines and lines[0].startswith(_COUNTED_HEAD):
        return _counted(path, [line for line in lines if line.strip()], density)
    return _printed(path, lines)


def column_of(series: dict[str, FloatArray], name: str, path: Path) -> FloatArray:
    """Return a column of a table.

    Raises
    ------
    CaseError
        For an unknown name, with the nearest known one.
    """
    if name not in series:
        msg = f"{path.name}: no column {name!r}{nearest(name, list(series))}"
        raise CaseError(msg)
    return series[name]


def _thermo(path: Path, lines: list[str]) -> dict[str, FloatArray]:
    """Return the thermo tables of all runs one after the other."""
    found = thermo_tables(lines)
    if found.strange:
        line, words = found.strange[0]
        msg = (
            f"{path}:{line}: {words[:_SHOWN]!r} is no row of the thermo table; run the case again, "
            "or let the script print elsewhere"
        )
        raise DamagedFile(msg)
    tables = [one for one in found.tables if one.rows]
    if len(tables) > 1:
        msg = f"{path}: the thermo tables have different columns; keep one thermo_style"
        raise CaseError(msg)
    rows = [(0, row) for one in tables for row in one.rows]
    return _named(path, rows, list(tables[0].names) if tables else [])


def _printed(path: Path, lines: list[str]) -> dict[str, FloatArray]:
    """Return a table with its titles, which stand above the rows, or begin with #."""
    titles: list[str] = []
    rows: list[tuple[int, list[float]]] = []
    for number, line in enumerate(lines, start=1):
        row = numbers_in(line.split())
        if row:
            rows.append((number, row))
        elif not rows or line.startswith("#") or line in titles or not line.strip():
            titles.append(line)  # once more where a run was continued
        else:
            msg = (
                f"{path}:{number}: {line[:_SHOWN]!r} is no row of numbers such as 1.5e-3; run the "
                "case again, or mend the script"
            )
            raise DamagedFile(msg)
    if any(_VECTORS in line for line in titles):
        msg = f"{path}: a table of 'mode vector' has many rows for each time; use 'mode scalar'"
        raise CaseError(msg)
    width = len(rows[0][1]) if rows else 0
    words = [line.lstrip("# ").split() for line in titles]
    title = next((one for one in reversed(words) if len(one) == width), [])
    numbered = [str(k + 1) for k in range(width)]
    series = _named(path, rows, numbered)
    named = dict(zip(title, numbered, strict=False))
    once = [name for name in named if title.count(name) == 1]
    return series | {name: series[named[name]] for name in once}


def _named(
    path: Path, rows: list[tuple[int, list[float]]], names: list[str]
) -> dict[str, FloatArray]:
    """Return rows, each behind the number of its line, as columns."""
    if not rows:
        msg = (
            f"{path}: holds no row of numbers such as 1.5e-3; run the case again, or mend the "
            "script"
        )
        raise DamagedFile(msg)
    for number, row in rows:
        if len(row) != len(names):
            msg = (
                f"{path}:{number}: {len(row)} numbers, where the first row has {len(names)}; run "
                "the case again, or mend the script"
            )
            raise DamagedFile(msg)
    table = np.array([row for _, row in rows], dtype=np.float64)
    return {name: table[:, k] for k, name in enumerate(names)}


def _counted(path: Path, lines: list[str], density: float) -> dict[str, FloatArray]:
    if "time" not in lines[0].split():
        msg = f"{path}: no times of the counted grains; add writeTime to its fix massflow/mesh"
        raise CaseError(msg)
    rows = []
    for line in lines[1:]:
        row = numbers_in(line.replace("[", " ").replace("]", " ").split())
        if row is None or len(row) <= len(_COUNTED) or not all(map(math.isfinite, row)):
            msg = f"{path}: {line[:80]!r} is no counted grain; run the case again"
            raise DamagedFile(msg)
        rows.append(row[1 : len(_COUNTED) + 1])
    table = np.array(sorted(rows), dtype=np.float64).reshape(-1, len(_COUNTED))
    series = {name: table[:, k] for k, name in enumerate(_COUNTED)}
    mass = density * math.pi / 6.0 * series["diameter_m"] ** 3
    return series | {
        "mass_kg": np.cumsum(mass),
        "number": np.arange(1.0, len(table) + 1.0),
    }
