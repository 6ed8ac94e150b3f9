"""Cells for the overlap check, and the bins in which LIGGGHTS makes it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from minidem.insertion.particles import Present
from minidem.kernels.columns import LOWER, POSITION, RADIUS, UPPER
from minidem.kernels.insertion.grid import Bins, Grid, fill

__all__ = ["MOST_CELLS", "empty_grid", "make_grid", "search_bins"]

MOST_CELLS = 100
"""Cells along one axis; more would cost more memory than they save time."""


MOST_BINS = 8_000_000
"""As many has LIGGGHTS; where there would be more, a hundredth of the longest edge is a bin."""


def search_bins(
    place: NDArray[np.float64], box: NDArray[np.float64], largest: float, margin: float
) -> Bins:
    """Return the bins in which LIGGGHTS looks for what a new particle would overlap.

    Parameters
    ----------
    place : (2, 3) ndarray
        Corners around the place of insertion, m.
    box : (2, 3) ndarray
        Those of the simulation box, m.
    largest : float
        Largest radius of the distribution, m.
    margin : float
        How far beyond the place it looks, m.

    Returns
    -------
    Bins

    Notes
    -----
    Of the program (``FixInsert::load_xnear``): the place is cut to the box and widened; bins have
    edges of four radii or a little more.
    """
    low = np.maximum(place[LOWER], box[LOWER]) - margin
    high = np.minimum(place[UPPER], box[UPPER]) + margin
    edge = 4.0 * largest
    number = _number_of(high - low, edge, 1.0 / edge)
    if math.prod((number + 4).tolist()) > MOST_BINS:  # with two on each side
        number = _number_of(high - low, edge, 1.0 / (float((high - low).max()) / 100.0))
    return Bins(np.array([low, high]), number, 1.0 / ((high - low) / number))


def _number_of(extent: NDArray[np.float64], edge: float, inverse: float) -> NDArray[np.int64]:
    return np.maximum(((extent + edge * 1e-10) * inverse).astype(np.int64), 1)


def empty_grid(bounds: NDArray[np.float64], largest: float, room: int, bins: Bins) -> Grid:
    """Return memory for cells over the place of insertion.

    Parameters
    ----------
    bounds : (2, 3) ndarray
        Where new particles may be, m.
    largest : float
        Largest radius of a new particle, m.
    room : int
        Spheres.
    bins : Bins
        Those of LIGGGHTS.
    """
    cells = 1
    for low, high in zip(*bounds.tolist(), strict=True):
        cells *= int(min(max((high - low) / (2.0 * largest), 1.0), MOST_CELLS))
    return Grid(
        origin=np.empty(3),
        size=np.empty(3),
        cells=np.empty(3, np.int64),
        head=np.empty(cells, np.int64),
        following=np.empty(room, np.int64),
        sphere=np.empty((room, RADIUS + 1)),
        bins=bins,
    )


def make_grid(
    present: Present,
    near: NDArray[np.bool_],
    bounds: NDArray[np.float64],
    radii: NDArray[np.float64],
    bins: Bins,
) -> Grid:
    """Make cells over the place of insertion with the particles near it.

    Parameters
    ----------
    present : Present
        Particles that are there.
    near : (N,) ndarray of bool
        Which of them are looked at.
    bounds : (2, 3) ndarray
        Where new particles may be, m.
    radii : (n,) ndarray
        Radii of the new particles, m.
    bins : Bins
        Those of LIGGGHTS.

    Returns
    -------
    Grid
        With room for all new particles.
    """
    count, largest = int(near.sum()), float(radii.max())
    grid = empty_grid(bounds, largest, count + len(radii), bins)
    grid.sphere[:count, POSITION] = present.position[near]
    grid.sphere[:count, RADIUS] = present.radius[near]
    fill(grid, bounds, MOST_CELLS, largest, count)
    return grid
