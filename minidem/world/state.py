"""What the simulation knows about its particles and its box."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from minidem.kernels.columns import (
    BOX,
    CELLS,
    FLIGHT,
    FLIGHT_FROM,
    FLIGHT_STEPS,
    FLIGHT_STOP,
    FORCE,
    GONE,
    KEPT,
    LIQUID,
    MASS,
    NEEDS,
    OMEGA,
    POSITION,
    RADIUS,
    RANGE,
    ROW,
    SPIN,
    UNSEEN,
    VELOCITY,
    three,
)
from minidem.kernels.tables import More, Particles
from minidem.record import field, record
from minidem.world.aligned import aligned_zeros

__all__ = ["Bools", "Box", "Floats", "Ints", "NewRows", "State"]

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

_GROWTH = 1.5  # memory grows by half, so that copying stays cheap
_FREE = np.where(np.arange(FLIGHT) == FLIGHT_STOP, -1.0, 0.0)  # flight of one that is in none


@record
class Box:
    """The simulation box.

    Attributes
    ----------
    lo, hi : ndarray of float64, shape (3,)
        Corners, m.
    boundary : tuple of str
        Two letters per direction: p, f, s or m.
    least_lo, least_hi : ndarray of float64, shape (3,)
        Corners as created; ``m`` boundaries never shrink below them.
    """

    lo: Floats
    hi: Floats
    boundary: tuple[str, ...]
    least_lo: Floats
    least_hi: Floats

    @property
    def volume(self) -> float:
        """Volume of the box, m3."""
        return float(np.prod(self.hi - self.lo))

    def period(self) -> Floats:
        """Return the length of periodic directions, 0 of the others, shape (3,), m."""
        periodic = np.array([face[0] == "p" for face in self.boundary])
        return periodic * (self.hi - self.lo)


@record(frozen=True)
class NewRows:
    """Particles to be added, in the order of their ids.

    Attributes
    ----------
    position, velocity, omega : ndarray of float64, shape (m, 3)
        m, m/s and rad/s.
    radius, density, mass : ndarray of float64, shape (m,)
        m, kg/m3 and kg.
    kind : ndarray of int64, shape (m,)
        Atom types, from 1.
    mask : int
        Bits of their groups.
    flight : ndarray of float64, shape (m, columns), or None
        Rows of ``Particles.flight``; None if they are free at once.
    """

    position: Floats
    radius: Floats
    density: Floats
    mass: Floats
    kind: Ints
    velocity: Floats
    omega: Floats
    mask: int = 1
    flight: Floats | None = None


@record
class State:
    """Particles in the order the kernels like, which is not the order of ids.

    Attributes
    ----------
    n, cap : int
        Number of particles; length of the arrays, at least that.
    row, spin, force, held, flight, liquid, kind, mask : ndarray
        See `minidem.kernels.tables.Particles`.
    ids, rank : ndarray of int64, shape (cap,)
        Particle ids; places in the order in which LIGGGHTS would hold them (output order).
    density : ndarray of float64, shape (cap,)
        kg/m3.
    image : ndarray of int64, shape (cap, 3)
        Crossings of periodic boundaries.
    marker : ndarray of int8, shape (flows, cap)
        State of each particle at each flow counter.
    moisture : float
        Liquid content of particles that come.
    more : More
        Working memory of the kernels, which holds some of these arrays too.
    """

    n: int = 0
    cap: int = 0
    row: Floats = field(default_factory=lambda: np.zeros((0, ROW)))
    spin: Floats = field(default_factory=lambda: np.zeros((0, SPIN)))
    force: Floats = field(default_factory=lambda: np.zeros((0, FORCE)))
    held: Floats = field(default_factory=lambda: np.zeros((0, 3)))
    flight: Floats = field(default_factory=lambda: np.zeros((0, FLIGHT)))
    liquid: Floats = field(default_factory=lambda: np.zeros((0, LIQUID)))
    kind: NDArray[np.int32] = field(default_factory=lambda: np.zeros(0, np.int32))
    mask: NDArray[np.int32] = field(default_factory=lambda: np.zeros(0, np.int32))
    ids: Ints = field(default_factory=lambda: np.zeros(0, np.int64))
    rank: Ints = field(default_factory=lambda: np.zeros(0, np.int64))
    density: Floats = field(default_factory=lambda: np.zeros(0))
    image: Ints = field(default_factory=lambda: np.zeros((0, 3), np.int64))
    marker: NDArray[np.int8] = field(default_factory=lambda: np.zeros((0, 0), np.int8))
    moisture: float = 0.0

    more: More = field(default_factory=lambda: _more(0))
    _table: Particles | None = None

    _FLAT = ("kind", "mask", "ids", "rank", "density")
    _WIDE = ("row", "spin", "force", "held", "flight", "image", "liquid")

    @property
    def top_id(self) -> int:
        """Highest id there is; as in LIGGGHTS the next particle gets the one above it."""
        return int(self.ids[: self.n].max(initial=0))

    def reserve(self, wanted: int) -> None:
        """Make room for `wanted` particles."""
        if wanted <= self.cap:
            return
        cap = max(int(self.cap * _GROWTH), wanted, 64)
        for name in self._FLAT + self._WIDE:
            old = getattr(self, name)
            new = aligned_zeros((cap, *old.shape[1:]), old.dtype)
            new[: self.n] = old[: self.n]
            setattr(self, name, new)
        marker = np.full((len(self.marker), cap), UNSEEN, np.int8)
        marker[:, : self.n] = self.marker[:, : self.n]
        self.marker = marker
        self.cap = cap
        self.more = _more(cap)._replace(
            ids=self.ids, rank=self.rank, density=self.density, image=self.image,
            first=self.more.first, box=self.more.box, ranges=self.more.ranges,
        )  # fmt: skip

    def add(self, new: NewRows) -> None:
        """Append particles with the next free ids."""
        count = len(new.radius)
        if count == 0:
            return
        self.reserve(self.n + count)
        at = slice(self.n, self.n + count)
        self.row[at, POSITION] = new.position
        self.row[at, RADIUS] = new.radius
        self.row[at, VELOCITY] = new.velocity
        self.row[at, MASS] = new.mass
        self.spin[at] = 0.0
        self.spin[at, OMEGA] = new.omega
        self.force[at] = 0.0
        self.held[at] = new.position
        self.flight[at] = _FREE if new.flight is None else new.flight
        self.liquid[at] = self.moisture, 0.0, 0.0
        self.kind[at] = new.kind - 1
        self.mask[at] = new.mask
        numbers = np.arange(count)
        self.ids[at] = self.top_id + 1 + numbers
        self.rank[at] = self.n + numbers
        self.density[at] = new.density
        self.image[at] = 0
        self.marker[:, at] = UNSEEN
        self.n += count

    def take(self, order: Ints) -> None:
        """Keep the particles `order`, in that order."""
        count = len(order)
        for name in self._FLAT + self._WIDE:
            table = getattr(self, name)
            table[:count] = table[order]
        self.marker[:, :count] = self.marker[:, order]
        self.n = count

    def drop_ranks(self, gone: Sequence[int]) -> None:
        """Give up the output places of particles that leave one after the other.

        The last particle of the list fills each place.
        """
        place, count = self._places()
        for index in gone:
            count -= 1
            last, at = place[count], self.rank[index]
            place[at] = last
            self.rank[last] = at
            self.rank[index] = GONE

    def drop_in_passes(self, passes: Sequence[Bools]) -> None:
        """Give up the output places of particles that leave, as LIGGGHTS goes through its list.

        The last particle of the list fills a place, which then is looked at again.

        Parameters
        ----------
        passes : sequence of ndarray of bool, shape (n,)
            Which particles leave in each walk through the list.
        """
        place, count = self._places()
        for gone in passes:
            for at in np.flatnonzero(gone[place[:count]]):
                while at < count and gone[place[at]]:
                    self.rank[place[at]] = GONE
                    count -= 1
                    place[at] = place[count]
        self.rank[place[:count]] = np.arange(count)

    def _places(self) -> tuple[Ints, int]:
        """Return the particles in output order, places made 0, 1, 2 .., and how many have one."""
        place = self.output_order()
        count = int(np.count_nonzero(self.rank[: self.n] != GONE))
        self.rank[place[:count]] = np.arange(count)
        return place, count

    def flying(self) -> Bools:
        """Return which particles an insertion stream still holds, shape (n,)."""
        found: Bools = self.flight[: self.n, FLIGHT_STOP] >= 0.0
        return found

    def shift_flights(self, shift: int) -> None:
        """Move the steps of particles in flight; they start anew from where they are.

        As in LIGGGHTS their time of flight is not reset, so that they jump ahead.
        """
        flying = self.flying()
        flight = self.flight[: self.n]
        flight[flying, three(FLIGHT_FROM)] = self.row[: self.n][flying, POSITION]
        flight[flying, FLIGHT_STEPS] += shift

    def table(self) -> Particles:
        """Return the arrays as the kernels want them; the same tuple while memory suffices."""
        if self._table is None or self._table.row is not self.row:
            self._table = Particles(
                self.row, self.spin, self.force, self.kind, self.mask, self.held, self.flight,
                self.liquid, self.rank,
            )  # fmt: skip
        return self._table

    def output_order(self) -> Ints:
        """Return particle indices in the order in which LIGGGHTS would write them."""
        found: Ints = np.argsort(self.rank[: self.n], kind="stable")
        return found


def _more(cap: int) -> More:
    """Return working memory for `cap` particles."""
    return More(
        ids=np.zeros(cap, np.int64),
        rank=np.zeros(cap, np.int64),
        density=np.zeros(cap),
        image=np.zeros((cap, 3), np.int64),
        alive=np.ones(max(cap, 1), np.uint8),
        first=np.zeros(1024, np.int64),
        order=np.zeros(cap, np.int64),
        where=np.zeros(cap, np.int64),
        scratch=np.zeros((cap, max(ROW, FLIGHT))),
        whole=np.zeros((cap, KEPT), np.int64),
        cells=np.zeros(CELLS),
        box=np.zeros(BOX),
        ranges=np.zeros((0, RANGE), np.int64),
        needs=np.zeros(NEEDS, np.int64),
    )
