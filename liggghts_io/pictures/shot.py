"""What a picture shows: one frame, the meshes around it, what colours say, and words."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from liggghts_io.experiments import Notes
from liggghts_io.measure.dumps import Frame
from liggghts_io.pictures.camera import SIDE, VIEWS, Camera
from liggghts_io.pictures.colouring import Colouring

FloatArray = npt.NDArray[np.float64]
Window = tuple[float, float, float, float]

_FEW: Final = 10  # grains, of which none is far away
_USUAL: Final = 0.9  # part of the grains that tells where they are
_FAR: Final = 30.0  # of their distance from the middle
_GLASS: Final = 0.35  # most opacity of a mesh where it may hide grains


@dataclass(frozen=True)
class Shot:
    """What a picture shows.

    Attributes
    ----------
    frame : Frame
    colouring : Colouring
    meshes : Mapping[str, (n, 3, 3) float64]
        Triangles that are drawn [m].
    opacities : Mapping[str, float]
        Of the meshes, seen from the side.
    number, last : int
        Which dump of the run it is, and the number of the last one; both count from 0.
    window : (float, float, float, float), optional
        Left, right, bottom and top seen from the side [m]; without it, all grains and meshes.
    title : str
    notes : Notes
        What is written on the picture from the side.
    """

    frame: Frame
    colouring: Colouring
    meshes: Mapping[str, FloatArray] = field(default_factory=dict)
    opacities: Mapping[str, float] = field(default_factory=dict)
    number: int = 0
    last: int = 0
    window: Window | None = None
    title: str = ""
    notes: Notes = field(default_factory=Notes)

    def window_of(self, camera: Camera) -> Window:
        """Return left, right, bottom and top of the picture that a camera takes [m]."""
        if self.window is not None and camera is VIEWS[SIDE]:
            return self.window
        corners = [triangles.reshape(-1, 3) for triangles in self.meshes.values()]
        near = ~self.far
        return camera.window(
            self.frame.positions[near],
            self.frame.columns["radius"][near],
            np.vstack([np.empty((0, 3)), *corners]),
        )

    @property
    def far(self) -> npt.NDArray[np.bool_]:
        """Which grains are so far from all others that only they would be in sight, (n,) bool."""
        places = self.frame.positions
        if len(places) < _FEW:
            return np.zeros(len(places), dtype=bool)
        away = np.abs(places - np.median(places, axis=0)).max(axis=1)
        return np.asarray(away > _FAR * np.quantile(away, _USUAL))

    def opacity(self, name: str, camera: Camera) -> float:
        """Return the opacity of a mesh, which hides no grain from above or from a corner."""
        given = self.opacities[name]
        return given if camera is VIEWS[SIDE] else min(given, _GLASS)

    def notes_for(self, camera: Camera) -> Notes:
        """Return what is written on the picture: lines and labels are those of the side."""
        return self.notes if camera is VIEWS[SIDE] else Notes(self.notes.title)


def seen_in(window: Window | None) -> Callable[[Frame], npt.NDArray[np.bool_]] | None:
    """Return what says which grains are in a window seen from the side, None for all."""
    if window is None:
        return None
    left, right, low, high = window

    def inside(frame: Frame) -> npt.NDArray[np.bool_]:
        x, z = frame.columns["x"], frame.columns["z"]
        return np.asarray((x >= left) & (x <= right) & (z >= low) & (z <= high))

    return inside


def edge_on(triangles: FloatArray, camera: Camera) -> Any:
    """Return which triangles (n, 3, 3) are seen as a line, shape (n,) bool."""
    a, b, c = (camera.seen(triangles[:, k]) for k in range(3))
    one, other = b - a, c - a
    area = np.abs(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0])
    size = np.ptp(triangles, axis=1).max(axis=1)
    return area <= 1e-6 * size**2
