"""Neighbour lists: spatial order and the half pair list with its history.

At a rebuild the particles are put in the order of their cells, so that neighbours are near in
memory, and the lists are made anew. What a pair remembers is carried over from the old list.
"""

from __future__ import annotations

from math import floor
from typing import Any

import numpy as np

from minidem.kernels.columns import (  # isort: skip
    X, Y, Z, RADIUS, CELL_CORNER, CELL_SIZE, CELL_COUNT, CELL_LARGEST, PERIOD_FROM, PERIOD, PERIODS,
    BOX_LOWER, BOX_UPPER, BOX_PERIODIC, SKIN, REACH, IMPACT, ROW,
)  # fmt: skip
from minidem.kernels.machine.jit import inlined, inner
from minidem.kernels.machine.space import columns, vector

__all__ = ["cell_count", "cell_of", "grid", "pair_list", "periods", "sort_cells"]


@inner
def periods(box: Any, period: Any) -> bool:
    """Return True if a direction is periodic, and fill in their lower corners and lengths.

    Parameters
    ----------
    box : float64 (12,)
        ``More.box``: columns ``BOX_...`` of `minidem.kernels.columns`.
    period : float64 (6,)
        Filled with lower corner(3), length(3), 0 where not periodic.
    """
    any_ = False
    for c in range(3):
        period[PERIOD_FROM + c] = 0.0
        period[PERIOD + c] = 0.0
        if box[BOX_PERIODIC + c] > 0.0:
            period[PERIOD_FROM + c] = box[BOX_LOWER + c]
            period[PERIOD + c] = box[BOX_UPPER + c] - box[BOX_LOWER + c]
            any_ = True
    return any_


@inner
def grid(n: int, row: Any, size: float, limit: int, period: Any, cells: Any) -> None:
    """Choose the cells: lower corner, cell size and number per direction.

    Parameters
    ----------
    n : int
        Particles.
    row : float64 (cap, 8)
        Particle rows.
    size : float
        Smallest cell size, m.
    limit : int
        Largest number of cells.
    period : float64 (6,)
        Lower corner and length of periodic directions, length 0 where not periodic.
    cells : float64 (12,)
        Filled with corner(3), size(3), numbers(3) of cells, largest radius, 0, 0.
    """
    lo = vector(3)
    hi = vector(3)
    for c in range(3):
        lo[c] = np.inf
        hi[c] = -np.inf
    big = 0.0
    for i in range(n):
        for c in range(3):
            lo[c] = min(lo[c], row[i, c])
            hi[c] = max(hi[c], row[i, c])
        big = max(big, row[i, RADIUS])
    if n == 0:
        for c in range(3):
            lo[c] = 0.0
            hi[c] = 0.0
    for c in range(3):
        if period[PERIOD + c] > 0.0:
            lo[c] = period[PERIOD_FROM + c]
            hi[c] = period[PERIOD_FROM + c] + period[PERIOD + c]
    cell = size
    while True:
        total = 1.0
        for c in range(3):
            number = max(
                1.0, floor((hi[c] - lo[c]) / cell + (0.0 if period[PERIOD + c] > 0.0 else 1.0))
            )
            cells[CELL_CORNER + c] = lo[c]
            cells[CELL_COUNT + c] = number
            cells[CELL_SIZE + c] = (hi[c] - lo[c]) / number if period[PERIOD + c] > 0.0 else cell
            total *= number
        if total <= limit:
            break
        cell *= 1.26
    cells[CELL_LARGEST] = big


@inlined
def cell_count(cells: Any) -> Any:
    """Return the number of cells."""
    return int(cells[CELL_COUNT + X] * cells[CELL_COUNT + Y] * cells[CELL_COUNT + Z])


@inlined
def cell_of(cells: Any, c: int, v: float) -> Any:
    """Return the cell of coordinate v along direction c, at most the last one."""
    k = floor((v - cells[CELL_CORNER + c]) / cells[CELL_SIZE + c])
    top = int(cells[CELL_COUNT + c]) - 1
    return min(max(k, 0), top)


@inner
def sort_cells(n: int, row: Any, more: Any) -> Any:
    """Sort particles by cell, stable; the dead are left out.

    Parameters
    ----------
    n : int
        Particles before.
    row : float64 (cap, 8)
        Particle rows.
    more : More
        ``alive`` says who stays; ``cells`` are from `grid`. ``first`` is filled with the first
        particle of each cell in the new order, ``order`` with the old index of each new one.

    Returns
    -------
    int
        Particles after.
    """
    alive = more.alive
    cells = more.cells
    first = more.first
    order = more.order
    where = more.where
    nx = int(cells[CELL_COUNT + X])
    ny = int(cells[CELL_COUNT + Y])
    total = cell_count(cells)
    for c in range(total + 1):
        first[c] = 0
    for i in range(n):
        if alive[i] == 0:
            where[i] = -1
            continue
        cx = cell_of(cells, X, row[i, X])
        cy = cell_of(cells, Y, row[i, Y])
        cz = cell_of(cells, Z, row[i, Z])
        where[i] = (cz * ny + cy) * nx + cx
        first[where[i] + 1] += 1
    for c in range(total):
        first[c + 1] += first[c]
    count = 0
    for i in range(n):
        if where[i] >= 0:
            order[first[where[i]]] = i
            first[where[i]] += 1
            count += 1
    for c in range(total, 0, -1):
        first[c] = first[c - 1]
    first[0] = 0
    return count


@inlined
def _recall(pairs: Any, ia: int, ib: int, fresh: Any, p: int, wide: int) -> None:
    """Copy the history of a pair of old indices; vectors turn if the owner changes."""
    sign = 1.0
    if ia > ib:
        ia, ib = ib, ia
        sign = -1.0
    for k in range(pairs.start[ia], pairs.start[ia + 1]):
        if pairs.other[k] == ib:
            fresh.touch[p] = pairs.touch[k]
            for c in range(min(wide, IMPACT)):
                fresh.hist[p, c] = sign * pairs.hist[k, c]
            for c in range(IMPACT, wide):
                fresh.hist[p, c] = pairs.hist[k, c]
            return


@inner
def pair_list(
    low: int, high: int, start: int, room: int, before: int, tables: Any, pairs: Any, fresh: Any
) -> Any:
    """Make a part of the half list: pairs nearer than radii times ``REACH`` plus ``SKIN``.

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
    order = tables.more.order
    skin = tables.control.real[SKIN]
    reach = tables.control.real[REACH]
    wide = fresh.hist.shape[1]
    period = vector(PERIODS)
    wrap = periods(tables.more.box, period)
    nx = int(cells[CELL_COUNT + X])
    ny = int(cells[CELL_COUNT + Y])
    nz = int(cells[CELL_COUNT + Z])
    p = start
    for a in range(low, high):
        fresh.start[a] = p
        x = row[a, X]
        y = row[a, Y]
        z = row[a, Z]
        ra = row[a, RADIUS]
        cx = cell_of(cells, X, x)
        cy = cell_of(cells, Y, y)
        cz = cell_of(cells, Z, z)
        for s in range(9):
            # without periods the rows before the own one hold lower indices only
            oy = s % 3 - 1
            oz = s // 3 - 1
            if not wrap and (oz < 0 or (oz == 0 and oy < 0)):
                continue
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
                lo = max(lo, a + 1)
                for b in range(lo, hi):
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
                    if d2 > cut * cut:
                        continue
                    if p < room:
                        fresh.owner[p] = a
                        fresh.other[p] = b
                        fresh.touch[p] = 0
                        for c in range(wide):
                            fresh.hist[p, c] = 0.0
                        if d2 < reach * reach * both * both:
                            ia = order[a]
                            ib = order[b]
                            if ia < before and ib < before:
                                _recall(pairs, ia, ib, fresh, p, wide)
                    p += 1
    return p - start
