"""Cells of the box: which particles are in each, and the order of particles by cell."""

from __future__ import annotations

from math import floor
from typing import Any

import numpy as np

from minidem.kernels.columns import (  # isort: skip
    X, Y, Z, RADIUS, CELL_CORNER, CELL_SIZE, CELL_COUNT, CELL_LARGEST, PERIOD_FROM, PERIOD,
    BOX_LOWER, BOX_UPPER, BOX_PERIODIC,
)  # fmt: skip
from minidem.kernels.machine.jit import inlined, inner
from minidem.kernels.machine.space import vector

__all__ = ["cell_count", "cell_of", "grid", "periods", "sort_cells"]


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
    for c in range(total + 2):
        first[c] = 0
    for i in range(n):
        if alive[i] == 0:
            where[i] = -1
            continue
        cx = cell_of(cells, X, row[i, X])
        cy = cell_of(cells, Y, row[i, Y])
        cz = cell_of(cells, Z, row[i, Z])
        where[i] = (cz * ny + cy) * nx + cx
        first[where[i] + 2] += 1
    before = 0
    for c in range(total):
        count = first[c + 2]
        first[c + 1] = before
        before += count
    for i in range(n):
        if where[i] >= 0:
            order[first[where[i] + 1]] = i
            first[where[i] + 1] += 1
    return before
