"""Cells for the overlap check."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from minidem.insertion.particles import Present
from minidem.kernels.columns import POSITION, RADIUS
from minidem.kernels.insertion.grid import Grid, fill

__all__ = ["MOST_CELLS", "empty_grid", "make_grid"]

MOST_CELLS = 100
"""Cells along one axis; more would cost more memory than they save time."""


def empty_grid(bounds: NDArray[np.float64], largest: float, room: int) -> Grid:
    """Return memory for cells over the place of insertion.

    Parameters
    ----------
    bounds : (2, 3) ndarray
        Where new particles may be, m.
    largest : float
        Largest radius of a new particle, m.
    room : int
        Spheres.
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
    )


def make_grid(
    present: Present,
    near: NDArray[np.bool_],
    bounds: NDArray[np.float64],
    radii: NDArray[np.float64],
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

    Returns
    -------
    Grid
        With room for all new particles.
    """
    count, largest = int(near.sum()), float(radii.max())
    grid = empty_grid(bounds, largest, count + len(radii))
    grid.sphere[:count, POSITION] = present.position[near]
    grid.sphere[:count, RADIUS] = present.radius[near]
    fill(grid, bounds, MOST_CELLS, largest, count)
    return grid
