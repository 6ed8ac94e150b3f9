"""Gravity: from the words of ``fix gravity`` to an acceleration."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import cos, isfinite, pi, sin, sqrt

import numpy as np

from minidem.world.state import Floats

__all__ = ["STYLES", "GravityField"]

STYLES = {"vector": 3, "chute": 1, "spherical": 2}
"""Way of giving the direction, and how many numbers it takes."""

DEGREE = pi / 180.0


@dataclass(frozen=True)
class GravityField:
    """Strength and direction, each a number or the name of an equal-style variable.

    Attributes
    ----------
    style : str
        One of `STYLES`: ``vector`` x y z; ``chute`` angle of a slope in degrees, downhill in x;
        ``spherical`` azimuth and angle from the z axis, degrees.
    values : tuple of float or str
        Strength, m/s2, and the numbers of the style.
    """

    style: str
    values: tuple[float | str, ...]

    @property
    def varies(self) -> bool:
        """Whether there is a variable in it."""
        return any(isinstance(value, str) for value in self.values)

    def acceleration(self, variable: Callable[[str], float]) -> Floats:
        """Return the acceleration now, shape (3,), m/s2.

        Parameters
        ----------
        variable : callable
            Gives the value of a variable by name.

        Raises
        ------
        ValueError
            If there is no direction, or a number is too large.
        """
        numbers = [variable(v) if isinstance(v, str) else v for v in self.values]
        way = self._direction(numbers[1:])
        found = np.array([numbers[0] * c for c in way])
        if not np.isfinite(found).all():
            shown = " ".join(f"{value:g}" for value in numbers)
            msg = f"gravity {self.style}: {shown} does not give a finite acceleration"
            raise ValueError(msg)
        return found

    def _direction(self, numbers: Sequence[float]) -> tuple[float, float, float]:
        """Return the unit vector; the order of operations is LIGGGHTS'."""
        if self.style == "vector":
            x, y, z = numbers
            length = sqrt(x * x + y * y + z * z)
            if length == 0.0 or not isfinite(length):
                msg = f"gravity: the vector {x:g} {y:g} {z:g} has no direction"
                raise ValueError(msg)
            return x / length, y / length, z / length
        phi, theta = (0.0, 180.0 - numbers[0]) if self.style == "chute" else numbers
        return (
            sin(DEGREE * theta) * cos(DEGREE * phi),
            sin(DEGREE * theta) * sin(DEGREE * phi),
            cos(DEGREE * theta),
        )
