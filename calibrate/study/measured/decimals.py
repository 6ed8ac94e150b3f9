"""Numbers as people write them: with a decimal point or comma, never guessed."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from typing import Final, Literal, TypeAlias

__all__ = ["Mark", "mark_of", "number_in"]

Mark: TypeAlias = Literal["", ".", ","]
"""Decimal mark that a table uses; empty where no cell tells."""

_POINT: Final = re.compile(r"[+-]?\d*\.\d*(?:[eE][+-]?\d+)?")
_COMMA: Final = re.compile(r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?")
_THOUSANDS: Final = re.compile(r"[+-]?[1-9]\d{0,2},\d{3}")
"""What may as well be a whole number with a mark between thousands."""
_GROUPED: Final = re.compile(r"([+-]?[1-9]\d{0,2})((?:([.,])\d{3})(?:\3\d{3})*)([.,])(\d+)")


def mark_of(cells: Iterable[str]) -> Mark:
    """Return the decimal mark of a table: the one of its first cell that leaves no doubt.

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


def number_in(cell: str, mark: Mark) -> float | str:
    """Return the number in a cell, or why there is none.

    Parameters
    ----------
    cell : str
        Without spaces around it.
    mark : {"", ".", ","}
        Decimal mark of its table.

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
