"""How far from above a camera looked at a heap: the foot of a cone is a circle, seen as an ellipse.

From above a cone looks flatter than it is: at an elevation e of the camera its flanks have the
slope sqrt(tan(a)^2 cos(e)^2 - sin(e)^2) instead of tan(a), to the eye as straight as ever.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import cv2
import numpy as np
import numpy.typing as npt

from liggghts_io.photo.light import FloatArray

_WORK_SIDE: Final = 800  # px: edges are as wide as their blur then
_BLUR: Final = 2.0  # px
_OFF: Final = 3.0  # px on both sides of the edge
# Of the foot, over that of its flanks, which were measured from a fifth of the height on: 1.25
# where they end at the plate, more where its far edge passes behind the heap.
_WIDTHS: Final = np.geomspace(1.2, 4.0, 60)
_SINES: Final = np.arange(0.06, 0.62, 0.02)  # of elevations
_ROUND: Final = np.radians(75.0)  # of the front half of the foot to each side
_SEGMENTS: Final = 15
_POINTS: Final = 6  # in each
_MOST: Final = 0.2  # quantile: so many segments may show something else, such as a shadow
_LEAST: Final = 8.0  # grey levels across the foot's edge


class Above(NamedTuple):
    """How a camera looked down on a heap.

    Attributes
    ----------
    elevation_deg : float
        Of the camera above the plate, seen from the heap [deg].
    flatter_deg : float
        By which the heap's angle is too small for that [deg].
    """

    elevation_deg: float
    flatter_deg: float


def seen_from_above(colour: npt.NDArray[np.uint8], lines: FloatArray, tilt: float) -> Above | None:
    """Return how far from above a heap was photographed, None where no round foot is seen.

    Parameters
    ----------
    colour : (rows, columns, 3) uint8
    lines : (k, 2, 2) float64
        Flanks: flank, end, column and row [px]; of one flank alone nothing is said.
    tilt : float
        Rows per column of what is level.
    """
    if len(lines) != 2:
        return None
    shrink = max(1.0, max(colour.shape[:2]) / _WORK_SIDE)
    size = (round(colour.shape[1] / shrink), round(colour.shape[0] / shrink))
    small = cv2.GaussianBlur(
        cv2.resize(colour, size, interpolation=cv2.INTER_AREA), (0, 0), _BLUR
    ).astype(np.float32)
    way = np.array([1.0, tilt]) / np.hypot(1.0, tilt)
    turn = np.array([way, [-way[1], way[0]]])  # to the right, and down
    (x1, y1), (x2, y2) = turn @ (lines[0] / shrink).T, turn @ (lines[1] / shrink).T
    # Each flank as a line, down over right.
    rise, fall = np.polyfit(x1, y1, 1), np.polyfit(x2, y2, 1)
    top = (fall[1] - rise[1]) / (rise[0] - fall[0])
    apex = np.array([top, np.polyval(rise, top)])
    slope = 0.5 * float(fall[0] - rise[0])
    half = 0.5 * float(max(x1.max(), x2.max()) - min(x1.min(), x2.min()))
    best, found = _LEAST, 0.0
    for width in _WIDTHS * half:
        for sine in _SINES:
            clear = _clear(small, turn, apex, slope, width, sine)
            if clear > best:
                best, found = clear, float(sine)
    if not found:
        return None
    true = np.arctan(np.sqrt((slope**2 + found**2) / (1.0 - found**2)))
    return Above(float(np.degrees(np.arcsin(found))), float(np.degrees(true - np.arctan(slope))))


def _clear(
    picture: npt.NDArray[np.float32],
    turn: FloatArray,
    apex: FloatArray,
    slope: float,
    width: float,
    sine: float,
) -> float:
    """Return how clear an edge is along the front of a foot, in most of its parts [grey levels]."""
    around = np.linspace(-_ROUND, _ROUND, _SEGMENTS * _POINTS)
    deep = sine * width
    x = apex[0] + width * np.sin(around)
    y = apex[1] + np.hypot(slope * width, deep) + deep * np.cos(around)
    normal = np.stack([deep * np.sin(around), width * np.cos(around)])
    normal *= _OFF / np.linalg.norm(normal, axis=0)
    inner, outer = (
        (turn.T @ (np.stack([x, y]) + side * normal)).astype(np.float32) for side in (-1.0, 1.0)
    )
    rows, columns = picture.shape[:2]
    if outer[1].max() >= rows or outer[0].min() < 0.0 or outer[0].max() >= columns:
        return 0.0
    levels = [
        cv2.remap(picture, one[None, 0], one[None, 1], cv2.INTER_LINEAR)[0]
        for one in (inner, outer)
    ]
    step = (levels[1] - levels[0]).reshape(_SEGMENTS, _POINTS, -1).mean(axis=1)
    low, high = np.quantile(step, (_MOST, 1.0 - _MOST), axis=0)
    return float(max(low.max(), -high.min()))
