"""Cells that hold the spheres near the place of an insertion."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from minidem.kernels.columns import LOWER, RADIUS, UPPER, X, Y, Z
from minidem.kernels.machine.jit import inlined, kernel

__all__ = ["Bins", "Grid", "add_sphere", "count_inside", "divide", "fill", "in_sight", "overlaps"]


class Bins(NamedTuple):
    """The search bins of LIGGGHTS over the place of an insertion.

    It looks for overlap in the bin of a new particle and in those beside it. Their edges are at
    least four times the largest new radius, so that it overlooks what is farther away, however
    large that is.

    Attributes
    ----------
    bounds : (2, 3) float64
        Corners, m; what lies outside is overlooked.
    number : (3,) int64
        Bins along each axis.
    inverse : (3,) float64
        One over their edges, 1/m.
    """

    bounds: NDArray[np.float64]
    number: NDArray[np.int64]
    inverse: NDArray[np.float64]


class Grid(NamedTuple):
    """Cells that hold the spheres near the place of insertion, as linked lists.

    Attributes
    ----------
    origin : (3,) float64
        Lower corner, m.
    size : (3,) float64
        Edges of a cell, m, none smaller than twice the largest radius.
    cells : (3,) int64
        Number of cells.
    head : (room,) int64
        First sphere of each cell, -1 for none.
    following : (capacity,) int64
        Next sphere of the same cell.
    sphere : (capacity, 4) float64
        Centre and radius, m.
    bins : Bins
        Which of them LIGGGHTS sees.
    """

    origin: NDArray[np.float64]
    size: NDArray[np.float64]
    cells: NDArray[np.int64]
    head: NDArray[np.int64]
    following: NDArray[np.int64]
    sphere: NDArray[np.float64]
    bins: Bins


@inlined
def in_sight(bins: Bins, p: NDArray[np.float64]) -> bool:
    """Tell whether LIGGGHTS puts a sphere at a place into its bins."""
    found = True
    for d in range(3):
        found = found and bins.bounds[LOWER, d] <= p[d] <= bins.bounds[UPPER, d]
    return found


@inlined
def _bin(bins: Bins, d: int, x: float) -> int:
    """Return the bin of LIGGGHTS of a coordinate, which may lie beyond the first and last."""
    low, high = bins.bounds[LOWER, d], bins.bounds[UPPER, d]
    if x >= high:
        return int((x - high) * bins.inverse[d]) + bins.number[d]
    if x >= low:
        return min(int((x - low) * bins.inverse[d]), bins.number[d] - 1)
    return int((x - low) * bins.inverse[d]) - 1


@inlined
def _seen(bins: Bins, p: NDArray[np.float64], q: NDArray[np.float64]) -> bool:
    """Tell whether two places are in bins beside each other, or in one."""
    found = True
    for d in range(3):
        found = found and abs(_bin(bins, d, p[d]) - _bin(bins, d, q[d])) <= 1
    return found


@inlined
def _cell(grid: Grid, d: int, x: float) -> int:
    """Return the cell of a coordinate; outer ones belong to the first or last cell."""
    c = int(np.floor((x - grid.origin[d]) / grid.size[d]))
    return min(max(c, 0), grid.cells[d] - 1)


@inlined
def _add(grid: Grid, i: int) -> None:
    """Put sphere `i` into its cell."""
    s = grid.sphere[i]
    cx, cy, cz = _cell(grid, X, s[X]), _cell(grid, Y, s[Y]), _cell(grid, Z, s[Z])
    c = (cz * grid.cells[Y] + cy) * grid.cells[X] + cx
    grid.following[i] = grid.head[c]
    grid.head[c] = i


@inlined
def add_sphere(grid: Grid, i: int, p: NDArray[np.float64], r: float) -> None:
    """Store sphere `i` and put it into its cell."""
    for d in range(3):
        grid.sphere[i, d] = p[d]
    grid.sphere[i, RADIUS] = r
    _add(grid, i)


@inlined
def divide(grid: Grid, bounds: NDArray[np.float64], most: int, largest: float, count: int) -> None:
    """Choose the cells over a box, and put the first `count` spheres into them.

    No more than `most` cells along an axis; none is smaller than twice the largest radius, that of
    new spheres, `largest`, and of those that are there. ``head`` has room for as many cells as new
    spheres alone would want.
    """
    for i in range(count):
        largest = max(largest, grid.sphere[i, RADIUS])
    wanted = 1
    for d in range(3):
        edge = bounds[UPPER, d] - bounds[LOWER, d]
        cells = int(min(max(edge / (2.0 * largest), 1.0), 1.0 * most))
        grid.origin[d] = bounds[LOWER, d]
        grid.cells[d] = cells
        grid.size[d] = max(edge / cells, 2.0 * largest)
        wanted *= cells
    for c in range(wanted):
        grid.head[c] = -1
    for i in range(count):
        _add(grid, i)


@kernel
def fill(grid: Grid, bounds: NDArray[np.float64], most: int, largest: float, count: int) -> None:
    """As `divide`, for callers outside the kernels."""
    divide(grid, bounds, most, largest, count)


@kernel
def overlaps(grid: Grid, p: NDArray[np.float64], r: float) -> bool:
    """Tell whether a sphere touches or overlaps one in the grid, as far as LIGGGHTS sees it."""
    cx, cy, cz = _cell(grid, X, p[X]), _cell(grid, Y, p[Y]), _cell(grid, Z, p[Z])
    for kz in range(max(cz - 1, 0), min(cz + 2, grid.cells[Z])):
        for ky in range(max(cy - 1, 0), min(cy + 2, grid.cells[Y])):
            for kx in range(max(cx - 1, 0), min(cx + 2, grid.cells[X])):
                i = grid.head[(kz * grid.cells[Y] + ky) * grid.cells[X] + kx]
                while i >= 0:
                    s = grid.sphere[i]
                    a = p[X] - s[X]
                    b = p[Y] - s[Y]
                    c = p[Z] - s[Z]
                    reach = r + s[RADIUS]
                    if a * a + b * b + c * c <= reach * reach and _seen(grid.bins, p, s):
                        return True
                    i = grid.following[i]
    return False


@kernel
def count_inside(
    there: NDArray[np.float64],
    radius: NDArray[np.float64],
    new: NDArray[np.float64],
    new_radius: NDArray[np.float64],
) -> int:
    """Return how many new spheres, (n, 3) and (n,) m, overlap one of others, (m, 3) and (m,) m."""
    count = 0
    for k in range(new_radius.shape[0]):
        for i in range(radius.shape[0]):
            a = new[k, X] - there[i, X]
            b = new[k, Y] - there[i, Y]
            c = new[k, Z] - there[i, Z]
            reach = new_radius[k] + radius[i]
            if a * a + b * b + c * c <= reach * reach:
                count += 1
                break
    return count
