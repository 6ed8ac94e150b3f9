"""Cells for the overlap check."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from minidem.insertion.particles import Present
from minidem.kernels.columns import LOWER, POSITION, RADIUS, UPPER
from minidem.kernels.insertion.grid import Grid, fill

__all__ = ["make_grid"]

MOST_CELLS = 100
"""Cells along one axis; more would cost more memory than they save time."""


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
    count = int(near.sum())
    sphere = np.empty((count + len(radii), RADIUS + 1))
    sphere[:count, POSITION] = present.position[near]
    sphere[:count, RADIUS] = present.radius[near]
    largest = max(float(radii.max()), float(sphere[:count, RADIUS].max(initial=0.0)))
    edges = bounds[UPPER] - bounds[LOWER]
    cells = np.clip(edges / (2.0 * largest), 1, MOST_CELLS).astype(np.int64)
    grid = Grid(
        origin=bounds[LOWER].copy(),
        size=np.maximum(edges / cells, 2.0 * largest),
        cells=cells,
        head=np.full(int(cells.prod()), -1, dtype=np.int64),
        following=np.full(len(sphere), -1, dtype=np.int64),
        sphere=sphere,
    )
    fill(grid, count)
    return grid
