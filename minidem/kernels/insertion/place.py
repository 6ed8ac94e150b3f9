"""Placing of particles in a region, or behind a face, without overlap.

The order of random numbers and of the tests is that of LIGGGHTS-PUBLIC 3.8.0, so that the same
seeds give the same positions to the last bit.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from minidem.kernels.columns import CONTACTS, LOWER, MEAN, RADIUS, SPREAD, UPPER, X, Y, Z
from minidem.kernels.insertion.random import gaussian, uniform
from minidem.kernels.insertion.regions import RegionTable, matches, near_surface
from minidem.kernels.machine.jit import inlined, kernel
from minidem.kernels.machine.space import matrix, vector

__all__ = [
    "FULL",
    "PLACED",
    "STUCK",
    "Grid",
    "Rules",
    "add_sphere",
    "border_distance",
    "count_in_region",
    "draw_velocity_of",
    "fill",
    "near_region",
    "overlaps",
    "place_in_region",
]

PLACED, FULL, STUCK = range(3)
"""Outcome: all placed; attempts used up; no admissible point found in the region."""

_PATIENCE = 100_000_000


class Rules(NamedTuple):
    """How particles are placed.

    Attributes
    ----------
    all_in : bool
        Whether the whole sphere must be inside.
    check_overlap : bool
        Whether spheres may not overlap others.
    check_border : bool
        Whether spheres must be inside the simulation box.
    velocity_style : int
        0 constant, 1 uniform, 2 gaussian.
    """

    all_in: bool
    check_overlap: bool
    check_border: bool
    velocity_style: int


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
    head : (cells,) int64
        First sphere of each cell, -1 for none.
    following : (capacity,) int64
        Next sphere of the same cell.
    sphere : (capacity, 4) float64
        Centre and radius, m.
    """

    origin: NDArray[np.float64]
    size: NDArray[np.float64]
    cells: NDArray[np.int64]
    head: NDArray[np.int64]
    following: NDArray[np.int64]
    sphere: NDArray[np.float64]


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


@kernel
def fill(grid: Grid, count: int) -> None:
    """Put the first `count` spheres into their cells."""
    for i in range(count):
        _add(grid, i)


@kernel
def overlaps(grid: Grid, p: NDArray[np.float64], r: float) -> bool:
    """Tell whether a sphere touches or overlaps one in the grid."""
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
                    if a * a + b * b + c * c <= reach * reach:
                        return True
                    i = grid.following[i]
    return False


@inlined
def border_distance(p: NDArray[np.float64], box: NDArray[np.float64]) -> float:
    """Return the distance to the nearest plane of the simulation box, box is (2, 3)."""
    nearest = abs(box[LOWER, X] - p[X])
    for d in range(3):
        nearest = min(nearest, abs(box[LOWER, d] - p[d]), abs(box[UPPER, d] - p[d]))
    return nearest


@inlined
def draw_velocity(
    style: int, base: NDArray[np.float64], given: NDArray[np.float64], out: NDArray[np.float64]
) -> None:
    """Write a velocity to `out`; `given` is (2, 3): mean and fluctuation."""
    for d in range(3):
        if style == 1:
            out[d] = given[MEAN, d] + given[SPREAD, d] * 2.0 * (uniform(base) - 0.50)
        elif style == 2:
            out[d] = given[MEAN, d] + given[SPREAD, d] * gaussian(base)
        else:
            out[d] = given[MEAN, d]


@kernel
def draw_velocity_of(
    style: int, base: NDArray[np.float64], given: NDArray[np.float64], out: NDArray[np.float64]
) -> None:
    """Write a velocity to `out`; for callers outside the kernels."""
    draw_velocity(style, base, given, out)


@kernel
def count_in_region(
    table: RegionTable,
    extent: NDArray[np.float64],
    box: NDArray[np.float64],
    state: NDArray[np.float64],
    tries: int,
) -> int:
    """Count random points of the region's bounding box that are in region and simulation box.

    `extent` and `box` are (2, 3) lower and upper corner. Always draws 3 numbers per try.
    """
    p = vector(3)
    hits = 0
    for _ in range(tries):
        within = True
        for d in range(3):
            p[d] = extent[LOWER, d] + uniform(state) * (extent[UPPER, d] - extent[LOWER, d])
            within = within and p[d] >= box[LOWER, d] and p[d] <= box[UPPER, d]
        if within and matches(table, p):
            hits += 1
    return hits


@kernel
def near_region(
    table: RegionTable,
    points: NDArray[np.float64],
    cut: NDArray[np.float64],
    result: NDArray[np.bool_],
) -> None:
    """Write for each point whether it is in the region or nearer than `cut` to it, shape (N,)."""
    delta = matrix(CONTACTS, 3)
    for i in range(points.shape[0]):
        result[i] = matches(table, points[i]) or near_surface(table, True, points[i], cut[i], delta)


@kernel
def place_in_region(
    table: RegionTable,
    rules: Rules,
    bounds: NDArray[np.float64],
    box: NDArray[np.float64],
    radii: NDArray[np.float64],
    attempts: int,
    given: NDArray[np.float64],
    place: NDArray[np.float64],
    base: NDArray[np.float64],
    grid: Grid,
    near: int,
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
) -> tuple[int, int]:
    """Place spheres at random points of a region, one after the other.

    One loop, because every rejection decides which random number comes next.

    Parameters
    ----------
    table, rules, grid
        Region, rules, and the spheres that are there (`near` of them).
    bounds, box : (2, 3)
        Where points are drawn; the simulation box, m.
    radii : (n,)
        Radii in order of insertion, m.
    attempts : int
        Points that may be tried in all.
    given : (2, 3)
        Mean velocity and its fluctuation, m/s.
    place, base : (3,)
        States of the generators of the region and of the command; advanced.
    position, velocity : (n, 3)
        Results.

    Returns
    -------
    tuple of int
        Spheres placed, and PLACED, FULL or STUCK.
    """
    delta = matrix(CONTACTS, 3)
    p = vector(3)
    v = vector(3)
    tried = 0
    done = 0
    while done < radii.shape[0]:
        if rules.check_overlap and tried >= attempts:
            return done, FULL
        r = radii[done]
        misses = 0
        while True:
            for d in range(3):
                p[d] = bounds[LOWER, d] + uniform(place) * (bounds[UPPER, d] - bounds[LOWER, d])
            misses += 1
            if misses > _PATIENCE:
                return done, STUCK
            if not matches(table, p):
                continue
            if rules.all_in and near_surface(table, False, p, r, delta):
                continue
            tried += 1
            if not rules.check_overlap or not rules.check_border or tried >= attempts:
                break
            if border_distance(p, box) >= r:
                break
        if rules.check_overlap and tried >= attempts:
            return done, FULL
        draw_velocity(rules.velocity_style, base, given, v)
        if rules.check_overlap:
            if overlaps(grid, p, r):
                continue
            add_sphere(grid, near + done, p, r)
        for d in range(3):
            position[done, d] = p[d]
            velocity[done, d] = v[d]
        done += 1
    return done, PLACED
