"""Cells of an instrument's file: numbers with and without a unit behind them, and time stamps."""

from __future__ import annotations

import re
from typing import Final

__all__ = ["decimals_in", "is_reading", "is_stamp", "number_and_unit", "seconds_in"]

_READING: Final = re.compile(
    r"([+-]?)\s*((?:\d[\d.,]*|[.,]\d+)(?:[eE][+-]?\d+)?)\s*([A-Za-zµ%][\w/^²µ]*)?"
)
"""A number as balances print it: the sign may stand apart, a unit behind."""
_STAMP: Final = re.compile(
    r"(?:\d[\d./-]{7,9}[T ]\s*)?(\d{1,3}):(\d{2})(?::(\d{2}))?([.,]\d+)?\s*([AaPp][Mm])?"
    r"(?:Z|[+-]\d\d:?\d\d)?"
)
"""A time of day or on a stopwatch, with or without a date before it and a time zone behind."""
_MINUTE: Final = 60.0
_HOUR: Final = 3600.0
_NOON: Final = 12


def number_and_unit(cell: str) -> tuple[str, str] | None:
    """Return the number in a cell as it is written, and the unit behind it; None for other cells.

    Examples
    --------
    >>> number_and_unit("+   12,34 g"), number_and_unit("0.5"), number_and_unit("g")
    (('+12,34', 'g'), ('0.5', ''), None)
    """
    found = _READING.fullmatch(cell)
    return (found[1] + found[2], found[3] or "") if found else None


def is_stamp(cell: str) -> bool:
    """Return whether a cell is a time stamp."""
    return ":" in cell and _STAMP.fullmatch(cell) is not None


def is_reading(cell: str) -> bool:
    """Return whether a cell is a number or a time stamp."""
    return _READING.fullmatch(cell) is not None or is_stamp(cell)


def decimals_in(cell: str) -> int:
    """Return how many decimals a number or a time stamp is written with.

    Examples
    --------
    >>> decimals_in("12,340"), decimals_in("14:00:05.2 PM"), decimals_in("2026-05-01T14:00:05Z")
    (3, 1, 0)
    """
    if found := _STAMP.fullmatch(cell):
        return len(found[4] or ".") - 1
    tail = cell.replace(",", ".").rpartition(".")
    return len(tail[2]) if tail[1] and tail[2].isdigit() else 0


def seconds_in(cell: str, *, stopwatch: bool = False) -> float | str:
    """Return the time of a stamp in seconds, or why there is none.

    Parameters
    ----------
    cell : str
    stopwatch : bool
        Whether two numbers are minutes and seconds, as others of the same column show.

    Examples
    --------
    >>> seconds_in("12:03:04.5"), seconds_in("1:03,5"), seconds_in("2026-05-01 00:00:10")
    (43384.5, 63.5, 10.0)
    >>> seconds_in("12:03")
    'may be hours and minutes or minutes and seconds; write 0:12:03 or 12:03:00'
    """
    found = _STAMP.fullmatch(cell)
    if not found:
        return "is no time; write seconds, or stamps such as 12:03:04.5"
    first, second, third = int(found[1]), int(found[2]), found[3]
    part = float((found[4] or "0").replace(",", "."))
    if third is None and not (found[4] or stopwatch):
        return (
            f"may be hours and minutes or minutes and seconds; write 0:{found[1]}:{found[2]} or "
            f"{found[1]}:{found[2]}:00"
        )
    hours, minutes, seconds = (0, first, second) if third is None else (first, second, int(third))
    if second >= _MINUTE or seconds >= _MINUTE:
        return "is no time: minutes and seconds go to 59"
    if found[5]:
        hours = hours % _NOON + (_NOON if found[5].lower() == "pm" else 0)
    return hours * _HOUR + minutes * _MINUTE + seconds + part
