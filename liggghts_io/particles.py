"""Tables of particles: CSV files with one bulk solid in a row."""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from pydantic import ValidationError

from liggghts_io.bulk import Bulk
from liggghts_io.decimals import Mark, marks_of, number_in
from liggghts_io.errors import CaseError, nearest, told
from liggghts_io.files import table_text
from liggghts_io.materials import Particle

NAME_COLUMN: Final = "particle"
DESCRIPTIVE: Final = ("circularity", "source", "remark")
"""Columns of a table that are for readers only."""
_SIEVE: Final = "sieve"
_FIELDS: Final = tuple(name for name in Bulk.model_fields if name != "name")
_NUMBERS: Final = {*_FIELDS} - {_SIEVE, "quantiles_of", "sizes"}
"""Columns that hold a number."""
_SEPARATORS: Final = ("\t", ";", ",")
_UNITS: Final = ("_um", "_kg_m3", "_pa", "_g_s", "_g")
"""At the end of a column's name."""


def read_particles(path: Path) -> dict[str, Particle]:
    """Read a table of particles; see `read_bulks`."""
    return {name: bulk.particle for name, bulk in read_bulks(path).items()}


def read_bulks(path: Path) -> dict[str, Bulk]:
    """Read a table of bulk solids.

    Parameters
    ----------
    path : Path
        CSV file: comment lines begin with `#`, then a head with the column `particle` and those
        of `Bulk`. Semicolons or tabs may separate columns, and decimals may have a comma. An empty
        cell or a column left out is a value that was not given. A cell of `sieve` holds the classes
        as `diameter:mass` with spaces between.

    Returns
    -------
    dict of str to Bulk
        By name, in the order of the file.

    Raises
    ------
    CaseError
        With file, line, column, value and remedy.
    """
    rows = _rows(path)
    if not rows:
        msg = f"{path}: holds no table; begin with a head such as {NAME_COLUMN},d32_um,..."
        raise CaseError(msg)
    head = _head(path, rows[0][1])
    bodies = [(place, _whole(place, head, cells)) for place, cells in rows[1:]]
    marks = marks_of(
        {name: [cells[k] for _, cells in bodies] for k, name in enumerate(head) if name in _NUMBERS}
    )
    found: dict[str, Bulk] = {}
    for place, cells in bodies:
        values = {
            column: _plain(place, column, cell, marks.get(column))
            for column, cell in zip(head, cells, strict=True)
        }
        bulk = _bulk(place, values)
        if bulk.name in found:
            msg = f"{place}: particle {bulk.name!r} stands in a row above; rename one"
            raise CaseError(msg)
        found[bulk.name] = bulk
    return found


def _rows(path: Path) -> list[tuple[str, list[str]]]:
    """Return the rows of a table that are neither empty nor comments, each with its place."""
    try:
        text = table_text(path.read_bytes())
    except (OSError, UnicodeDecodeError) as err:
        reason = getattr(err, "strerror", None) or "not a text in UTF-8"
        msg = f"{path}: cannot be read as a table of particles ({reason}); save it as CSV in UTF-8"
        raise CaseError(msg) from err
    lines = [
        (f"{path}:{number}", line)
        for number, line in enumerate(text.splitlines(), start=1)
        if line.strip(" ,;\t") and not line.startswith("#")
    ]
    separator = next((one for one in _SEPARATORS if lines and one in lines[0][1]), ",")
    return [(place, _cells(place, line, separator)) for place, line in lines]


def _whole(place: str, head: Sequence[str], cells: list[str]) -> list[str]:
    """Return the cells of a row, without the empty ones that a spreadsheet adds to it."""
    count = len(cells)
    while len(cells) > len(head) and not cells[-1]:
        cells = cells[:-1]
    if len(cells) != len(head):
        msg = (
            f"{place}: {count} cells under a head of {len(head)} columns; write decimals with "
            "a point, and names that hold a comma in quotes"
        )
        raise CaseError(msg)
    return cells


def _plain(place: str, column: str, cell: str, mark: Mark | None) -> str:
    """Return a cell with a decimal point; None for a mark says that it holds words."""
    if column == _SIEVE:
        return cell.replace(",", ".")
    if mark is None or not {",", "."} & {*cell}:
        return cell
    number = number_in(cell, mark)
    if isinstance(number, float):
        return repr(number)
    if cell.replace(",", "").replace(".", "").isdecimal():  # else it is told what is wrong there
        msg = f"{place}: {column} = {cell!r} {number}"
        raise CaseError(msg)
    return cell


def _cells(place: str, line: str, separator: str) -> list[str]:
    read = csv.reader([line], delimiter=separator, skipinitialspace=separator != "\t")
    try:
        return [cell.strip() for cell in next(read)]
    except csv.Error as err:
        msg = f"{place}: cannot be read as CSV ({err}); save the table again"
        raise CaseError(msg) from err


def _head(path: Path, columns: list[str]) -> list[str]:
    while columns and not columns[-1]:  # a spreadsheet's empty columns
        columns = columns[:-1]
    known = [NAME_COLUMN, *_FIELDS, *DESCRIPTIVE]
    columns = [_known_name(column, known) for column in columns]
    if NAME_COLUMN not in columns:
        alone = " (are its columns separated by commas?)" if len(columns) == 1 else ""
        msg = f"{path}: no column {NAME_COLUMN!r} in the head {','.join(columns)!r}{alone}"
        raise CaseError(msg)
    for column in columns:
        if column not in known:
            msg = f"{path}: unknown column {column!r}{nearest(column, known)}"
            raise CaseError(msg)
        if columns.count(column) > 1:
            msg = f"{path}: column {column!r} appears twice; remove one"
            raise CaseError(msg)
    return columns


def _known_name(column: str, known: Sequence[str]) -> str:
    """Return the name of a column that is written with capitals, or its unit in brackets."""
    plain = re.sub(r"\s*[\[(](.+)[\])]$", r"_\1", column.casefold())
    plain = plain.replace("/", "_").replace("µ", "u").replace("μ", "u").replace("³", "3")
    return plain if plain in known else column


def _bulk(place: str, cells: Mapping[str, str]) -> Bulk:
    values: dict[str, Any] = {column: cell for column, cell in cells.items() if cell}
    for column in DESCRIPTIVE:
        values.pop(column, None)
    if _SIEVE in values:
        values[_SIEVE] = [pair.split(":") for pair in values[_SIEVE].split()]
    name = values.pop(NAME_COLUMN, "")
    try:
        return Bulk(name=name, **values)
    except ValidationError as err:
        msg = f"{place}: particle {name!r}: {_reason(err)}"
        raise CaseError(msg) from err


def _reason(err: ValidationError) -> str:
    """Turn the first finding of pydantic into column, value and what is wrong."""
    found = err.errors(include_url=False)[0]
    message = told(found)
    if not found["loc"]:
        return message
    column = str(found["loc"][0])
    if found["type"] == "missing" and column != _SIEVE:
        return f"{column} is missing; add the column or fill the cell"
    if column == _SIEVE:
        return f"sieve: {found['input']!r}: {message}; write it as '1400:0.3 1600:0.7'"
    unit = " (the unit is in the column's name)" if column.endswith(_UNITS) else ""
    return f"{column} = {found['input']!r}: {message}{unit}"


def particle_named(name: str, table: Path, changes: Mapping[str, object] | None = None) -> Particle:
    """Return the particle of that name from a table.

    Parameters
    ----------
    name : str
    table : Path
    changes : mapping of str to object, optional
        Fields of `Bulk` that go before what the table says; those that are None do not.

    Raises
    ------
    CaseError
        For an unknown name, with the nearest known one, a table that cannot be read, or a change
        that the bulk does not allow.
    """
    bulk = bulk_named(name, table)
    changed = {key: value for key, value in (changes or {}).items() if value is not None}
    if not changed:
        return bulk.particle
    try:
        return Bulk.model_validate(bulk.model_dump(exclude_unset=True) | changed).particle
    except ValidationError as err:
        msg = f"particle {name!r}: {_reason(err)}"
        raise CaseError(msg) from err


def bulk_named(name: str, table: Path) -> Bulk:
    """Return the bulk of that name from a table.

    Raises
    ------
    CaseError
        For an unknown name, with the nearest known one, or a table that cannot be read.
    """
    bulks = read_bulks(table)
    if name not in bulks:
        msg = f"{table}: unknown particle {name!r}{nearest(name, list(bulks))}"
        raise CaseError(msg)
    return bulks[name]
