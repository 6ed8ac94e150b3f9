"""Neighbour lists of the engine: owns their memory and makes them anew."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from minidem.kernels import neighbor as kernels
from minidem.kernels.tables import Flows, Mesh, Pairs, Walls
from minidem.state import Floats, Ints, State

__all__ = ["Lists", "RebuildPlan"]

_ROOM = 1.3  # spare room when memory is taken anew


@dataclass(frozen=True)
class RebuildPlan:
    """What a rebuild needs to know besides the particles.

    Attributes
    ----------
    skin : float
        m.
    reach : float
        ``contact_distance_factor``.
    period : ndarray, shape (6,)
        Lower corner and length of periodic directions.
    width : int
        Numbers of history per pair, 3 or 6.
    mesh : Mesh
        Triangles.
    flows : ndarray of int64, shape (flows, 3)
        Triangle range and 1 if moving, of each flow mesh.
    """

    skin: float
    reach: float
    period: Floats
    width: int
    mesh: Mesh
    flows: Ints


@dataclass
class Lists:
    """Pair list, wall list and flow list, each with the memory for its successor."""

    pairs: Pairs = field(default_factory=lambda: _pairs(0, 0, 3))
    walls: Walls = field(default_factory=lambda: _walls(0, 0))
    flows: Flows = field(default_factory=lambda: _flows(0, 0, 0))
    before: int = 0
    builds: int = 0
    _spare_pairs: Pairs = field(default_factory=lambda: _pairs(0, 0, 3))
    _spare_walls: Walls = field(default_factory=lambda: _walls(0, 0))
    _first: Ints = field(default_factory=lambda: np.zeros(0, np.int64))
    _order: Ints = field(default_factory=lambda: np.zeros(0, np.int64))
    _where: Ints = field(default_factory=lambda: np.zeros(0, np.int64))

    def set_tables(self, prim: Ints, value: Floats, mesh: Ints, curve: Floats) -> None:
        """Take new tables of primitive walls and meshes; histories stay."""
        load = np.zeros((len(mesh), 8))
        tables = {"prim": prim, "value": value, "mesh": mesh, "curve": curve, "load": load}
        self.walls = self.walls._replace(**tables)
        self._spare_walls = self._spare_walls._replace(**tables)

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

    def rebuild(self, state: State, alive: NDArray[np.uint8], plan: RebuildPlan) -> None:
        """Sort the particles and make all lists anew."""
        cells = self._sort(state, alive, plan)
        self._build_pairs(state, cells, plan)
        self._build_walls(state, cells, plan)
        if len(plan.flows):
            self._build_flows(state, cells, plan)
        state.held[: state.n] = state.row[: state.n, :3]
        self.before = state.n
        self.builds += 1

    def _sort(self, state: State, alive: NDArray[np.uint8], plan: RebuildPlan) -> Floats:
        """Put the particles in cell order."""
        n = state.n
        biggest = float(state.row[:n, 3].max()) if n else 0.0
        size = plan.reach * 2.0 * biggest + plan.skin
        cells: Floats = kernels.grid(n, state.row, max(size, 1e-12), 8 * n + 512, plan.period)
        total = int(cells[6] * cells[7] * cells[8])
        if len(self._first) < total + 1:
            self._first = np.zeros(int(_ROOM * total) + 1, np.int64)
        if len(self._order) < state.cap:
            self._order = np.zeros(state.cap, np.int64)
            self._where = np.zeros(state.cap, np.int64)
        count = kernels.sort_cells(
            n, state.row, alive, cells, self._first, self._order, self._where
        )
        state.reorder(self._order, count)
        return cells

    def _build_pairs(self, state: State, cells: Floats, plan: RebuildPlan) -> None:
        """Fill the spare pair list and swap."""
        fresh = self._spare_pairs
        room = len(fresh.other)
        while True:
            if len(fresh.start) < state.cap + 2 or fresh.hist.shape[1] != plan.width or not room:
                fresh = _pairs(state.cap, max(room, 8 * state.n + 64), plan.width)
            if self.pairs.hist.shape[1] != plan.width:
                self.pairs = _pairs(state.cap, 1, plan.width)
                self.before = 0
            needed = kernels.pair_list(
                state.n, state.table(), cells, self._first, self._order, self.before,
                self.pairs, fresh, plan.skin, plan.reach, plan.period,
            )  # fmt: skip
            if needed <= len(fresh.other):
                break
            room = int(_ROOM * needed) + 64
            fresh = _pairs(state.cap, room, plan.width)
        self.pairs, self._spare_pairs = fresh, self.pairs

    def _build_walls(self, state: State, cells: Floats, plan: RebuildPlan) -> None:
        """Fill the spare wall list and swap."""
        fresh = self._spare_walls
        while True:
            if len(fresh.start) < state.cap + 2:
                room = max(len(fresh.code), 64)
                fresh = _walls(state.cap, room)._replace(**_tables(self.walls))
            needed = kernels.wall_list(
                state.n, state.table(), cells, self._first, self._order, self.before,
                self.walls, fresh, plan.mesh, len(plan.mesh.node), plan.skin,
            )  # fmt: skip
            if needed <= len(fresh.code):
                break
            fresh = _walls(state.cap, int(_ROOM * needed) + 64)._replace(**_tables(self.walls))
        self.walls, self._spare_walls = fresh, self.walls

    def _build_flows(self, state: State, cells: Floats, plan: RebuildPlan) -> None:
        """Fill the flow list."""
        if len(self.flows.marker) and self.flows.marker is not state.marker:
            self.flows = self.flows._replace(marker=state.marker)
        while True:
            needed = kernels.wall_flow_list(
                state.n, state.table(), cells, self._first, plan.mesh, self.flows, plan.flows,
                plan.skin,
            )  # fmt: skip
            if needed <= len(self.flows.pair):
                break
            self.flows = self.flows._replace(pair=np.zeros((int(_ROOM * needed) + 64, 3), np.int64))
        rows = max(1024, 4 * needed)
        if len(self.flows.event) < rows:
            event = np.zeros((rows, 12))
            event[: len(self.flows.event)] = self.flows.event
            self.flows = self.flows._replace(event=event)

    def set_flows(self, state: State, spec: Ints, value: Floats) -> None:
        """Take new flow counters; markers of flows that stay are kept by the caller."""
        self.flows = _flows(len(spec), 64, 1024)._replace(
            spec=spec, value=value, marker=state.marker
        )


def _tables(walls: Walls) -> dict[str, Floats | Ints]:
    return {name: getattr(walls, name) for name in ("prim", "value", "mesh", "curve", "load")}


def _pairs(cap: int, room: int, width: int) -> Pairs:
    return Pairs(
        np.zeros(cap + 2, np.int64),
        np.zeros(room, np.uint32),
        np.zeros(room, np.uint8),
        np.zeros((room, width)),
    )


def _walls(cap: int, room: int) -> Walls:
    return Walls(
        start=np.zeros(cap + 2, np.int64),
        code=np.zeros(room, np.int32),
        touch=np.zeros(room, np.uint8),
        hist=np.zeros((room, 6)),
        prim=np.zeros((0, 16), np.int64),
        value=np.zeros((0, 8)),
        mesh=np.zeros((0, 16), np.int64),
        curve=np.zeros(0),
        load=np.zeros((0, 8)),
    )


def _flows(flows: int, pairs: int, events: int) -> Flows:
    return Flows(
        pair=np.zeros((pairs, 3), np.int64),
        count=np.zeros(1, np.int64),
        marker=np.zeros((flows, 0), np.int8),
        spec=np.zeros((flows, 4), np.int64),
        value=np.zeros((flows, 6)),
        event=np.zeros((events, 12)),
        found=np.zeros(1, np.int64),
    )
