"""Neighbour lists of the engine: owns their memory and makes them anew."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from minidem.kernels.columns import (
    EVENT,
    FLOW,
    FLOW_VALUE,
    FORCE,
    NEAR,
    NEED_CELLS,
    NEED_FLOWS,
    NEED_PAIRS,
    NEED_WALLS,
    REMEMBERED,
    SLIDING_ONLY,
    WALL,
    WALL_VALUE,
)
from minidem.kernels.tables import Flows, Pairs, Walls
from minidem.record import field, record
from minidem.world.aligned import aligned_zeros
from minidem.world.state import Floats, Ints, State

__all__ = ["Lists", "Noted"]

_ROOM = 1.3  # spare room when memory is taken anew
_MORE = 256  # particles that may come until the pair list is made larger


class Noted(NamedTuple):
    """What particles in contact know of each other by ids, see `minidem.run.renumbered`.

    Attributes
    ----------
    owner, other : ndarray of int64, shape (m,)
        Ids of the one that knows, as it is now, and of the other one, as it was.
    touch : ndarray of uint8, shape (m,)
    hist : ndarray of float64, shape (m, w)
        As in `minidem.kernels.tables.Pairs`, seen from the owner.
    """

    owner: Ints
    other: Ints
    touch: NDArray[np.uint8]
    hist: Floats


@record
class Lists:
    """Pair list, wall list and flow list; pair and wall lists exist twice, in use and spare.

    Attributes
    ----------
    turned : int
        Which of the two sets is in use; a rebuild fills the other one and turns.
    before : int
        Particles that the lists in use were made for.
    builds : int
        Number of rebuilds.
    flows : Flows
        The flow list.
    all_pairs, all_walls : list of Pairs, list of Walls
        The two sets, see `minidem.kernels.tables`.
    noted : Noted or None
        What contacts remember where particles have got other ids since the lists were made.
    rank : ndarray of int64 or None, shape (before,)
        Places of their particles in the order of LIGGGHTS when they were made, where contacts
        depend on it.
    """

    turned: int = 0
    before: int = 0
    builds: int = 0
    flows: Flows = field(default_factory=lambda: _flows(0, 0, 0))
    all_pairs: list[Pairs] = field(default_factory=lambda: [_pairs(0, 0), _pairs(0, 0)])
    all_walls: list[Walls] = field(default_factory=lambda: [_walls(0, 0), _walls(0, 0)])

    noted: Noted | None = None
    rank: Ints | None = None

    @property
    def pairs(self) -> Pairs:
        """The pair list in use."""
        return self.all_pairs[self.turned]

    @property
    def walls(self) -> Walls:
        """The wall list in use."""
        return self.all_walls[self.turned]

    def set_tables(
        self, prim: Ints, value: Floats, mesh: Ints, curve: Floats, load: Floats
    ) -> None:
        """Take new tables of primitive walls and meshes; histories stay."""
        tables = {"prim": prim, "value": value, "mesh": mesh, "curve": curve, "load": load}
        self.all_walls = [walls._replace(**tables) for walls in self.all_walls]

    def renumber(self, triangles: Ints | None, primitives: Ints | None) -> None:
        """Follow walls that got new numbers (-1: gone) so that histories stay with them."""
        code = self.walls.code
        used = int(self.walls.start[self.before]) if self.before else 0
        old = code[:used].copy()
        gone = np.int32(-(2**30))
        if triangles is not None:
            at = old >= 0
            new = triangles[old[at]]
            code[:used][at] = np.where(new < 0, gone, new)
        if primitives is not None:
            at = (old < 0) & (old > gone)
            new = primitives[-1 - old[at]]
            code[:used][at] = np.where(new < 0, gone, -1 - new)

    def keep_pairs(self, stay: NDArray[np.bool_]) -> None:
        """Forget the pairs that do not stay; `stay` has an entry per pair in use."""
        n, pairs = self.before, self.pairs
        owner = np.repeat(np.arange(n), np.diff(pairs.start[: n + 1]))
        count = int(stay.sum())
        for table in (pairs.owner, pairs.other, pairs.touch, pairs.hist):
            table[:count] = table[: len(stay)][stay]
        pairs.start[1 : n + 1] = np.cumsum(np.bincount(owner[stay], minlength=n))

    def replace_pairs(
        self, owner: Ints, other: Ints, touch: NDArray[np.uint8], hist: Floats
    ) -> None:
        """Take other pairs in place of those in use, in the order of their owners."""
        count, n = len(owner), self.before
        if count > len(self.pairs.other):
            self.all_pairs[self.turned] = _pairs(len(self.pairs.start) - 2, count, hist.shape[1])
        pairs = self.pairs
        tables = (pairs.owner, pairs.other, pairs.touch, pairs.hist)
        for table, new in zip(tables, (owner, other, touch, hist), strict=True):
            table[:count] = new
        pairs.start[0] = 0
        pairs.start[1 : n + 1] = np.cumsum(np.bincount(owner, minlength=n))

    def begin(self, count: int) -> None:
        """Know of `count` particles that touch nothing, no more than the lists were made for."""
        for table in (self.pairs, self.walls):
            table.start[: count + 1] = 0
        self.before = count

    def keep_only(self, keep: NDArray[np.bool_]) -> None:
        """Forget the particles that are not kept, before the others move up."""
        n = self.before
        number = np.cumsum(keep) - 1
        pairs, walls = self.pairs, self.walls
        owner = np.repeat(np.arange(n), np.diff(pairs.start[: n + 1]))
        used = slice(0, int(pairs.start[n]))
        stay = keep[:n][owner] & keep[pairs.other[used]]
        count = int(stay.sum())
        for name in ("touch", "hist"):
            table = getattr(pairs, name)
            table[:count] = table[used][stay]
        pairs.owner[:count] = number[owner[stay]]
        pairs.other[:count] = number[pairs.other[used][stay]]
        new = np.bincount(number[owner[stay]], minlength=int(keep[:n].sum()))
        pairs.start[1 : len(new) + 1] = np.cumsum(new)
        owner = np.repeat(np.arange(n), np.diff(walls.start[: n + 1]))
        used = slice(0, int(walls.start[n]))
        stay = keep[:n][owner]
        count = int(stay.sum())
        for name in ("code", "touch", "hist"):
            table = getattr(walls, name)
            table[:count] = table[used][stay]
        new = np.bincount(number[owner[stay]], minlength=int(keep[:n].sum()))
        walls.start[1 : len(new) + 1] = np.cumsum(new)
        if self.rank is not None:
            self.rank = self.rank[keep[:n]]
        self.before = int(keep[:n].sum())

    def make_room(self, state: State, width: int) -> None:
        """Let the spare lists hold at least what the last rebuild needed, for all particles."""
        needs = state.more.needs
        spare = 1 - self.turned
        if self.pairs.hist.shape[1] != width:
            self.all_pairs[self.turned] = _pairs(state.cap, 256, width)
            self.before = 0
        pairs = self.all_pairs[spare]
        room = len(pairs.other)
        if room < 6 * max(state.n, 1):
            room = 6 * (state.n + _MORE)  # a new table at every insertion would cost time
        if needs[NEED_PAIRS] > room:
            room = int(_ROOM * needs[NEED_PAIRS])
        small = len(pairs.start) < state.cap + 2 or len(pairs.other) < room
        if small or pairs.hist.shape[1] != width:
            self.all_pairs[spare] = _pairs(state.cap, room, width)
        walls = self.all_walls[spare]
        room = max(len(walls.code), 256)
        if needs[NEED_WALLS] > room:
            room = int(_ROOM * needs[NEED_WALLS])
        if len(walls.start) < state.cap + 2 or len(walls.code) < room:
            self.all_walls[spare] = _walls(state.cap, room)._replace(**_tables(self.walls))
        if needs[NEED_CELLS] > len(state.more.first):
            first = np.zeros(int(2 * _ROOM * needs[NEED_CELLS]), np.int64)
            state.more = state.more._replace(first=first)
        self._make_flow_room(state, int(needs[NEED_FLOWS]))

    def _make_flow_room(self, state: State, needed: int) -> None:
        """As `make_room`, for flow counters."""
        flows = self.flows
        if flows.marker is not state.marker:
            flows = flows._replace(marker=state.marker)
        if needed > len(flows.pair):
            flows = flows._replace(pair=np.zeros((2 * needed, NEAR), np.int64))
        if len(flows.event) < 4 * len(flows.pair) + 64:
            event = np.zeros((4 * len(flows.pair) + 64, EVENT))
            event[: len(flows.event)] = flows.event
            flows = flows._replace(event=event)
        self.flows = flows

    def set_flows(self, state: State, spec: Ints, value: Floats) -> None:
        """Take new flow counters; markers of flows that stay are kept by the caller."""
        self.flows = _flows(len(spec), 64, 1024)._replace(
            spec=spec, value=value, marker=state.marker
        )


def _tables(walls: Walls) -> dict[str, Floats | Ints]:
    return {name: getattr(walls, name) for name in ("prim", "value", "mesh", "curve", "load")}


def _pairs(cap: int, room: int, width: int = SLIDING_ONLY) -> Pairs:
    return Pairs(
        np.zeros(cap + 2, np.int64),
        np.zeros(room, np.uint32),
        np.zeros(room, np.uint32),
        np.zeros(room, np.uint8),
        aligned_zeros((room, width)),
        np.zeros(room, np.uint32),
        np.zeros(cap + 2, np.int64),
    )


def _walls(cap: int, room: int) -> Walls:
    return Walls(
        start=np.zeros(cap + 2, np.int64),
        code=np.zeros(room, np.int32),
        touch=np.zeros(room, np.uint8),
        hist=np.zeros((room, REMEMBERED)),
        free=np.zeros(room),
        prim=np.zeros((0, WALL), np.int64),
        value=np.zeros((0, WALL_VALUE)),
        mesh=np.zeros((0, WALL), np.int64),
        curve=np.zeros(0),
        load=np.zeros((0, FORCE)),
    )


def _flows(flows: int, pairs: int, events: int) -> Flows:
    return Flows(
        pair=np.zeros((pairs, NEAR), np.int64),
        count=np.zeros(1, np.int64),
        marker=np.zeros((flows, 0), np.int8),
        spec=np.zeros((flows, FLOW), np.int64),
        value=np.zeros((flows, FLOW_VALUE)),
        event=np.zeros((events, EVENT)),
        found=np.zeros(1, np.int64),
    )
