"""Which things lie on the ground with the grains, and which on a ruler or another thing.

The ground is the largest flat part of the picture. A ruler, a label or a coin is another flat part,
divided from it by an edge.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import cv2
import numpy as np
import numpy.typing as npt

from liggghts_io.photo.grains.outlines import Outlines
from liggghts_io.photo.grains.separate import HALF
from liggghts_io.photo.light import FloatImage, Mask, blurred, slope_of

_SMOOTH: Final = 1.5  # px, before slopes are taken
_FLAT: Final = 0.02  # of the contrast, per px
_QUIET: Final = 4.0  # usual slopes of the ground's own noise
_LARGE: Final = 12.0  # areas of the usual grain: smaller parts are gaps between grains
_OTHER: Final = 0.05  # of the contrast: other brightness than the ground's
_BEYOND: Final = 3.5  # blurs from an outline to the flat ground
_ERODED: Final = 1.0  # px off the flat parts


def elsewhere(image: FloatImage, outlines: Outlines, diameter: float) -> Mask:
    """Return which things (n,) do not lie on the ground.

    Parameters
    ----------
    image : (rows, columns) float32
        0 on the ground, 1 in the grains.
    outlines : Outlines
    diameter : float
        Usual diameter [px].
    """
    labels, areas = _flat_parts(image)
    if not len(areas):
        return np.zeros(len(outlines.radii), dtype=bool)
    large = areas > _LARGE * 0.25 * np.pi * diameter**2
    main = int(np.argmax(areas))
    large[main] = False
    # A gap in a layer of grains that touch is as bright as the ground.
    inside = labels > 0
    total = np.bincount(labels[inside], weights=image[inside], minlength=len(areas) + 1)[1:]
    levels = total / areas
    large &= np.abs(levels - levels[main]) > _OTHER
    kind = np.zeros(len(areas) + 1, dtype=np.int8)
    kind[1:] = large
    kind[main + 1] = -1
    further = _BEYOND * float(np.hypot(outlines.blur, _SMOOTH)) + _ERODED
    points = replace(outlines, radii=outlines.radii + further).points()
    x, y = np.rint(np.moveaxis(points, -1, 0)).astype(np.int64)
    rows, columns = labels.shape
    seen = kind[labels[np.clip(y, 0, rows - 1), np.clip(x, 0, columns - 1)]]
    return np.asarray((seen > 0).sum(axis=1) > (seen < 0).sum(axis=1))


def _flat_parts(image: FloatImage) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.int64]]:
    """Return the flat parts of the ground, numbered from 1, and their areas [px^2]."""
    smooth = blurred(image, _SMOOTH)
    slope = slope_of(smooth)
    below = smooth < HALF
    if not below.any():
        return np.zeros(image.shape, dtype=np.int32), np.zeros(0, dtype=np.int64)
    limit = max(_FLAT, _QUIET * float(np.median(slope[below])))
    flat = cv2.erode((below & (slope < limit)).astype(np.uint8), np.ones((3, 3), np.uint8))
    count, labels, stats, _ = cv2.connectedComponentsWithStats(flat, connectivity=4)
    return np.asarray(labels, dtype=np.int32), stats[1:count, cv2.CC_STAT_AREA].astype(np.int64)
