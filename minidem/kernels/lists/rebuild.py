"""A whole rebuild of the lists without leaving the compiled loop.

It serves the usual case: nothing is inserted, and the memory suffices. Everything else is
left to Python, which uses the same parts.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

from minidem.kernels.columns import (  # isort: skip
    RADIUS, ROW, SPIN, FLIGHT, FLIGHT_STOP, KEPT_KIND, KEPT_MASK, KEPT_ID, KEPT_RANK,
    KEPT_MARKER, KEPT_DENSITY, BOX_MOVES, PERIODS, NEED_PAIRS, NEED_WALLS, NEED_FLOWS, NEED_CELLS,
    NEED_COUNT, STEP, AIRBORNE_STEP, REACH, WET, WIDE,
)  # fmt: skip
from minidem.kernels.lists.cells import cell_count, grid, periods, sort_cells
from minidem.kernels.lists.lasting import last, note_places, widen
from minidem.kernels.lists.leaving import leave, wrap
from minidem.kernels.lists.wall_lists import wall_flow_list, wall_list
from minidem.kernels.machine.jit import inlined, inner
from minidem.kernels.machine.space import columns, vector
from minidem.kernels.motion.integrate import factors

__all__ = ["ASK_PYTHON", "INCOMPLETE", "LASTED", "MADE", "rebuild_for"]

MADE, ASK_PYTHON, INCOMPLETE, LASTED = 0, 1, 2, 3
FROM_LOOP, WITH_MORE, FROM_PYTHON, SORTED = range(4)  # modes


@inlined
def _permute(n: int, order: Any, table: Any, scratch: Any) -> None:
    """Put the rows of a table, whose length is a constant, in a new order."""
    wide = table.shape[1]
    for a in range(n):
        b = order[a]
        for c in range(wide):
            scratch[a, c] = table[b, c]
    for a in range(n):
        for c in range(wide):
            table[a, c] = scratch[a, c]


@inner
def _reorder(
    n: int, parts: Any, more: Any, marker: Any, flying: bool, wrapping: bool, wet: bool
) -> None:
    """Put all particle arrays in a new order; forces are not kept, they are worked out anew.

    Parameters
    ----------
    n : int
        Particles after.
    parts, more : tables
        See `minidem.kernels.tables`; ``more.order`` has the old index of each new one.
    marker : int8 (flows, cap)
        Markers of flow counters.
    flying, wrapping, wet : bool
        True if there are particles in flight; crossings of periodic faces; liquid.
    """
    order = more.order
    scratch = columns(more.scratch, FLIGHT)
    _permute(n, order, columns(parts.row, ROW), scratch)
    _permute(n, order, columns(parts.spin, SPIN), scratch)
    if wet:
        _permute(n, order, parts.liquid, scratch)
    if flying:
        _permute(n, order, columns(parts.flight, FLIGHT), scratch)
    else:
        for a in range(n):
            parts.flight[a, FLIGHT_STOP] = -1.0
    whole = more.whole
    for a in range(n):
        b = order[a]
        whole[a, KEPT_KIND] = parts.kind[b]
        whole[a, KEPT_MASK] = parts.mask[b]
        whole[a, KEPT_ID] = more.ids[b]
        whole[a, KEPT_RANK] = more.rank[b]
        scratch[a, KEPT_DENSITY] = more.density[b]
    for a in range(n):
        parts.kind[a] = whole[a, KEPT_KIND]
        parts.mask[a] = whole[a, KEPT_MASK]
        more.ids[a] = whole[a, KEPT_ID]
        more.rank[a] = whole[a, KEPT_RANK]
        more.density[a] = scratch[a, KEPT_DENSITY]
    for f in range(marker.shape[0]):
        for a in range(n):
            whole[a, KEPT_MARKER] = marker[f, order[a]]
        for a in range(n):
            marker[f, a] = whole[a, KEPT_MARKER]
    for c in range(3):
        for a in range(n):
            whole[a, c] = more.image[order[a], c] if wrapping else 0
    for a in range(n):
        for c in range(3):
            more.image[a, c] = whole[a, c]


@cache
def rebuild_for(list_pairs: Callable[..., Any]) -> Callable[..., Any]:
    """Return the rebuild of a run loop.

    Parameters
    ----------
    list_pairs : callable
        How it makes the pair list, see `minidem.kernels.step.phases.Phases`.

    Returns
    -------
    callable
        ``rebuild_inside(mode, n, before, tables, lists, spare)``.
    """

    @inner
    def rebuild_inside(mode: int, n: int, before: int, tables: Any, lists: Any, spare: Any) -> Any:
        """Sort the particles and make all lists anew.

        Parameters
        ----------
        mode : int
            `FROM_LOOP`: particles may leave through fixed faces; `WITH_MORE`: there are others than
            before, too; `FROM_PYTHON`: boundaries were applied and ``more.alive`` says who stays;
            `SORTED`: go on after `INCOMPLETE`.
        n, before : int
            Particles, and particles that the old lists were made for.
        tables : Tables
            See `minidem.kernels.tables`.
        lists, spare : Lists
            The lists in use, and those to fill.

        Returns
        -------
        int
            `MADE`; `ASK_PYTHON` if the particles were not sorted; `INCOMPLETE` if they are sorted
            but a list needs the memory that ``more.needs`` says; `LASTED` if the lists in use
            go on to be used.
        """
        whole = tables.control.whole
        real = tables.control.real
        parts = tables.parts
        more = tables.more
        flows = tables.flows
        box = more.box
        needs = more.needs
        row = parts.row
        cells = more.cells
        period = vector(PERIODS)
        wrapping = periods(box, period)
        small = (
            spare.pairs.start.shape[0] < n + 2
            or spare.walls.start.shape[0] < n + 2
            or spare.pairs.hist.shape[1] != lists.pairs.hist.shape[1]
        )
        inside = mode in (FROM_LOOP, WITH_MORE)
        if small or (inside and box[BOX_MOVES] > 0.0):
            return ASK_PYTHON
        if mode == FROM_LOOP and last(n, tables, lists):
            return LASTED
        if inside and wrap(n, row, more.image, box) and not leave(n, row, more, tables.control):
            return ASK_PYTHON
        if mode != SORTED:
            big = 0.0
            for i in range(n):
                big = max(big, row[i, RADIUS])
            widen(n, big, tables.control, parts, box)
            size = max(real[REACH] * 2.0 * big + real[WIDE], 1e-12)
            grid(n, row, size, 8 * n + 512, period, cells)
            needs[NEED_CELLS] = cell_count(cells) + 2
            if more.first.shape[0] < needs[NEED_CELLS]:
                return ASK_PYTHON
            n = sort_cells(n, row, more)
            needs[NEED_COUNT] = n
            flying = whole[AIRBORNE_STEP] >= whole[STEP]
            _reorder(n, parts, more, flows.marker, flying, wrapping, whole[WET] == 1)
        n = needs[NEED_COUNT]
        needs[NEED_PAIRS] = list_pairs(before, tables, lists, spare)
        needs[NEED_WALLS] = wall_list(n, before, tables, lists.walls, spare.walls)
        needs[NEED_FLOWS] = 0
        if more.ranges.shape[0] > 0:
            needs[NEED_FLOWS] = wall_flow_list(tables)
        if (
            needs[NEED_PAIRS] > spare.pairs.other.shape[0]
            or needs[NEED_WALLS] > spare.walls.code.shape[0]
            or needs[NEED_FLOWS] > flows.pair.shape[0]
        ):
            return INCOMPLETE
        note_places(n, tables)
        factors(n, tables.control, parts)
        return MADE

    kernel: Callable[..., Any] = rebuild_inside
    return kernel
