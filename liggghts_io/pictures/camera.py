"""From where a picture is taken: always in a parallel projection, so that lengths are honest."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from liggghts_io.errors import CaseError, nearest

FloatArray = npt.NDArray[np.float64]
SIDE: Final = "side"
_ISO_DEG: Final = (-60.0, 25.0)
TURN_DEG: Final = 18.0
"""Height from which a turntable is seen."""
_MARGIN: Final = 0.03  # room around everything, as a part of its size


@dataclass(frozen=True)
class Camera:
    """A view in a parallel projection.

    Attributes
    ----------
    right, up : (3,) float64
        Directions of the apparatus that point right and up in the picture, of length 1.
    axes : (str, str), optional
        Names of the axes that lie in the picture; None where none do.
    """

    right: FloatArray
    up: FloatArray
    axes: tuple[str, str] | None

    @property
    def toward(self) -> FloatArray:
        """Direction to the viewer, shape (3,)."""
        return np.asarray(np.cross(self.right, self.up), dtype=np.float64)

    def seen(self, points: FloatArray) -> FloatArray:
        """Return where points (n, 3) are in the picture (n, 2), right and up [m]."""
        return np.asarray(points @ np.column_stack([self.right, self.up]), dtype=np.float64)

    def depths(self, points: FloatArray) -> FloatArray:
        """Return how near points (n, 3) are to the viewer, shape (n,) [m]."""
        return np.asarray(points @ self.toward, dtype=np.float64)

    def window(
        self, centres: FloatArray, radii: FloatArray, corners: FloatArray
    ) -> tuple[float, float, float, float]:
        """Return the smallest window that holds grains and corners of meshes, with a margin.

        Parameters
        ----------
        centres : (n, 3) float64
        radii : (n,) float64
        corners : (m, 3) float64

        Returns
        -------
        (float, float, float, float)
            Left, right, bottom and top [m].
        """
        middles, radius = self.seen(centres), radii[:, None]
        points = np.vstack([middles - radius, middles + radius, self.seen(corners)])
        low, high = points.min(axis=0), points.max(axis=0)
        margin = _MARGIN * float((high - low).max())
        left, bottom = (low - margin).tolist()
        right, top = (high + margin).tolist()
        return left, right, bottom, top


def orbit(azimuth_deg: float, height_deg: float) -> Camera:
    """Return the view from a direction: its angle about z from x, and above the horizontal."""
    a, h = math.radians(azimuth_deg), math.radians(height_deg)
    right = np.array([-math.sin(a), math.cos(a), 0.0])
    toward = np.array([math.cos(h) * math.cos(a), math.cos(h) * math.sin(a), math.sin(h)])
    return Camera(right, np.cross(toward, right), None)


_X, _Y, _Z = np.eye(3)
VIEWS: Final[dict[str, Camera]] = {
    SIDE: Camera(_X, _Z, ("x", "z")),
    "front": Camera(_Y, _Z, ("y", "z")),
    "top": Camera(_X, _Y, ("x", "y")),
    "iso": orbit(*_ISO_DEG),
}
"""Presets: along y, from where x points, from above, and from a corner."""


def camera_named(view: str) -> Camera:
    """Return the preset of that name.

    Raises
    ------
    CaseError
        For an unknown one, with the nearest.
    """
    if view not in VIEWS:
        msg = f"view {view!r}: there is none of that name{nearest(view, list(VIEWS))}"
        raise CaseError(msg)
    return VIEWS[view]
