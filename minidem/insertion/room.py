"""The part of a region that lies in the simulation box."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from minidem.errors import DemError
from minidem.insertion.grid import empty_grid, search_bins
from minidem.insertion.settings import Domain, Settings
from minidem.kernels.columns import LOWER, UPPER
from minidem.kernels.insertion.grid import Grid

__all__ = ["Room"]

SMALL: Final = 1e-10
_GROWTH = 1.5  # memory for spheres grows by half, so that it is seldom taken anew


class Room:
    """Where an insertion may put particles; worked out anew only for another box.

    Parameters
    ----------
    name : str
        Name of the fix, for messages.
    extent : (2, 3) ndarray
        Corners around the region, which is at rest, m.
    settings : Settings
        Common keywords of the command.
    """

    def __init__(self, name: str, extent: NDArray[np.float64], settings: Settings) -> None:
        self._name = name
        self._extent = extent
        self._settings = settings
        self._checked: tuple[bytes, tuple[str, ...]] | None = None
        self._asked: tuple[bytes, float] | None = None
        self._corners = np.zeros((2, 2, 3))
        self._grid: Grid | None = None

    def within(
        self, box: NDArray[np.float64], largest: float, spheres: int
    ) -> tuple[NDArray[np.float64], Grid]:
        """Return where points are drawn, and memory for the cells over it; the same while it fits.

        Parameters
        ----------
        box : (2, 3) ndarray
            Corners of the simulation box, m.
        largest : float
            Largest radius that is to be inserted, m.
        spheres : int
            How many the cells must hold.

        Returns
        -------
        (2, 2, 3) ndarray
            Corners of the part of the region in the box, and of the box, m.
        Grid
            Its cells and spheres are those of the last insertion.

        Raises
        ------
        DemError
            If there is no room, or none for a sphere of that radius.
        """
        asked, grid = (box.tobytes(), largest), self._grid
        if grid is None or asked != self._asked or len(grid.sphere) < spheres:
            low = np.maximum(self._extent[LOWER], box[LOWER])
            bounds = np.array([low, np.minimum(self._extent[UPPER], box[UPPER])])
            self._check_size(bounds, largest)
            widest = self._settings.distribution.max_radius
            bins = search_bins(self._extent, box, widest, 2.0 * widest)
            grid = empty_grid(bounds, largest, int(_GROWTH * spheres), bins)
            self._asked, self._grid = asked, grid
            self._corners = np.array([bounds, box])
        return self._corners, grid

    def check(self, domain: Domain) -> None:
        """Refuse a region that extends over a fixed face of the box.

        Raises
        ------
        DemError
            If it does.
        """
        asked = domain.box.tobytes(), domain.boundary
        if asked == self._checked:
            return
        low, high = self._extent[LOWER] + SMALL, self._extent[UPPER] - SMALL
        outside = np.any(low < domain.box[LOWER]) or np.any(high > domain.box[UPPER])
        if outside and any("f" in face for face in domain.boundary):
            msg = (
                f"fix {self._name}: the insertion region extends outside the simulation box and a "
                "boundary is fixed; make the region smaller or use boundary m"
            )
            raise DemError(msg)
        self._checked = asked

    def _check_size(self, bounds: NDArray[np.float64], radius: float) -> None:
        if np.any(bounds[LOWER] >= bounds[UPPER]):
            msg = f"fix {self._name}: the insertion region is outside the simulation box"
            raise DemError(msg)
        edges = self._extent[UPPER] - self._extent[LOWER]
        if self._settings.all_in and float(edges.min()) < 2.0 * radius:
            msg = (
                f"fix {self._name}: the insertion region is {edges.min():g} m thick, too small for "
                f"spheres of diameter {2.0 * radius:g} m with 'all_in yes'"
            )
            raise DemError(msg)
