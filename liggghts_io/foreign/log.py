"""Read what a log of LIGGGHTS tells: thermo tables, time step, units."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import pandas as pd

from liggghts_io.errors import DamagedFile
from liggghts_io.measure.thermo import numbers_in, thermo_tables

_TIME_STEP: Final = re.compile(r"^\s*timestep\s+([0-9.eE+-]+)\s*(?:#.*)?$", re.MULTILINE)
_UNITS: Final = re.compile(r"^\s*units\s+(\w+)\s*(?:#.*)?$", re.MULTILINE)
_SHOWN: Final = 60  # characters of a line in a note


@dataclass(frozen=True)
class Log:
    """What a log tells.

    Attributes
    ----------
    name : str
    thermo : DataFrame
        Rows of the thermo tables of all runs, one after the other; a column that only some of
        them have is empty in the others.
    dt : float, optional
        The time step where the log has one and always the same, in its units of time.
    units : str
        Word behind `units`, empty where there is none.
    notes : tuple of str
        What was left out.
    """

    name: str
    thermo: pd.DataFrame
    dt: float | None
    units: str
    notes: tuple[str, ...] = ()


def read_log(path: Path, name: str) -> Log:
    """Read a log, also of a run that was stopped or is under way.

    Parameters
    ----------
    path : Path
    name : str
        For messages.

    Raises
    ------
    DamagedFile
        If it cannot be read.
    """
    try:
        text = path.read_bytes().decode("utf-8", errors="replace")
    except OSError as err:
        msg = f"{path}: cannot be read ({err.strerror})"
        raise DamagedFile(msg) from err
    whole, _, rest = text.rpartition("\n")
    lines = whole.splitlines()
    notes = [f"{name}:{len(lines) + 1}: the last line is cut and left out"] if rest.strip() else []
    steps = {step[0] for word in _TIME_STEP.findall(whole) if (step := numbers_in([word]))}
    if len(steps) > 1:
        notes.append(f"{name}: {len(steps)} time steps; times are not known without --timestep S")
    units = _UNITS.findall(whole)
    found = thermo_tables(lines)
    if found.strange:
        line, words = found.strange[0]
        notes.append(
            f"{name}:{line}: {words[:_SHOWN]!r} is no row of the thermo table; left out, as are "
            f"{len(found.strange) - 1} lines like it"
        )
    tables = [pd.DataFrame(one.rows, columns=list(one.names)) for one in found.tables if one.rows]
    return Log(
        name,
        pd.concat(tables, ignore_index=True) if tables else pd.DataFrame(),
        steps.pop() if len(steps) == 1 and min(steps) > 0.0 else None,
        units[-1] if units else "",
        tuple(notes),
    )
