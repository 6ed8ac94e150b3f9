"""Placing of particles in a region, or behind a face, without overlap.

The order of random numbers and of the tests is that of LIGGGHTS-PUBLIC 3.8.0, so that the same
seeds give the same positions to the last bit.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from minidem.kernels.columns import DOMAIN, DRAWN, LOWER, MEAN, SPREAD, UPPER, X
from minidem.kernels.insertion.grid import Grid, add_sphere, overlaps
from minidem.kernels.insertion.random import draw_orientation, gaussian, uniform
from minidem.kernels.insertion.regions import RegionTable, matches, near_surface
from minidem.kernels.insertion.shape_columns import CONTACTS
from minidem.kernels.insertion.shapes import TETS
from minidem.kernels.insertion.tets import draw_in_tets, near_tet_surface
from minidem.kernels.machine.jit import inlined, kernel
from minidem.kernels.machine.space import matrix, vector

__all__ = [
    "FULL",
    "PLACED",
    "STUCK",
    "Batch",
    "Generators",
    "Rules",
    "border_distance",
    "count_in_region",
    "draw_velocity_of",
    "place_in_region",
]

PLACED, FULL, STUCK = range(3)
"""Outcome: all placed; attempts used up; no admissible point found in the region."""

_PATIENCE = 100_000_000
_MESH_PATIENCE = 10_000  # as LIGGGHTS has it


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
    turned : bool
        Whether each try draws an orientation: a sphere shows none, but its numbers are gone.
    """

    all_in: bool
    check_overlap: bool
    check_border: bool
    velocity_style: int
    turned: bool


class Batch(NamedTuple):
    """Spheres that want a place, in the order of insertion, and the places they found.

    Attributes
    ----------
    radii : (n,) float64
        m.
    attempts : int
        Points that may be tried in all.
    near : int
        Spheres that are in the grid before.
    position, velocity : (n, 3) float64
        Results, m and m/s; places behind a face come without velocities.
    """

    radii: NDArray[np.float64]
    attempts: int
    near: int
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]


class Generators(NamedTuple):
    """States of random generators, which kernels advance.

    Attributes
    ----------
    place : (3,) float64
        Of the generator that chooses points.
    base : (3,) float64
        Of the generator for all else.
    """

    place: NDArray[np.float64]
    base: NDArray[np.float64]


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
def place_in_region(
    table: RegionTable,
    rules: Rules,
    corners: NDArray[np.float64],
    batch: Batch,
    given: NDArray[np.float64],
    generators: Generators,
    grid: Grid,
) -> tuple[int, int]:
    """Place spheres at random points of a region, one after the other.

    One loop, because every rejection decides which random number comes next.

    Parameters
    ----------
    table, rules, grid
        Region, rules, and the spheres that are there.
    corners : (2, 2, 3)
        Of the box that points are drawn in, and of the simulation box, m.
    batch : Batch
        Spheres; receives the places.
    given : (2, 3)
        Mean velocity and its fluctuation, m/s.
    generators : Generators
        Of the region and of the command.

    Returns
    -------
    tuple of int
        Spheres placed, and PLACED, FULL or STUCK.
    """
    bounds = corners[DRAWN]
    box = corners[DOMAIN]
    radii = batch.radii
    attempts = batch.attempts
    delta = matrix(CONTACTS, 3)
    p = vector(3)
    v = vector(3)
    root = table.kind.shape[0] - 1
    meshed = table.kind[root] == TETS
    tried = 0
    done = 0
    while done < radii.shape[0]:
        if rules.check_overlap and tried >= attempts:
            return done, FULL
        r = radii[done]
        misses = 0
        while True:
            misses += 1
            if misses > (_MESH_PATIENCE if meshed else _PATIENCE):
                return done, STUCK
            if meshed:
                tet = draw_in_tets(table.tets, root, generators.place, p)
                if rules.all_in and near_tet_surface(table.tets, tet, p, r):
                    continue
            else:
                for d in range(3):
                    p[d] = bounds[LOWER, d] + uniform(generators.place) * (
                        bounds[UPPER, d] - bounds[LOWER, d]
                    )
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
        draw_velocity(rules.velocity_style, generators.base, given, v)
        if rules.turned:
            draw_orientation(generators.base)
        if rules.check_overlap:
            if overlaps(grid, p, r):
                continue
            add_sphere(grid, batch.near + done, p, r)
        for d in range(3):
            batch.position[done, d] = p[d]
            batch.velocity[done, d] = v[d]
        done += 1
    return done, PLACED
