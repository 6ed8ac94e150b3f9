"""``fix ID GROUP viscous GAMMA [scale TYPE RATIO ...]``: drag proportional to the velocity."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from minidem.errors import InputError
from minidem.fixes.forces.body import BodyForce
from minidem.kernels.columns import POST_VISCOUS, TOTAL_FORCE, VELOCITY
from minidem.record import record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.fix import FIXES
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["Viscous"]


@FIXES.register("viscous")
@record
class Viscous(BodyForce):
    """Drag; ``POST_VISCOUS`` of `numbers` is the coefficient of all types, N s/m.

    Attributes
    ----------
    per_type : ndarray or None
        Coefficient of each atom type, shape (types,), N s/m; None if they are the same.
    """

    per_type: Floats | None = None

    kernel: ClassVar[str] = "viscous"

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Viscous:
        """Read the coefficient and the ratios of atom types."""
        words.need(1, "fix ID GROUP viscous GAMMA [scale TYPE RATIO]")
        made = cls(*head)
        made.numbers[POST_VISCOUS] = gamma = words.number()
        while not words.done():
            words.choice(("scale",))
            words.need(2, "scale TYPE RATIO")
            kind = words.integer()
            if not 1 <= kind <= world.types:
                msg = f"viscous scale: type {kind} is not between 1 and {world.types}"
                raise InputError(msg)
            if made.per_type is None:
                made.per_type = np.full(world.types, gamma)
            made.per_type[kind - 1] = gamma * words.number()
        return made

    def in_python(self) -> bool:
        """Return True if types have coefficients of their own."""
        return self.per_type is not None

    def apply(self, world: World) -> None:
        """Brake the particles, each type with its coefficient."""
        if self.per_type is not None:
            who, state = self.affected(world), world.state
            drag = self.per_type[state.kind[: state.n]]
            state.force[who, TOTAL_FORCE] -= drag[who, None] * state.row[who, VELOCITY]
