"""``compute ID GROUP displace/atom``: how far particles are from where they were, m."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.compute import COMPUTES, Compute
from minidem.world.state import Floats
from minidem.world.values.by_id import ById, places
from minidem.world.world import World

__all__ = ["Displacement"]


@COMPUTES.register("displace/atom")
@record
class Displacement(Compute):
    """Displacement since the compute was made.

    Attributes
    ----------
    origin : ById
        Positions at that time, m, 0 for those that did not count.
    """

    origin: ById = field(default_factory=lambda: ById((np.nan,) * 3))

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Displacement:
        """Note where the particles are."""
        del words
        made = cls(*head)
        made.origin.keep(world, places(world, made.bit))
        return made

    def per_atom(self, world: World, index: int) -> Floats:
        """Return a component, from 1, or the distance (4); 0 for particles that came later."""
        if not 1 <= index <= 4:
            return super().per_atom(world, index)
        moved = world.unwrapped() - self.origin.rows(world)
        column = index - 1
        found = np.sqrt((moved * moved).sum(axis=1)) if index == 4 else moved[:, column]
        counts = world.member(self.bit) & ~np.isnan(found)
        return np.where(counts, found, 0.0)

    def ids_changed(self, new: Mapping[int, int]) -> None:
        """Follow particles that have got new ids."""
        self.origin.ids_changed(new)
