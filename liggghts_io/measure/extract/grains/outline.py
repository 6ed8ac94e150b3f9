"""Upper outline of the grains, seen along an axis, as a silhouette shows it."""

from __future__ import annotations

from typing import Final, Literal

import numpy as np

from liggghts_io.errors import CaseError
from liggghts_io.measure.dumps import Frame
from liggghts_io.measure.extract.grains.boxes import SIZED, OfGrains
from liggghts_io.measure.extract.run import Run
from liggghts_io.measure.flanks import FloatArray
from liggghts_io.measure.silhouette import (
    Silhouette,
    draw_silhouette,
    heap_mask,
    upper_outline,
)

PIXELS_PER_DIAMETER: Final = 16.0


class OfOutline(OfGrains):
    """What extractors of a silhouette have in common.

    Attributes
    ----------
    plane : str
        "xz": seen along y; "yz": seen along x.
    """

    plane: Literal["xz", "yz"] = "xz"

    def silhouettes(self, run: Run) -> list[tuple[Silhouette, float]]:
        """Return the silhouette of each frame and the height of its lower border [m].

        Raises
        ------
        CaseError
            If a frame has no grain in the box.
        """
        return [self._drawn(frame, run) for frame in self.frames_of(run, SIZED)]

    def silhouette(self, frame: Frame, run: Run) -> tuple[Silhouette, float]:
        """Return the silhouette of one frame and the height of its lower border [m].

        Raises
        ------
        CaseError
            If it has no grain in the box.
        """
        return self._drawn(self.seen(frame, run), run)

    def _drawn(self, frame: Frame, run: Run) -> tuple[Silhouette, float]:
        if not frame.count:
            msg = f"step {frame.step}: no grain in the box; nothing has an outline there"
            raise CaseError(msg)
        low = self.box.side("z", run)[0]
        across, z, radius = (frame.columns[name] for name in (self.plane[0], "z", "radius"))
        base = low if np.isfinite(low) else float((z - radius).min())
        pixel = 2.0 * float(np.median(radius)) / PIXELS_PER_DIAMETER
        return draw_silhouette(across, z - base, radius, pixel), base


def outline_of(shadow: Silhouette) -> FloatArray:
    """Return the upper outline of a silhouette (n, 2): position and height above its border [m]."""
    mask = heap_mask(shadow.image, dark_heap=True)
    rows = len(mask)
    columns = upper_outline(mask)
    base = rows - 1 - int(np.flatnonzero(mask.any(axis=1))[-1])  # empty rows below the grains
    outline = (columns + np.array([0.0, base])) * shadow.metres_per_pixel
    return np.asarray(outline + np.array([shadow.left_m, 0.0]), dtype=np.float64)
