"""Neighbour lists: the half pair list with its history.

At a rebuild the particles are put in the order of their cells (`minidem.kernels.lists.cells`), so
that neighbours are near in memory, and the lists are made anew. What a pair remembers is carried
over from the old list.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from minidem.kernels.columns import (  # isort: skip
    X, Y, Z, RADIUS, CELL_COUNT, PERIOD, PERIODS, WIDE, REACH, IMPACT, ROW,
    WITH_ROLLING,
)  # fmt: skip
from minidem.kernels.lists.cells import cell_of, periods
from minidem.kernels.machine.jit import inlined, inner
from minidem.kernels.machine.space import columns, vector

__all__ = ["pair_list"]


@inlined
def _recall(pairs: Any, ia: int, ib: int, fresh: Any, p: Any, wide: int) -> None:
    """Copy the history of a pair of old indices; vectors turn if the owner changes."""
    sign = 1.0
    if ia > ib:
        ia, ib = ib, ia
        sign = -1.0
    for k in range(np.uint64(pairs.start[ia]), np.uint64(pairs.start[ia + 1])):
        if pairs.other[k] == ib:
            fresh.touch[p] = pairs.touch[k]
            if wide == WITH_ROLLING:  # the usual number, as a constant
                old = columns(pairs.hist, WITH_ROLLING)
                new = columns(fresh.hist, WITH_ROLLING)
                for c in range(WITH_ROLLING):
                    new[p, c] = sign * old[k, c]
                return
            for c in range(min(wide, IMPACT)):
                fresh.hist[p, c] = sign * pairs.hist[k, c]
            for c in range(IMPACT, wide):
                fresh.hist[p, c] = pairs.hist[k, c]
            return


@inlined
def _remember(
    a: int, start: Any, stop: Any, before: int, order: Any, pairs: Any, fresh: Any
) -> None:
    """Fill in the entries of particle `a`; those with ``touch`` set take their history along."""
    wide = fresh.hist.shape[1]
    ia = order[a]
    for p in range(start, stop):
        near = fresh.touch[p] != 0
        fresh.owner[p] = a
        fresh.touch[p] = 0
        if wide == WITH_ROLLING:
            hist = columns(fresh.hist, WITH_ROLLING)
            for c in range(WITH_ROLLING):
                hist[p, c] = 0.0
        else:
            for c in range(wide):
                fresh.hist[p, c] = 0.0
        if near and ia < before:
            ib = order[fresh.other[p]]
            if ib < before:
                _recall(pairs, ia, ib, fresh, p, wide)


@inner
def pair_list(
    low: int, high: int, start: int, room: int, before: int, tables: Any, pairs: Any, fresh: Any
) -> Any:
    """Make a part of the half list: pairs nearer than radii times ``REACH`` plus ``WIDE``.

    A pair within ``REACH`` takes its history along; all others start from zero, as in LIGGGHTS.

    Parameters
    ----------
    low, high : int
        Particles that own the pairs of this part, in cell order, `high` left out.
    start, room : int
        First entry to fill, and the first one not to be touched.
    before : int
        Particles that had rows in the old list.
    tables : Tables
        See `minidem.kernels.tables`; sorted by `sort_cells`.
    pairs, fresh : Pairs
        Old list, and the one to fill.

    Returns
    -------
    int
        Entries needed; if more than there is room for, none was written beyond it.
    """
    row = columns(tables.parts.row, ROW)
    cells = tables.more.cells
    first = tables.more.first
    other = fresh.other
    touch = fresh.touch
    skin = tables.control.real[WIDE]
    reach = tables.control.real[REACH]
    period = vector(PERIODS)
    wrap = periods(tables.more.box, period)
    nx = int(cells[CELL_COUNT + X])
    ny = int(cells[CELL_COUNT + Y])
    nz = int(cells[CELL_COUNT + Z])
    end = np.uint64(room)
    top = np.uint64(start)
    for a in range(low, high):
        begin = top
        fresh.start[a] = np.int64(top)
        x = row[a, X]
        y = row[a, Y]
        z = row[a, Z]
        ra = row[a, RADIUS]
        cx = cell_of(cells, X, x)
        cy = cell_of(cells, Y, y)
        cz = cell_of(cells, Z, z)
        # without periods the rows before the own one, the fifth of nine, hold lower indices only
        for s in range(0 if wrap else 4, 9):
            oy = s % 3 - 1
            oz = s // 3 - 1
            ey = cy + oy
            ez = cz + oz
            if period[PERIOD + Y] > 0.0:
                if (ny == 1 and oy != 0) or (ny == 2 and oy == 1):
                    continue
                ey = ey % ny
            if period[PERIOD + Z] > 0.0:
                if (nz == 1 and oz != 0) or (nz == 2 and oz == 1):
                    continue
                ez = ez % nz
            if ey < 0 or ey >= ny or ez < 0 or ez >= nz:
                continue
            base = (ez * ny + ey) * nx
            spans = 1
            if period[PERIOD + X] > 0.0:
                spans = 3 if nx >= 3 else nx
            for u in range(spans):
                if period[PERIOD + X] > 0.0:
                    ex = (cx + u - 1 + nx) % nx if nx >= 3 else u
                    lo = first[base + ex]
                    hi = first[base + ex + 1]
                else:
                    lo = first[base + max(cx - 1, 0)]
                    hi = first[base + min(cx + 1, nx - 1) + 1]
                # every pair is written, and the next one overwrites it unless it is near: the
                # processor cannot guess which are
                for b in range(np.uint64(max(lo, a + 1)), np.uint64(max(hi, a + 1))):
                    dx = x - row[b, X]
                    dy = y - row[b, Y]
                    dz = z - row[b, Z]
                    if wrap:
                        if period[PERIOD + X] > 0.0:
                            dx -= period[PERIOD + X] * np.rint(dx / period[PERIOD + X])
                        if period[PERIOD + Y] > 0.0:
                            dy -= period[PERIOD + Y] * np.rint(dy / period[PERIOD + Y])
                        if period[PERIOD + Z] > 0.0:
                            dz -= period[PERIOD + Z] * np.rint(dz / period[PERIOD + Z])
                    both = ra + row[b, RADIUS]
                    d2 = dx * dx + dy * dy + dz * dz
                    cut = reach * both + skin
                    if top < end:
                        other[top] = np.uint32(b)
                        touch[top] = np.uint8(d2 < reach * reach * both * both)
                    top += np.uint64(not d2 > cut * cut)
        if top <= end:
            _remember(a, begin, top, before, tables.more.order, pairs, fresh)
    return np.int64(top) - start
