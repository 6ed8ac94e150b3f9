"""Units that measured values may have, and what turns one into another.

A table of a dozen words, because nothing here multiplies or divides units: a library of units would
accept thousands of words that no table of a bench holds, and cost its import in every start.
"""

from __future__ import annotations

import math
import re
from typing import Final

from calibrate.errors import CalibrationError

__all__ = ["bare_name", "dimension", "factor", "stated_unit", "units_of"]

_UNITS: Final[dict[str, tuple[str, float]]] = {
    "deg": ("angle", 1.0),
    "rad": ("angle", 180.0 / math.pi),
    "s": ("time", 1.0),
    "ms": ("time", 1e-3),
    "min": ("time", 60.0),
    "h": ("time", 3600.0),
    "g": ("mass", 1.0),
    "mg": ("mass", 1e-3),
    "kg": ("mass", 1e3),
    "m": ("length", 1.0),
    "cm": ("length", 1e-2),
    "mm": ("length", 1e-3),
    "um": ("length", 1e-6),
    "-": ("number", 1.0),
    "%": ("number", 1e-2),
}
"""Unit to its dimension, and how many of the dimension's first unit it is."""


def factor(given: str, wanted: str) -> float:
    """Return by what a value in one unit is multiplied to be in another.

    Parameters
    ----------
    given, wanted : str
        Units; equal ones need not be known here.

    Raises
    ------
    CalibrationError
        When a unit is not known, or measures something else.

    Examples
    --------
    >>> factor("ms", "s"), factor("Pa", "Pa")
    (0.001, 1.0)
    """
    if given == wanted:
        return 1.0
    kind = dimension(wanted)
    same = [unit for unit, (what, _) in _UNITS.items() if what == kind] or [wanted]
    if given not in same:
        what = f"is a unit of {_UNITS[given][0]}" if given in _UNITS else "is not a known unit"
        msg = f"'{given}' {what}, but the simulated value is in {wanted}; give {' or '.join(same)}"
        raise CalibrationError(msg)
    return _UNITS[given][1] / _UNITS[wanted][1]


_BRACKETED: Final = re.compile(r"(.*\S)\s*(?:\[([^\[\]]+)\]|\(([^()]+)\))")
"""A name of a column with something in brackets behind it."""


def stated_unit(column: str) -> str | None:
    """Return the unit in the name of a column, in brackets or behind ``_``, or None.

    What stands in square brackets is a unit, whether it is known here or not.

    Examples
    --------
    >>> stated_unit("t100_ms"), stated_unit("Masse (g)"), stated_unit("t100 [s]")
    ('ms', 'g', 's')
    >>> stated_unit("m1_sem"), stated_unit("s"), stated_unit("mass (box 1)")
    (None, None, None)
    """
    found = _BRACKETED.fullmatch(column.strip())
    if found:
        word = (found[2] or found[3]).strip()
        return word if found[2] or word in _UNITS else None
    name, _, last = column.rpartition("_")
    return last if name and last in _UNITS else None


def bare_name(column: str) -> str:
    """Return the name of a column without a unit in brackets.

    Examples
    --------
    >>> bare_name("t100 [s]"), bare_name("t100_s")
    ('t100', 't100_s')
    """
    found = _BRACKETED.fullmatch(column.strip())
    return found[1] if found and stated_unit(column) else column


def dimension(unit: str) -> str:
    """Return what a unit measures, empty where it is not known.

    Examples
    --------
    >>> dimension("ms"), dimension("furlong")
    ('time', '')
    """
    return _UNITS[unit][0] if unit in _UNITS else ""


def units_of(kind: str) -> dict[str, float]:
    """Return the units of a dimension, and how many of its first unit each is.

    Examples
    --------
    >>> units_of("mass")
    {'g': 1.0, 'mg': 0.001, 'kg': 1000.0}
    """
    return {unit: size for unit, (what, size) in _UNITS.items() if what == kind}
