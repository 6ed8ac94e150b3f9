"""``compute ID GROUP property/atom COLUMN ...``: particle properties."""

from __future__ import annotations

from dataclasses import dataclass

from minidem.output.columns import atom_vector, check_columns
from minidem.registry import Head
from minidem.words import Words
from minidem.world.compute import COMPUTES, Compute
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["PropertyAtom"]


@COMPUTES.register("property/atom")
@dataclass
class PropertyAtom(Compute):
    """Particle properties, one column each.

    Attributes
    ----------
    names : tuple of str
        See `minidem.output.columns`.
    """

    names: tuple[str, ...]

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> PropertyAtom:
        """Read the columns."""
        del world
        words.need(1, f"compute ID GROUP {head.style} COLUMN ...")
        return cls(*head, check_columns(words.rest()))

    def per_atom(self, world: World, index: int) -> Floats:
        """Return a column, index from 1; 0 if there is only one."""
        if index > len(self.names):
            return super().per_atom(world, index)
        return atom_vector(world, self.names[max(index, 1) - 1]) * world.member(self.bit)
