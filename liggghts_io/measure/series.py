"""Read the tables that both engines write while they run: fix print, thermo, counted grains."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from liggghts_io.errors import CaseError, DamagedFile, nearest
from liggghts_io.measure.counts import text_of

FloatArray = npt.NDArray[np.float64]
THERMO: Final = "log.liggghts"
"""Name under which the thermo tables of a run are found."""

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
    lines = [line for line in text.splitlines() if line.strip()]
    if path.name == THERMO:
        return _thermo(path, lines)
    if lines and lines[0].startswith(_COUNTED_HEAD):
        return _counted(path, lines, density)
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


def _numbers(line: str) -> list[float] | None:
    try:
        return [float(word) for word in line.split()]
    except ValueError:
        return None


def _thermo(path: Path, lines: list[str]) -> dict[str, FloatArray]:
    """Return the thermo tables of all runs one after the other."""
    names: list[str] = []
    rows: list[list[float]] = []
    inside = False
    for line in lines:
        words = line.split()
        if words[0] == "Step" and len(words) > 1:
            if names and words != names:
                msg = f"{path}: the thermo tables have different columns; keep one thermo_style"
                raise CaseError(msg)
            names, inside = words, True
            continue
        row = _numbers(line)
        inside = inside and (row is None or len(row) == len(names)) and words[0] != "Loop"
        if inside and row is not None:
            rows.append(row)
    return _named(path, rows, names)


def _printed(path: Path, lines: list[str]) -> dict[str, FloatArray]:
    titles = [line.lstrip("# ").split() for line in lines if _numbers(line) is None]
    rows = [row for line in lines if (row := _numbers(line)) is not None]
    width = len(rows[0]) if rows else 0
    title = next((words for words in reversed(titles) if len(words) == width), [])
    numbered = [str(k + 1) for k in range(width)]
    series = _named(path, rows, numbered)
    return series | {name: series[number] for name, number in zip(title, numbered, strict=False)}


def _named(path: Path, rows: list[list[float]], names: list[str]) -> dict[str, FloatArray]:
    if not rows or any(len(row) != len(names) for row in rows):
        what = "holds no row of numbers" if not rows else "has rows of different lengths"
        msg = f"{path}: {what}; run the case again, or mend the script"
        raise DamagedFile(msg)
    table = np.array(rows, dtype=np.float64)
    return {name: table[:, k] for k, name in enumerate(names)}


def _counted(path: Path, lines: list[str], density: float) -> dict[str, FloatArray]:
    if "time" not in lines[0].split():
        msg = f"{path}: no times of the counted grains; add writeTime to its fix massflow/mesh"
        raise CaseError(msg)
    rows = []
    for line in lines[1:]:
        row = _numbers(line.replace("[", " ").replace("]", " "))
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
