"""Find the thermo tables in the lines of a log of LIGGGHTS or LAMMPS."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Final

_STEP: Final = "Step"
_END: Final = ("Loop", "...")
"""First words of the line behind a table, plain or in YAML."""
_ABOVE: Final = ("Memory usage per processor", "Per MPI rank memory allocation")
"""What engines write above the names of the columns."""
_NEAR: Final = 5  # lines below the names, of which one is a row where nothing is written above them
_MULTI: Final = re.compile(r"-{5,} Step\s+(\d+) -{3,} CPU = ")
_PAIR: Final = re.compile(r"(\S+)\s*=\s*([-+.\w]+)")
_YAML_NAMES: Final = re.compile(r"keywords:\s*\[(.*)\]\s*$")
_YAML_ROW: Final = re.compile(r"\s*- \[(.*)\]\s*$")
_NUMBER: Final = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?|[-+]?(nan|inf)", re.IGNORECASE)


@dataclass
class Table:
    """Rows below one line of names.

    Attributes
    ----------
    names : tuple of str
    rows : list of list of float
    """

    names: tuple[str, ...]
    rows: list[list[float]] = field(default_factory=list)


@dataclass
class ThermoTables:
    """Thermo tables of all runs of a log.

    Attributes
    ----------
    tables : list of Table
        In the order of the log; tables of the same columns that follow each other are one.
    strange : list of (int, str)
        Number, from 1, and text of the lines between rows that begin with a number and are no
        rows: damaged ones, or what a script printed there.
    """

    tables: list[Table] = field(default_factory=list)
    strange: list[tuple[int, str]] = field(default_factory=list)


def numbers_in(words: Sequence[str]) -> list[float] | None:
    """Return words as numbers, None where one is none; nan and inf are numbers here."""
    if not all(map(_NUMBER.fullmatch, words)):
        return None
    return [float(word) for word in words]


def thermo_tables(lines: Sequence[str]) -> ThermoTables:
    """Return the thermo tables of a log: of style one, custom, multi, and as YAML."""
    found = ThermoTables()
    plain = list(_as_tables(lines))
    table, last = None, -1.0
    for k, (number, words) in enumerate(plain):
        below = [line for _, line in plain[k + 1 : k + 1 + _NEAR]]
        if _are_names(words, below, plain[k - 1][1] if k else []):
            table, last = _table_of(found, tuple(words)), -1.0
        elif table is None or not words:
            continue
        elif words[0] in _END:
            table = None
        elif (row := _row_of(table, words, last)) is not None:
            table.rows.append(row)
            last = row[table.names.index(_STEP)] if _STEP in table.names else last
        elif numbers_in(words[:1]):
            found.strange.append((number, " ".join(words)))
    return found


def _table_of(found: ThermoTables, names: tuple[str, ...]) -> Table:
    """Return the last table if it has these columns, else a new one."""
    if not found.tables or found.tables[-1].names != names:
        found.tables.append(Table(names))
    return found.tables[-1]


def _are_names(words: Sequence[str], below: Sequence[Sequence[str]], above: Sequence[str]) -> bool:
    """Whether words are the names of a table: different ones, none a number, in their place."""
    if len(set(words)) != len(words) or any(numbers_in([word]) for word in words):
        return False
    if " ".join(above).startswith(_ABOVE):
        return bool(words)
    rows = (line for line in below if len(line) == len(words))
    return _STEP in words and any(numbers_in(line) is not None for line in rows)


def _row_of(table: Table, words: Sequence[str], last: float) -> list[float] | None:
    """Return a row of a table; its step is a whole number above the last one of this run."""
    row = numbers_in(words)
    if row is None or len(row) != len(table.names):
        return None
    step = row[table.names.index(_STEP)] if _STEP in table.names else last + 1.0
    return row if step.is_integer() and step > last else None


def _as_tables(lines: Sequence[str]) -> Iterator[tuple[int, list[str]]]:
    """Yield number and words of each line, those of style multi and YAML as tables have them."""
    block: dict[str, str] = {}
    begun = 0
    for number, line in enumerate((*lines, ""), start=1):
        begin = _MULTI.match(line)
        pairs = dict(_PAIR.findall(line)) if block and not begin else {}
        if pairs and not line.startswith("WARNING"):
            block |= pairs
            continue
        if block:
            yield from ((begun, list(block)), (begun, list(block.values())), (begun, [_END[0]]))
            block = {}
        if begin:
            block, begun = {_STEP: begin[1]}, number
        elif names := _YAML_NAMES.match(line):
            yield number, [word.strip(" '\"") for word in names[1].split(",") if word.strip()]
        elif row := _YAML_ROW.match(line):
            yield number, [word.strip() for word in row[1].split(",") if word.strip()]
        else:
            yield number, line.split()
