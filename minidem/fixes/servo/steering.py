"""What a servo wants, and the velocity it gives its mesh, in LIGGGHTS' order of operations."""

from __future__ import annotations

from math import sqrt
from typing import Final

from minidem.errors import InputError
from minidem.kernels.columns import X, Y, Z
from minidem.words import Words, number
from minidem.world.state import Floats

__all__ = ["along", "automatic_velocity", "inverse", "limited", "target_of"]

Vector = tuple[float, float, float]

SMALL: Final = 0.9
LARGE: Final = 1.0
PART: Final = 0.1
"""Relative errors up to which the gain of ``mode auto`` is `PART` of the whole, and from which
on it is all of it."""


def along(axis: Floats, vector: Floats | Vector) -> float:
    """Return the component of a vector along an axis."""
    x, y, z = (float(a) for a in axis)
    return float(vector[X]) * x + float(vector[Y]) * y + float(vector[Z]) * z


def inverse(wanted: float) -> float:
    """Return the inverse of the size of what is wanted; 0 without anything, so that it rests."""
    return 1.0 / abs(wanted) if wanted else 0.0


def limited(axis: Floats, speed: float, most: float) -> tuple[Vector, bool]:
    """Return a velocity along an axis, of at most a size, and whether it had to be cut."""
    vx, vy, vz = (float(a) * speed for a in axis)
    size = sqrt(vx * vx + vy * vy + vz * vz)
    if size <= most:
        return (vx, vy, vz), False
    factor = most / size
    return (vx * factor, vy * factor, vz * factor), True


def automatic_velocity(
    axis: Floats, force: Floats, wanted: float, most: float, least: float | None
) -> Vector:
    """Return the velocity of ``mode auto``, whose gain follows the error.

    Parameters
    ----------
    axis : (3,) float64
    force : (3,) float64
        Force of the particles, N, or their torque, N m.
    wanted : float
        What it shall be along the axis; 0 if nothing.
    most : float
        Largest speed, m/s or rad/s, with no particle near.
    least : float or None
        That with particles near; None if there are none.

    Returns
    -------
    tuple of float
        m/s or rad/s.
    """
    error = (wanted - along(axis, force)) * inverse(wanted)
    if least is None:
        return limited(axis, -most * error, most)[0]
    size = abs(error)
    if size <= SMALL:
        gain = PART * least
    elif size >= LARGE:
        gain = least
    else:
        gain = PART * least + ((1 - PART) * least) * (size - SMALL) / (LARGE - SMALL)
    return limited(axis, -gain * error, least)[0]


def target_of(words: Words) -> float | str:
    """Return what is wanted on the mesh, against what the particles shall do, or a variable."""
    word = words.take("a force or v_NAME")
    if word.startswith("v_"):
        return word[2:]
    value = number(word, "target_val")
    if value == 0.0:
        msg = "'target_val' (desired force/torque) has to be != 0.0"
        raise InputError(msg)
    return -value
