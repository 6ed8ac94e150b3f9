"""``compute ID GROUP contact/atom`` and ``coord/atom``: how many others are near a particle."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from minidem.contact.actions import neighbours
from minidem.contact.near import pairs_within
from minidem.errors import InputError
from minidem.kernels.columns import PARTICLE, POSITION, RADIUS, TOUCHED
from minidem.record import record
from minidem.registry import Head
from minidem.words import Words, integer
from minidem.world.compute import COMPUTES, Compute
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["ContactCount", "Coordination", "read_types"]


@COMPUTES.register("contact/atom", "contact/atom/gran")
@record
class ContactCount(Compute):
    """Number of contacts with other particles; ``gran`` counts those that have just ended too.

    Attributes
    ----------
    skin : float
        Distance of surfaces up to which particles count, m.
    """

    skin: float = 0.0

    own_lists: ClassVar[bool] = True

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> ContactCount:
        """Read the distance."""
        del world
        made = cls(*head)
        if not words.done():
            words.expect("skin")
            made.skin = words.number()
        return made

    def per_atom(self, world: World, index: int) -> Floats:
        """Return the numbers; a pair counts for both if the one LIGGGHTS lists first is in."""
        if index:
            return super().per_atom(world, index)
        n = world.state.n
        who, arm, across = neighbours(world)
        radius = world.state.row[:, RADIUS]
        reach = radius[who[:, PARTICLE]] + radius[who[:, TOUCHED]] + self.skin
        near = (arm * arm).sum(axis=1) <= reach * reach
        if self.style == "contact/atom/gran":  # pairs that touched keep what they remember
            near |= world.lists.pairs.touch[: len(near)] != 0
        member = world.member(self.bit)
        # through a periodic face the partners are listed each with an image of the other
        first = near & member[who[:, PARTICLE]]
        second = near & np.where(across, member[who[:, TOUCHED]], member[who[:, PARTICLE]])
        found = np.bincount(who[first, PARTICLE], minlength=n) + np.bincount(
            who[second, TOUCHED], minlength=n
        )
        return found.astype(np.float64)


@COMPUTES.register("coord/atom")
@record
class Coordination(Compute):
    """Number of particles whose centres are near.

    Attributes
    ----------
    cutoff : float
        Distance of centres, m.
    kinds : tuple of (int, int)
        Lowest and highest type that count, of each column.
    mix : bool
        Only particles of other types count.
    """

    cutoff: float
    kinds: tuple[tuple[int, int], ...]
    mix: bool = False

    own_lists: ClassVar[bool] = True

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Coordination:
        """Read the distance and the types."""
        words.need(1, f"compute ID GROUP {head.style} CUTOFF")
        made = cls(*head, words.positive(), ((1, world.types),))
        if words.peek() == "mix":
            words.take("mix")
            made.mix = words.yes_no()
        elif not words.done():
            made.kinds = tuple(read_types(word, world.types, head.style) for word in words.rest())
        return made

    def per_atom(self, world: World, index: int) -> Floats:
        """Return the numbers of a column, from 1; 0 if there is only one."""
        if index > len(self.kinds) or (not index and len(self.kinds) > 1):
            return super().per_atom(world, index)
        state = world.state
        one, other = pairs_within(state.row[: state.n, POSITION], self.cutoff, world.need_box())
        low, high = self.kinds[max(index, 1) - 1]
        kind = state.kind[: state.n] + 1
        counts = (kind[other] >= low) & (kind[other] <= high)
        if self.mix:
            counts &= kind[one] != kind[other]
        found = np.bincount(one[counts], minlength=state.n) * world.member(self.bit)
        return found.astype(np.float64)


def read_types(word: str, most: int, what: str) -> tuple[int, int]:
    """Read ``2``, ``*``, ``2*``, ``*3`` or ``2*3``.

    Raises
    ------
    InputError
        If it is no range of types from 1 to `most`; `what` is the style for the message.
    """
    low, star, high = word.partition("*")
    first = integer(low, what) if low else 1
    last = (integer(high, what) if high else most) if star else first
    if not 1 <= first <= last <= most:
        msg = f"{what}: '{word[:40]}' is no range of types between 1 and {most}"
        raise InputError(msg)
    return first, last
