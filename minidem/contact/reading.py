"""How the values that contact models take are read, and their limits."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from minidem.errors import InputError
from minidem.world.materials import Materials
from minidem.world.state import Floats

__all__ = [
    "Read", "above_zero", "angle", "any_pair", "any_scalar", "of_first", "pair_above", "part",
    "restitution", "roll_factor", "scalar", "speed",
]  # fmt: skip

Read = Callable[[Materials, int, str, str], Floats]


def speed(materials: Materials, types: int, name: str, model: str) -> Floats:
    """Return a characteristic speed for all pairs of types, shape (types, types).

    Raises
    ------
    InputError
        If it is missing or not above zero.
    """
    return scalar(materials, types, name, model, " m/s")


def scalar(materials: Materials, types: int, name: str, model: str, unit: str = "") -> Floats:
    """Return a value that is above zero for all pairs of types."""
    value = float(materials.of(name, model).ravel()[0])
    if not value > 0.0:
        msg = f"{name} is {value:g}{unit}; it must be above zero"
        raise InputError(msg)
    return np.full((types, types), value)


def any_pair(materials: Materials, types: int, name: str, model: str) -> Floats:
    """Return values of any sign for all pairs of types."""
    return materials.per_pair(name, types, model)


def pair_above(least: float) -> Read:
    """Return how values of pairs of types are read that are above a number, or equal to it."""

    def read(materials: Materials, types: int, name: str, model: str) -> Floats:
        values = materials.per_pair(name, types, model)
        if (values < least).any() or (least == 0.0 and (values == 0.0).any()):
            limit = f"at least {least:g}" if least else "above zero"
            msg = f"{name} is {values.min():g}; it must be {limit} (as requested by {model})"
            raise InputError(msg)
        return values

    return read


above_zero = pair_above(0.0)


def restitution(materials: Materials, types: int, name: str, model: str) -> Floats:
    """Return values above 0 and at most 1 for all pairs of types."""
    values = above_zero(materials, types, name, model)
    if (values > 1.0).any():
        msg = f"{name} is {values.max():g}; 0 < {name} <= 1 required (as requested by {model})"
        raise InputError(msg)
    return values


def roll_factor(materials: Materials, types: int, name: str, model: str) -> Floats:
    """Return a value for all pairs of types that is above zero, in SI units at least 1."""
    values = scalar(materials, types, name, model)
    if materials.units == "si" and values.min(initial=1.0) < 1.0:
        msg = f"{name} is {values.min():g}; {name} >= 1 required for SI units"
        raise InputError(msg)
    return values


def any_scalar(materials: Materials, types: int, name: str, model: str) -> Floats:
    """Return a value of any sign for all pairs of types."""
    return np.full((types, types), float(materials.of(name, model).ravel()[0]))


def part(materials: Materials, types: int, name: str, model: str) -> Floats:
    """Return a value from 0 to 1 for all pairs of types."""
    values = any_scalar(materials, types, name, model)
    _within(values, name, 1.0)
    return values


def of_first(materials: Materials, types: int, name: str, model: str) -> Floats:
    """Return the value, from 0 to 1, of the first type of each pair."""
    values = materials.per_type(name, types, model)
    _within(values, name, 1.0)
    return np.repeat(values[:, None], types, axis=1)


def angle(materials: Materials, types: int, name: str, model: str) -> Floats:
    """Return half the product of the angles of both types, given in degrees, rad.

    LIGGGHTS 3.8.0 takes it in the place of the mean that its manual has.
    """
    values = materials.per_type(name, types, model)
    _within(values, name, 180.0)
    values = np.radians(values)
    found: Floats = 0.5 * (values[:, None] * values[None, :])
    return found


def _within(values: Floats, name: str, most: float) -> None:
    if not ((values >= 0.0) & (values <= most)).all():
        bad = values[~((values >= 0.0) & (values <= most))][0]
        msg = f"{name} is {bad:g}; it must be from 0 to {most:g}"
        raise InputError(msg)
