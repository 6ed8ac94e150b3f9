"""How steep the edges of a heap are in a photograph."""

from __future__ import annotations

from typing import Final

import cv2
import numpy as np

from liggghts_io.photo.light import FloatArray, FloatImage, Mask, blurred, slope_of

_PLAIN: Final = 0.25  # of the wall beside the heap: between the lines of a pattern
_OVER_WALL: Final = 3.0  # steepness of a flank's edge over that of the plain wall
_EDGE_SMOOTH: Final = 1.5  # px


def is_wall(smooth: FloatImage, lines: FloatArray, wall: Mask) -> bool:
    """Tell whether a flank is hardly steeper than the wall: no edge, but a level of its light."""
    usual = float(np.quantile(_steep(smooth)[wall], _PLAIN)) if wall.any() else 0.0
    return any(steepness(smooth, line[None]) < _OVER_WALL * usual for line in lines)


def _steep(picture: FloatImage) -> FloatImage:
    """Return how steep a picture is near each pixel [1/px]."""
    steep = cv2.dilate(slope_of(blurred(picture, _EDGE_SMOOTH)), np.ones((5, 5), np.uint8))
    return np.asarray(steep, dtype=np.float32)


def steepness(picture: FloatImage, lines: FloatArray) -> float:
    """Return how steep a picture is along lines (k, 2, 2), the median [1/px]."""
    steep = _steep(picture)
    part = np.linspace(0.0, 1.0, 64)[:, None]
    points = np.concatenate([a * (1.0 - part) + b * part for a, b in lines])
    values = cv2.remap(
        steep, points[:, 0].astype(np.float32), points[:, 1].astype(np.float32), cv2.INTER_LINEAR
    )
    return float(np.median(values))
