"""What instruments measure: the words and units by which a column is known."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from calibrate.study.units import bare_name, stated_unit, units_of

__all__ = [
    "ACCELERATION",
    "MASS",
    "POSITION",
    "TIME",
    "Quantity",
    "is_named",
    "is_unit",
    "unit_in_name",
]

_STANDARD_GRAVITY: Final = 9.80665
_GRAMS_PER_KG: Final = 1e3
_GRAMS_PER_POUND: Final = 453.59237
_OUNCES_PER_POUND: Final = 16.0
_UNIT_AFTER_SLASH: Final = re.compile(r".*?\S\s*/\s*(\S+)")


@dataclass(frozen=True)
class Quantity:
    """A measured quantity.

    Attributes
    ----------
    name : str
    words : frozenset of str
        By which people and instruments call its column, in small letters.
    units : mapping
        Unit to the number of base units in it.
    unit : str
        Base unit.
    column_option, unit_option : str
        Options of the command that name its column and unit, for messages.
    """

    name: str
    words: frozenset[str]
    units: Mapping[str, float]
    unit: str
    column_option: str
    unit_option: str


TIME: Final = Quantity(
    "time",
    frozenset({"t", "time", "times", "zeit", "temps", "tempo", "elapsed", "timestamp", "uhrzeit"}),
    units_of("time"), "s", "--time-column", "--time-unit",
)  # fmt: skip
MASS: Final = Quantity(
    "mass",
    frozenset({"m", "mass", "masse", "weight", "gewicht", "net", "netto", "load", "massa"}),
    {
        **units_of("mass"), "lb": _GRAMS_PER_POUND, "lbs": _GRAMS_PER_POUND,
        "oz": _GRAMS_PER_POUND / _OUNCES_PER_POUND,
    },
    "g", "--mass-column", "--mass-unit",
)  # fmt: skip
POSITION: Final = Quantity(
    "position",
    frozenset({"x", "position", "pos", "weg", "displacement", "stroke"}),
    units_of("length") | {"µm": 1e-6}, "m", "--column", "--unit",
)  # fmt: skip
ACCELERATION: Final = Quantity(
    "acceleration",
    frozenset({"a", "ax", "acc", "accel", "acceleration", "beschleunigung"}),
    {
        "m/s2": 1.0, "m/s^2": 1.0, "m/s²": 1.0, "mm/s2": 1e-3, "mm/s^2": 1e-3, "mm/s²": 1e-3,
        "g": _STANDARD_GRAVITY, "mg": _STANDARD_GRAVITY / _GRAMS_PER_KG,
    },
    "m/s2", "--column", "--unit",
)  # fmt: skip
_ALL: Final = (TIME, MASS, POSITION, ACCELERATION)


def is_unit(cell: str) -> bool:
    """Return whether a cell holds a unit alone, with or without brackets."""
    return any(cell.strip("[]() ") in one.units for one in _ALL)


def is_named(column: str, quantity: Quantity) -> bool:
    """Return whether the name of a column holds a word for a quantity.

    Examples
    --------
    >>> is_named("Netto (g)", MASS), is_named("t/s", TIME), is_named("status", MASS)
    (True, True, False)
    """
    name = _without_unit(column).lower()
    return bool(quantity.words & set(re.split(r"[^a-zäöüß]+", name)))


def unit_in_name(column: str, quantity: Quantity) -> str:
    """Return the unit of a quantity in the name of a column, empty if there is none.

    Examples
    --------
    >>> unit_in_name("m / g", MASS), unit_in_name("a_m_s2", ACCELERATION), unit_in_name("t", TIME)
    ('g', 'm/s2', '')
    """
    said = stated_unit(column)
    if said in quantity.units:
        return said or ""
    slash = _UNIT_AFTER_SLASH.fullmatch(column)
    if slash and slash[1] in quantity.units:
        return slash[1]
    tails = {f"_{unit.replace('/', '_')}": unit for unit in quantity.units}
    return next((unit for tail, unit in tails.items() if column.endswith(tail)), "")


def _without_unit(column: str) -> str:
    """Return the name of a column without the unit in brackets or behind a slash."""
    slash = _UNIT_AFTER_SLASH.fullmatch(column)
    if slash and any(slash[1] in one.units for one in _ALL):
        return column[: slash.start(1)].rstrip(" /")
    return bare_name(column)
