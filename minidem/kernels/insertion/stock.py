"""The spheres near the place of an insertion, which new ones must not overlap."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from minidem.kernels.columns import LOWER, RADIUS, UPPER
from minidem.kernels.insertion.grid import Grid, divide, in_sight
from minidem.kernels.insertion.regions import RegionTable, matches, near_surface
from minidem.kernels.insertion.shape_columns import CONTACTS
from minidem.kernels.machine.jit import kernel
from minidem.kernels.machine.space import matrix

__all__ = ["There", "stock"]

_SLACK = 1e-6


class There(NamedTuple):
    """Spheres that are there, and which of them are looked at.

    Attributes
    ----------
    position : (N, 3) float64
        m.
    radius : (N,) float64
        m.
    extent : (2, 3) float64
        Corners of the region's bounding box, m.
    cut : float
        Those nearer to the region are looked at, m.
    wider : bool
        Whether their radii add to that.
    boxed : bool
        Whether the bounding box is asked instead of the region.
    """

    position: NDArray[np.float64]
    radius: NDArray[np.float64]
    extent: NDArray[np.float64]
    cut: float
    wider: bool
    boxed: bool


@kernel
def stock(
    table: RegionTable,
    there: There,
    bounds: NDArray[np.float64],
    most: int,
    largest: float,
    grid: Grid,
) -> int:
    """Fill a grid with the spheres in a region or near it; return how many.

    Parameters
    ----------
    table, there
        Region and spheres.
    bounds, most, largest, grid
        See `minidem.kernels.insertion.grid.divide`.
    """
    delta = matrix(CONTACTS, 3)
    count = 0
    for i in range(there.radius.shape[0]):
        cut = there.cut + (there.radius[i] if there.wider else 0.0)
        p = there.position[i]
        # Farther from the box than that is farther from the region, however it is rounded.
        slack = 0.0 if there.boxed else _SLACK * cut
        within = True
        for d in range(3):
            low = there.extent[LOWER, d] - cut - slack
            within = within and low <= p[d] <= there.extent[UPPER, d] + cut + slack
        if not (within and in_sight(grid.bins, p)):
            continue
        if there.boxed or matches(table, p) or near_surface(table, True, p, cut, delta):
            for d in range(3):
                grid.sphere[count, d] = p[d]
            grid.sphere[count, RADIUS] = there.radius[i]
            count += 1
    divide(grid, bounds, most, largest, count)
    return count
