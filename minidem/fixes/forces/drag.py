"""``fix ID GROUP drag X Y Z FMAG DELTA``: a constant force towards a point."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from minidem.fixes.forces.body import FORCE_BEFORE, BodyForce
from minidem.kernels.columns import POSITION, TOTAL_FORCE, X, Y, Z
from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.fix import FIXES
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["Drag"]


@FIXES.register("drag")
@record
class Drag(BodyForce):
    """A force towards a point, line or plane; ``f_ID[1]`` to ``f_ID[3]`` is its sum, N.

    Attributes
    ----------
    place, counts : ndarray, shape (3,)
        The point, m, and which of its components count.
    strength : float
        N.
    near : float
        Distance up to which it does not act, m.
    """

    place: Floats = field(default_factory=lambda: np.zeros(3))
    counts: Floats = field(default_factory=lambda: np.ones(3))
    strength: float = 0.0
    near: float = 0.0

    indices: ClassVar[tuple[int, ...]] = (1, 2, 3)

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Drag:
        """Read point, force and distance."""
        del world
        words.need(5, "fix ID GROUP drag X Y Z FMAG DELTA")
        made = cls(*head)
        for d in range(3):
            if words.peek() == "NULL":
                words.take("NULL")
                made.counts[d] = 0.0
            else:
                made.place[d] = words.number()
        made.strength, made.near = words.number(), words.number()
        return made

    def apply(self, world: World) -> None:
        """Pull the particles."""
        who, state = self.affected(world), world.state
        span = (state.row[who, POSITION] - self.place) * self.counts
        period = world.need_box().period()
        far = np.abs(span) > 0.5 * np.where(period > 0.0, period, np.inf)
        span -= np.where(far, np.copysign(period, span), 0.0)
        x, y, z = span[:, X], span[:, Y], span[:, Z]
        length = np.sqrt(x * x + y * y + z * z)
        acts = length > self.near
        rate = np.where(acts, self.strength / np.where(acts, length, 1.0), 0.0)
        pull = rate[:, None] * span
        state.force[who, TOTAL_FORCE] -= pull
        self.before[FORCE_BEFORE] = 0.0 - pull.sum(axis=0)
