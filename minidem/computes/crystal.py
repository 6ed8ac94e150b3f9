"""``compute ID GROUP centro/atom``: how far the neighbours of a particle are from a crystal's."""

from __future__ import annotations

from typing import ClassVar, Final

import numpy as np

from minidem.computes.arrangement import reach_of_contacts
from minidem.contact.near import pairs_within
from minidem.errors import InputError
from minidem.kernels.columns import POSITION
from minidem.record import record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.compute import COMPUTES, Compute
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["CentralSymmetry"]

_LATTICES: Final = {"fcc": 12, "bcc": 8}
_MOST: Final = 100  # neighbours
_BATCH: Final = 1 << 12  # particles at once


@COMPUTES.register("centro/atom")
@record
class CentralSymmetry(Compute):
    """Sum of squared sums of the most opposite neighbours, m2.

    Zero where every neighbour has one on the other side, and for a particle with too few within
    the largest distance of contacts. Kelchner et al., Phys. Rev. B 58 (1998) 11085.

    Attributes
    ----------
    count : int
        Nearest neighbours that are looked at.
    """

    count: int = 12

    own_lists: ClassVar[bool] = True

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> CentralSymmetry:
        """Read a lattice or a number of neighbours."""
        del world
        words.need(1, f"compute ID GROUP {head.style} fcc|bcc|N")
        if words.peek() in _LATTICES:
            return cls(*head, _LATTICES[words.take("a lattice")])
        count = words.interval()
        if count % 2 or count > _MOST:
            msg = f"compute centro/atom: {count} neighbours; an even number up to {_MOST} is needed"
            raise InputError(msg)
        return cls(*head, count)

    def per_atom(self, world: World, index: int) -> Floats:
        """Return the sums; 0 for particles that are not in the group."""
        if index:
            return super().per_atom(world, index)
        state, box = world.state, world.need_box()
        found = np.zeros(state.n)
        reach = reach_of_contacts(world)
        if reach <= 0.0:
            return found
        points = state.row[: state.n, POSITION]
        one, other = pairs_within(points, reach, box)
        apart, period = points[other] - points[one], np.asarray(box.period())
        apart -= period * np.rint(apart / np.where(period > 0.0, period, 1.0))
        order = np.lexsort(((apart * apart).sum(axis=1), one))
        first = np.searchsorted(one[order], np.arange(state.n + 1))
        whole = world.member(self.bit) & (np.diff(first) >= self.count)
        for who in np.array_split(np.flatnonzero(whole), 1 + int(whole.sum()) // _BATCH):
            near = apart[order[first[who, None] + np.arange(self.count)]]
            found[who] = self._sums(near)
        return found

    def _sums(self, near: Floats) -> Floats:
        """Return the sum for each particle of vectors to its neighbours, shape (n, count, 3)."""
        j, k = np.triu_indices(self.count, 1)
        both = near[:, j] + near[:, k]
        squares = np.sort((both * both).sum(axis=2), axis=1)
        found: Floats = np.take(squares, range(self.count // 2), axis=1).sum(axis=1)
        return found
