"""Read what a log of LIGGGHTS tells: thermo tables, time step, units."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import pandas as pd

from liggghts_io.errors import DamagedFile

_FIRST: Final = "Step"
_MULTI: Final = re.compile(r"-{5,} Step\s+(\d+) -{3,} CPU = ")
_PAIR: Final = re.compile(r"(\w+)\s*=\s*([-+.\w]+)")
_END: Final = "Loop"
_TIME_STEP: Final = re.compile(r"^timestep\s+([0-9.eE+-]+)\s*$", re.MULTILINE)
_UNITS: Final = re.compile(r"^units\s+(\w+)\s*$", re.MULTILINE)


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
    steps = {float(word) for word in _TIME_STEP.findall(whole) if _is_number(word)}
    units = _UNITS.findall(whole)
    thermo = _thermo(lines)
    return Log(
        name,
        thermo,
        steps.pop() if len(steps) == 1 else None,
        units[-1] if units else "",
        tuple(notes),
    )


def _thermo(lines: list[str]) -> pd.DataFrame:
    tables: list[tuple[list[str], list[list[float]]]] = []
    inside = False
    for line in _as_tables(lines):
        words = line.split()
        if len(words) > 1 and words[0] == _FIRST and len(set(words)) == len(words):
            if not tables or tables[-1][0] != words:
                tables.append((words, []))
            inside = True
        elif inside and words[:1] == [_END]:
            inside = False
        elif inside and len(words) == len(tables[-1][0]) and all(map(_is_number, words)):
            tables[-1][1].append([float(word) for word in words])
    found = [pd.DataFrame(rows, columns=names) for names, rows in tables if rows]
    return pd.concat(found, ignore_index=True) if found else pd.DataFrame()


def _as_tables(lines: list[str]) -> Iterator[str]:
    """Yield the lines of a log, numbers of `thermo_style multi` as tables of one row."""
    block: dict[str, str] = {}
    for line in (*lines, ""):
        begin = _MULTI.match(line)
        pairs = dict(_PAIR.findall(line)) if block and not begin else {}
        if pairs:
            block |= pairs
            continue
        if block:
            yield from (" ".join(block), " ".join(block.values()), _END)
            block = {}
        if begin:
            block = {_FIRST: begin[1]}
        else:
            yield line


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True
