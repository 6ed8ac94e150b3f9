"""``compute ID GROUP rdf``, ``cluster/atom`` and ``msd``: how particles lie and how they moved."""

from __future__ import annotations

from collections.abc import Mapping
from math import pi
from typing import ClassVar, Final

import numpy as np

from minidem.computes.neighbours import read_types
from minidem.contact.near import pairs_within
from minidem.errors import InputError
from minidem.kernels.columns import MASS, POSITION, RADIUS
from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.compute import COMPUTES, Compute
from minidem.world.fix import largest_inserted
from minidem.world.momentum import centre_of_mass
from minidem.world.state import Bools, Floats
from minidem.world.values.by_id import ById, places
from minidem.world.world import World

__all__ = ["Cluster", "Radial", "SquaredDisplacement", "reach_of_contacts"]

_MOST: Final = 100_000  # bins


def reach_of_contacts(world: World) -> float:
    """Return the largest distance of centres at which particles may touch, m."""
    radii = world.state.row[: world.state.n, RADIUS]
    largest = max(float(radii.max(initial=0.0)), largest_inserted(world))
    return 2.0 * largest * world.neighbor.reach


@COMPUTES.register("rdf")
@record
class Radial(Compute):
    """Radial distribution and coordination number up to the largest distance of contacts.

    Attributes
    ----------
    bins : int
        Number of bins.
    pairs : tuple
        Lowest and highest type of the one and of the other, for each pair of columns.
    first : tuple or None
        The largest distance, m, and the numbers of particles of each pair when the run began.
    """

    bins: int = 1
    pairs: tuple[tuple[tuple[int, int], tuple[int, int]], ...] = ()
    first: tuple[float, list[list[int]]] | None = None

    own_lists: ClassVar[bool] = True

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Radial:
        """Read the number of bins and pairs of types."""
        words.need(1, f"compute ID GROUP {head.style} BINS [TYPE TYPE ...]")
        bins = words.interval()
        if bins > _MOST:
            msg = f"compute rdf: at most {_MOST} bins are possible, found {bins}"
            raise InputError(msg)
        given = words.rest()
        if len(given) % 2:
            msg = f"compute rdf: types come in pairs, '{given[-1][:40]}' has no partner"
            raise InputError(msg)
        kinds = [read_types(word, world.types, head.style) for word in given or ["*", "*"]]
        return cls(*head, bins, tuple(zip(kinds[::2], kinds[1::2], strict=True)))

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return the middle of bin i ([i][1], m), or density or number ([i][2], [i][3], ...)."""
        if len(indices) != 2 or indices[0] > self.bins or indices[1] > 1 + 2 * len(self.pairs):
            return super().value(world, indices)
        row, column = indices
        at, found = row - 1, self.column(world, column)
        return 0.0 if found is None else float(found[at])

    def column(self, world: World, index: int) -> Floats | None:
        """Return the middles of the bins (1, m), or densities or numbers (2, 3, ...)."""
        if not 1 <= index <= 1 + 2 * len(self.pairs):
            return None
        reach, counts = self.first if self.first is not None else self._now(world)
        width = reach / self.bins
        if index == 1:
            return np.asarray(np.arange(self.bins) + 0.5, dtype=np.float64) * width
        at = index // 2 - 1
        density, number = self._table(world, width, self._sides(world, at), counts[at])
        return number if index % 2 else density

    def _sides(self, world: World, at: int) -> list[Bools]:
        """Return which particles are the one and the other of pair `at`, shape (n,) each."""
        member, kind = world.member(self.bit), world.state.kind[: world.state.n] + 1
        return [member & (kind >= low) & (kind <= high) for low, high in self.pairs[at]]

    def _now(self, world: World) -> tuple[float, list[list[int]]]:
        """Return the reach, m, and how many particles each pair has of the one and the other."""
        sides = [self._sides(world, at) for at in range(len(self.pairs))]
        return reach_of_contacts(world), [
            [int(np.count_nonzero(x)) for x in both] for both in sides
        ]

    def begin(self, world: World) -> None:
        """Note reach and particles; as in LIGGGHTS they count, whoever comes and goes."""
        self.first = self._now(world)

    def _table(
        self, world: World, width: float, sides: list[Bools], counts: list[int]
    ) -> tuple[Floats, Floats]:
        """Return density relative to the mean, and number of neighbours up to each bin."""
        state, box = world.state, world.need_box()
        nothing = np.zeros(self.bins)
        if width <= 0.0:
            return nothing, nothing
        points = state.row[: state.n, POSITION]
        one, other = pairs_within(points, width * self.bins, box)
        chosen = sides[0][one] & sides[1][other]
        apart = points[one[chosen]] - points[other[chosen]]
        period = np.asarray(box.period())
        apart -= period * np.rint(apart / np.where(period > 0.0, period, 1.0))
        place = (np.sqrt((apart**2).sum(axis=1)) * (1.0 / width)).astype(np.int64)
        hits = np.bincount(place[place < self.bins], minlength=self.bins)
        edge = width * np.arange(self.bins + 1)
        shell = 4.0 * pi / (3.0 * box.volume) * np.diff(edge**3)
        ideal = shell * counts[1]
        count = counts[0] * ideal
        density = np.where(count > 0.0, hits / np.where(count > 0.0, count, 1.0), 0.0)
        return density, np.cumsum(density * ideal)


@COMPUTES.register("cluster/atom")
@record
class Cluster(Compute):
    """Lowest id among the particles that are connected by steps shorter than a distance.

    Attributes
    ----------
    cutoff : float
        Distance of centres, m.
    """

    cutoff: float = 0.0

    own_lists: ClassVar[bool] = True

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Cluster:
        """Read the distance."""
        del world
        words.need(1, f"compute ID GROUP {head.style} CUTOFF")
        return cls(*head, words.positive())

    def per_atom(self, world: World, index: int) -> Floats:
        """Return the numbers; 0 for particles that are not in the group."""
        if index:
            return super().per_atom(world, index)
        reach = reach_of_contacts(world)
        if self.cutoff > reach:
            msg = (
                f"compute {self.name}: its cutoff {self.cutoff:g} is longer than {reach:g}, the "
                "largest distance of contacts"
            )
            raise InputError(msg)
        state, member = world.state, world.member(self.bit)
        ids = state.ids[: state.n]
        one, other = pairs_within(state.row[: state.n, POSITION], self.cutoff, world.need_box())
        joined = member[one] & member[other]
        one, other = one[joined], other[joined]
        order = np.argsort(ids)
        lowest = np.empty(state.n, np.int64)  # places in the order of ids
        lowest[order] = np.arange(state.n)
        while True:
            before = lowest.copy()
            np.minimum.at(lowest, one, before[other])
            lowest = np.minimum(lowest, lowest[order[lowest]])
            if np.array_equal(lowest, before):
                break
        return np.where(member, ids[order[lowest]], 0).astype(np.float64)


@COMPUTES.register("msd")
@record
class SquaredDisplacement(Compute):
    """Mean squared displacement since the compute was made, m2.

    Attributes
    ----------
    drifts : bool
        Whether the motion of the centre of mass is taken off.
    origin : ById
        Positions at that time, m.
    """

    drifts: bool = False
    origin: ById = field(default_factory=lambda: ById((np.nan,) * 3))

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> SquaredDisplacement:
        """Read ``com`` and note where the particles are."""
        made = cls(*head)
        while not words.done():
            words.expect("com")
            made.drifts = words.yes_no()
        member = world.member(made.bit)[:, None]
        made.origin.keep(world, places(world, made.bit) - member * made._centre(world))
        return made

    def _centre(self, world: World) -> Floats:
        """Return what positions are counted from, shape (3,), m."""
        member = world.member(self.bit)
        if not self.drifts or not member.any():
            return np.zeros(3)
        weight = world.state.row[: world.state.n][member][:, [MASS]]
        return centre_of_mass(weight, world.unwrapped()[member])

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return x, y, z or the sum (4); particles that came later have not moved."""
        if len(indices) != 1 or indices[0] > 4:
            return super().value(world, indices)
        member = world.member(self.bit)
        moved = (world.unwrapped() - self._centre(world) - self.origin.rows(world))[member]
        squares = np.nan_to_num(moved**2).sum(axis=0) / max(1, len(moved))
        return float(squares.sum() if indices[0] == 4 else squares[indices[0] - 1])

    def ids_changed(self, new: Mapping[int, int]) -> None:
        """Follow particles that have got new ids."""
        self.origin.ids_changed(new)
