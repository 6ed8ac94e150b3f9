"""The table in an instrument's file: what separates its columns, where it begins, its head.

A balance writes lines about itself before the readings, sometimes no head, and sometimes a line
about the end. The table begins at the first line that looks as most lines do.
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final, TypeAlias

from calibrate.errors import CalibrationError
from calibrate.laboratory.instrument.cells import is_reading, is_stamp, number_and_unit
from calibrate.laboratory.instrument.quantities import TIME, is_named, is_unit
from calibrate.study.measured.files import bytes_of, text_in
from calibrate.study.measured.tables import Table, cells_of, full_lines, table_from
from calibrate.study.units import stated_unit

__all__ = ["Sheet", "read_sheet"]

LARGEST_LOG: Final = 50_000_000
"""Bytes: an hour of readings at a kilohertz."""
_PROBED: Final = 400
"""Lines that are looked at to find what separates columns."""
_LEAST_READINGS: Final = 2
"""In a row: a time and what was measured."""
_SPACES: Final = " "

Line: TypeAlias = tuple[str, list[str]]
"""Place and cells."""


@dataclass(frozen=True)
class Sheet:
    """The table of an instrument's file.

    Attributes
    ----------
    table : Table
        Its numbers stand without units.
    units : mapping
        Column to the unit that stands behind its numbers, where one does.
    """

    table: Table
    units: Mapping[str, str]


def read_sheet(path: Path) -> Sheet:
    """Read the table of an instrument's file.

    Raises
    ------
    CalibrationError
        When there is none, with what was looked for; or with file and line of what is wrong.
    """
    text = text_in(path, bytes_of(path, LARGEST_LOG, "a log as CSV"))
    full, source = full_lines(path, text)
    split = _splitter([line for _, line in full])
    lines = [(place, _trimmed(split(place, line))) for place, line in full]
    count, first = _beginning(path, lines)
    _refuse_split_decimals(full[first][1], lines, first)
    head = _head(lines, first, count)
    bodies = _bodies(lines[first:], lines[first - 1][1] if first else [], count)
    names = head[1]
    units: dict[str, set[str]] = {name: set() for name in names}
    plain = [(place, _without_units(cells, names, units)) for place, cells in bodies]
    for name, found in units.items():
        if len(found) > 1:
            msg = f"{path}: column '{name}' has several units, {', '.join(sorted(found))}; use one"
            raise CalibrationError(msg)
    said = {name: next(iter(found)) for name, found in units.items() if found}
    return Sheet(table_from(path, head, plain, source), said)


def _splitter(lines: Sequence[str]) -> Callable[[str, str], list[str]]:
    """Return what cuts lines into cells: the separator that leaves most cells readings."""

    def at(separator: str) -> Callable[[str, str], list[str]]:
        return _at_spaces if separator == _SPACES else lambda p, line: cells_of(p, line, separator)

    step = max(1, len(lines) // _PROBED)

    def share(separator: str) -> float:
        split = at(separator)
        sums: dict[int, float] = defaultdict(float)  # by the number of cells; a table has one
        for row in (_trimmed(split("", line)) for line in lines[::step]):
            if _readings(row) >= _LEAST_READINGS:
                sums[len(row)] += _readings(row) / len(row)
        return max(sums.values(), default=0.0)

    return at(max(("\t", ";", "|", ",", _SPACES), key=share))


def _at_spaces(_place: str, line: str) -> list[str]:
    """Return the cells of a line between spaces; signs and units belong to their numbers."""
    line = re.sub(r"(?<!\S)([+-])\s+(?=[\d.,])", r"\1", line)
    line = re.sub(r"(?<=\d)\s+(\S+)", lambda m: m[1] if is_unit(m[1]) else m[0], line)
    return re.sub(r"\s+(?=[\[(])", "", line).split()


def _trimmed(cells: list[str]) -> list[str]:
    while len(cells) > _LEAST_READINGS and not cells[-1]:
        cells.pop()
    return cells


def _readings(cells: Sequence[str]) -> int:
    return sum(is_reading(cell) for cell in cells)


def _beginning(path: Path, lines: Sequence[Line]) -> tuple[int, int]:
    """Return how many cells most rows have, and the first line of the table."""
    fits = [len(cells) if _readings(cells) >= _LEAST_READINGS else 0 for _, cells in lines]
    counts = Counter(count for count in fits if count)
    if not counts:
        msg = (
            f"{path}: holds no rows of time and a measured number; export the log as CSV, with "
            "a row per reading"
        )
        raise CalibrationError(msg)
    count = counts.most_common(1)[0][0]
    begins = (k for k in range(len(lines)) if fits[k] == count and _goes_on(lines, fits, k))
    return count, next(begins, fits.index(count))


def _goes_on(lines: Sequence[Line], fits: Sequence[int], k: int) -> bool:
    """Return whether a row is no line about the scale: another one follows, or a head precedes."""
    above = lines[k - 1][1] if k else []
    headed = len(above) == fits[k] and not _readings(above)
    return headed or fits[min(k + 1, len(fits) - 1)] == fits[k]


def _refuse_split_decimals(row: str, lines: Sequence[Line], first: int) -> None:
    """Refuse rows in which a comma is both the decimal mark and between the columns."""
    names = lines[first - 1][1] if first else []
    count = len(lines[first][1])
    named = any(stated_unit(name) or is_named(name, TIME) for name in names)
    if named and len(names) < count <= 2 * len(names) and row.count(",") >= count - 1:
        msg = (
            f"{lines[first][0]}: {count} cells under {len(names)} column names: commas stand in "
            "the numbers and between the columns; export the log with semicolons or tabs, or with "
            "decimal points"
        )
        raise CalibrationError(msg)


def _head(lines: Sequence[Line], first: int, count: int) -> Line:
    """Return the names of the columns; where there are none, they are numbered."""
    place, _ = lines[first]
    names = [""] * count
    if first and len(lines[first - 1][1]) == count and not _readings(lines[first - 1][1]):
        place, names = lines[first - 1]
        above = lines[first - 2][1] if first > 1 else []
        if all(is_unit(name) or not name for name in names) and len(above) == count:
            both = zip(above, names, strict=True)
            names = [f"{name} [{unit.strip('[]()')}]" if unit else name for name, unit in both]
    return place, [name or f"column {k}" for k, name in enumerate(names, 1)]


def _bodies(lines: Sequence[Line], head: Sequence[str], count: int) -> list[Line]:
    """Return the rows; without a head that stands again, and without words about the end."""
    last = max(k for k, (_, cells) in enumerate(lines) if _readings(cells) >= _LEAST_READINGS)
    return [
        (place, cells + [""] * (count - len(cells)))
        for place, cells in lines[: last + 1]
        if cells != head
    ]


def _without_units(
    cells: Sequence[str], names: Sequence[str], units: Mapping[str, set[str]]
) -> list[str]:
    """Return the cells of a row, their units taken off and noted by column."""
    plain = []
    for k, cell in enumerate(cells):
        found = None if is_stamp(cell) else number_and_unit(cell)
        if found and found[1] and k < len(names):
            units[names[k]].add(found[1])
        plain.append(found[0] if found else cell)
    return plain
