"""``compute ID GROUP property/atom COLUMN ...``: particle properties."""

from __future__ import annotations

from minidem.errors import InputError
from minidem.output.columns import atom_vector, check_columns
from minidem.record import record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.compute import COMPUTES, Compute
from minidem.world.state import Floats
from minidem.world.world import World

_OTHERS = ("density", "xsu", "ysu", "zsu")  # columns of dumps only
_REFERENCES = ("c_", "f_", "v_")

__all__ = ["PropertyAtom"]


@COMPUTES.register("property/atom")
@record
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
        names = words.rest()
        for name in names:
            if name[:2] in _REFERENCES:
                msg = f"compute {head.style}: '{name[:40]}' is no property of particles"
                raise InputError(msg)
        return cls(*head, check_columns(names, without=_OTHERS, what="particle property"))

    def per_atom(self, world: World, index: int) -> Floats:
        """Return a column, index from 1; 0 if there is only one."""
        if index > len(self.names):
            return super().per_atom(world, index)
        return atom_vector(world, self.names[max(index, 1) - 1]) * world.member(self.bit)
