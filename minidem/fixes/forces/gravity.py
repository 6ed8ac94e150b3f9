"""``fix ID GROUP gravity 9.81 vector 0 0 -1``: weight, of constant or varying direction."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import cos, isfinite, pi, sin, sqrt
from typing import ClassVar

import numpy as np

from minidem.errors import InputError
from minidem.fixes.forces.body import BodyForce
from minidem.kernels.columns import MASS, POSITION, POST_VECTOR, TOTAL_FORCE, three
from minidem.record import record
from minidem.registry import Head
from minidem.words import Words, number
from minidem.world.fix import FIXES
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["Gravity", "GravityField"]

STYLES = {"vector": 3, "chute": 1, "spherical": 2}
"""Way of giving the direction, and how many numbers it takes."""

DEGREE = pi / 180.0


@record(frozen=True)
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
        InputError
            If there is no direction, or a number is too large.
        """
        strength, *way = (variable(v) if isinstance(v, str) else v for v in self.values)
        found = np.array([strength * c for c in self._direction(way)])
        if not np.isfinite(found).all():
            shown = " ".join(f"{value:g}" for value in (strength, *way))
            msg = f"gravity {self.style}: {shown} does not give a finite acceleration"
            raise InputError(msg)
        return found

    def _direction(self, way: Sequence[float]) -> tuple[float, float, float]:
        """Return the unit vector; the order of operations is LIGGGHTS'."""
        if self.style == "vector":
            x, y, z = way
            length = sqrt(x * x + y * y + z * z)
            if length == 0.0 or not isfinite(length):
                msg = f"gravity: the vector {x:g} {y:g} {z:g} has no direction"
                raise InputError(msg)
            return x / length, y / length, z / length
        if self.style == "chute":
            (slope,) = way
            phi, theta = 0.0, 180.0 - slope
        else:
            phi, theta = way
        return (
            sin(DEGREE * theta) * cos(DEGREE * phi),
            sin(DEGREE * theta) * sin(DEGREE * phi),
            cos(DEGREE * theta),
        )


@FIXES.register("gravity")
@record(kw_only=True)
class Gravity(BodyForce):
    """The weight of the particles.

    Attributes
    ----------
    pull : GravityField
        Strength and direction; ``POST_VECTOR`` of `numbers` is the acceleration, m/s2.
    """

    pull: GravityField

    kernel: ClassVar[str] = "gravity"
    indices: ClassVar[tuple[int, ...]] = (0,)
    energetic: ClassVar[bool] = True

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Gravity:
        """Read ``STRENGTH vector X Y Z``, ``chute ANGLE`` or ``spherical PHI THETA``."""
        words.need(3, "fix ID all gravity 9.81 vector 0 0 -1")
        strength = words.take("a strength")
        way = words.choice(tuple(STYLES), "style")
        count = STYLES[way]
        words.need(count, f"fix ID all gravity STRENGTH {way} " + "VALUE " * count)
        values = [strength, *(words.take("a value") for _ in range(count))]
        if not words.done():
            msg = f"gravity {way}: unexpected word '{words.peek()}'"
            raise InputError(msg)
        made = cls(*head, pull=GravityField(way, tuple(_value(word) for word in values)))
        if not made.pull.varies:
            made.numbers[three(POST_VECTOR)] = made.pull.acceleration(world.interpreter.value)
        return made

    def variables_asked(self) -> tuple[str, ...]:
        """Return the names of the variables that it asks in a run."""
        return tuple(one for one in self.pull.values if isinstance(one, str))

    def in_python(self) -> bool:
        """Return True if a script variable gives strength or direction."""
        return self.pull.varies

    def apply(self, world: World) -> None:
        """Add the weight of this step."""
        who, state = self.affected(world), world.state
        pull = self.pull.acceleration(world.interpreter.value)
        self.numbers[three(POST_VECTOR)] = pull
        state.force[who, TOTAL_FORCE] += state.row[who, MASS, None] * pull

    def potential(self, world: World) -> float:
        """Return the potential energy, J, from the origin of the coordinates."""
        row, pull = world.state.row[self.affected(world)], self.numbers[three(POST_VECTOR)]
        return float(-(row[:, MASS] * (row[:, POSITION] @ pull)).sum())


def _value(word: str) -> float | str:
    """Return a number, or the name of a variable ``v_NAME``."""
    return word[2:] if word.startswith("v_") else number(word, "gravity")
