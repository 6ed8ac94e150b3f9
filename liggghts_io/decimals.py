"""Numbers as people write them: with a decimal point or comma, never guessed."""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterable, Mapping
from typing import Final, Literal, TypeAlias

__all__ = ["Mark", "mark_of", "marks_of", "number_in"]

Mark: TypeAlias = Literal["", ".", ","]
"""Decimal mark that a table uses; empty where no cell tells."""

_POINT: Final = re.compile(r"[+-]?\d*\.\d*(?:[eE][+-]?\d+)?")
_COMMA: Final = re.compile(r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?")
_THOUSANDS: Final = re.compile(r"[+-]?[1-9]\d{0,2},\d{3}")
_POINT_THOUSANDS: Final = re.compile(r"[+-]?[1-9]\d{0,2}\.\d{3}")
"""What may as well be a whole number with a mark between thousands."""
_GROUPED: Final = re.compile(r"([+-]?[1-9]\d{0,2})((?:([.,])\d{3})(?:\3\d{3})*)([.,])(\d+)")


def mark_of(cells: Iterable[str]) -> Mark:
    """Return the decimal mark of numbers: the one of the first cell that leaves no doubt.

    Examples
    --------
    >>> mark_of(["Glass", "1,234", "38,28"]), mark_of(["5", "0.4"]), mark_of(["1,234"])
    (',', '.', '')
    """
    for cell in cells:
        if _POINT.fullmatch(cell):
            return "."
        if _COMMA.fullmatch(cell) and not _THOUSANDS.fullmatch(cell):
            return ","
    return ""


def marks_of(columns: Mapping[str, Collection[str]]) -> dict[str, Mark]:
    """Return the decimal mark of every column of a table.

    A column has that of its own numbers, since names of samples such as 1.1 stand beside numbers
    with a comma. Where its numbers leave a doubt, it has the one that all other columns share.

    Examples
    --------
    >>> marks_of({"ID": ["1.1", "1.2"], "angle": ["26,1", "26,5"]})
    {'ID': '.', 'angle': ','}
    >>> marks_of({"mass": ["1.234", "2.500"], "angle": ["26,1", "26,5"]})
    {'mass': ',', 'angle': ','}
    """
    own = {name: mark_of(cells) for name, cells in columns.items()}
    used = {mark for mark in own.values() if mark}
    for name, mark in own.items():
        if mark == "" and len(used) == 1:
            own[name] = next(iter(used))
        elif mark == "." and "," in used and not any(map(_surely_a_point, columns[name])):
            own[name] = ","
    return own


def _surely_a_point(cell: str) -> bool:
    return bool(_POINT.fullmatch(cell)) and not _POINT_THOUSANDS.fullmatch(cell)


def number_in(cell: str, mark: Mark) -> float | str:
    """Return the number in a cell, or why there is none.

    Parameters
    ----------
    cell : str
        Without spaces around it.
    mark : {"", ".", ","}
        Decimal mark of its column.

    Examples
    --------
    >>> number_in("38,28", ","), number_in("1,234", ","), number_in("1.234,5", ",")
    (38.28, 1.234, 1234.5)
    >>> number_in("1,234", "")
    'may be 1.234 or 1234; write decimals with a point and no mark between thousands'
    """
    if not cell:
        return "is empty, which is not a number; fill the cell or take the row out"
    grouped = _GROUPED.fullmatch(cell)
    if grouped and grouped[3] != grouped[4]:
        cell = (grouped[1] + grouped[2]).replace(grouped[3], "") + "." + grouped[5]
    elif _COMMA.fullmatch(cell):
        if mark == ".":
            return "has a decimal comma in a table with decimal points; write all with a point"
        if mark == "" and _THOUSANDS.fullmatch(cell):
            whole = cell.replace(",", "")
            return (
                f"may be {cell.replace(',', '.')} or {whole}; write decimals with a point and no "
                "mark between thousands"
            )
        cell = cell.replace(",", ".")
    elif mark == "," and _POINT.fullmatch(cell):
        return "has a decimal point in a table with decimal commas; write all with a point"
    try:
        value = float(cell) if "_" not in cell else math.nan
    except ValueError:
        value = math.nan
    return value if math.isfinite(value) else "is not a number; write decimals with a point"
