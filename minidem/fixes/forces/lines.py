"""``fix ID GROUP lineforce X Y Z`` and ``planeforce``: forces along a line, or in a plane, only."""

from __future__ import annotations

from math import inf, sqrt
from typing import ClassVar, Self

import numpy as np

from minidem.errors import InputError
from minidem.fixes.forces.body import BodyForce
from minidem.kernels.columns import FX, FY, FZ, TOTAL_FORCE
from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.fix import FIXES
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["LineForce", "PlaneForce"]


@FIXES.register("lineforce")
@record
class LineForce(BodyForce):
    """What is left of a force is its part along a line.

    Attributes
    ----------
    along : ndarray, shape (3,)
        Direction, of length one.
    """

    along: Floats = field(default_factory=lambda: np.zeros(3))

    sets: ClassVar[bool] = True

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Self:
        """Read the direction."""
        del world
        words.need(3, f"fix ID GROUP {head.style} X Y Z")
        x, y, z = words.numbers(3)
        size = sqrt(x * x + y * y + z * z)
        if not 0.0 < size < inf:
            msg = f"fix {head.style}: {x:g} {y:g} {z:g} has no direction"
            raise InputError(msg)
        return cls(*head, along=np.array([x, y, z]) / size)

    def apply(self, world: World) -> None:
        """Change the forces."""
        who, force = self.affected(world), world.state.force
        x, y, z = self.along
        part = force[who, FX] * x + force[who, FY] * y + force[who, FZ] * z
        force[who, TOTAL_FORCE] = self.left(force[who, TOTAL_FORCE], part[:, None] * self.along)

    def left(self, force: Floats, along: Floats) -> Floats:
        """Return what is left of forces, given their parts along the line."""
        del force
        return along


@FIXES.register("planeforce")
class PlaneForce(LineForce):
    """What is left of a force is its part across the line."""

    def left(self, force: Floats, along: Floats) -> Floats:
        """Return the rest."""
        return force - along
