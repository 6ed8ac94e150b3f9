"""Which things lie on the ground with the grains, and which on a ruler or another thing.

The ground is the largest flat part of the picture. A ruler, a label or a coin is another flat part,
divided from it by an edge. What is on the ground and was not found has another colour than grains.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import cv2
import numpy as np
import numpy.typing as npt

from liggghts_io.photo.grains.outlines import Outlines
from liggghts_io.photo.grains.separate import HALF
from liggghts_io.photo.light import FloatArray, FloatImage, Mask, blurred, slope_of, surface

_SMOOTH: Final = 1.5  # px, before slopes are taken
_FLAT: Final = 0.02  # of the contrast, per px
_QUIET: Final = 4.0  # usual slopes of the ground's own noise
_LARGE: Final = 12.0  # areas of the usual grain: smaller parts are gaps between grains
_OTHER: Final = 0.05  # of the contrast: other brightness than the ground's
_BEYOND: Final = 3.5  # blurs from an outline to the flat ground
_ERODED: Final = 1.0  # px off the flat parts

_ACROSS: Final = 24.0  # px across a grain, where others are looked for
_BESIDE: Final = 0.35  # of a diameter beside what was found: its shadow
_CLEAR: Final = 6.0  # scatters of the ground's colours, from which something is none of it
_LEAST: Final = 10.0  # grey levels
_ALIKE: Final = (0.5, 1.8)  # of the usual diameter
_ROUND: Final = 0.45  # of the circle around it
_POINTS: Final = 20_000
_MAD: Final = 1.4826


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


def overlooked(colour: npt.NDArray[np.uint8], outlines: FloatArray, diameter: float) -> int:
    """Return how many things as large as grains lie on the ground beside all that was found.

    Parameters
    ----------
    colour : (rows, columns, 3) uint8
    outlines : (n, k, 2) float64
        Of all that was found, whether it counts or not [px].
    diameter : float
        Usual diameter [px].
    """
    zoom = min(1.0, _ACROSS / diameter)
    size = (round(colour.shape[1] * zoom), round(colour.shape[0] * zoom))
    small = cv2.resize(colour, size, interpolation=cv2.INTER_AREA).astype(np.float32)
    found = np.zeros(small.shape[:2], dtype=np.uint8)
    for one in np.round(outlines * zoom).astype(np.int32):
        cv2.fillPoly(found, [one], 1)
    reach = max(1, round(_BESIDE * diameter * zoom))
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * reach + 1, 2 * reach + 1))
    free = cv2.dilate(found, disc) == 0
    if not free.any():
        return 0
    off = _off_ground(small, free)
    scatter = _MAD * float(np.median(off[free]))
    things = (free & (off > max(_CLEAR * scatter, _LEAST))).astype(np.uint8)
    things = cv2.morphologyEx(things, cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))
    rims, _ = cv2.findContours(things, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    return sum(_as_grain(rim, diameter * zoom, small.shape) for rim in rims)


def _off_ground(small: FloatImage, free: Mask) -> FloatImage:
    """Return by how much each place of a picture (rows, columns, 3) differs from its ground."""
    y, x = np.nonzero(free)
    step = max(1, len(y) // _POINTS)
    y, x = y[::step], x[::step]
    parts = []
    for k in range(3):
        smooth = blurred(np.ascontiguousarray(small[:, :, k]), 1.0)
        ground = surface(x, y, smooth[y, x].astype(np.float64), smooth.shape, 4)
        parts.append((smooth - ground) ** 2)
    return np.asarray(np.sqrt(np.sum(parts, axis=0)), dtype=np.float32)


def _as_grain(rim: cv2.typing.MatLike, diameter: float, shape: tuple[int, ...]) -> bool:
    """Whether a thing is about as large and as round as grains, and whole in the picture."""
    left, top, wide, tall = cv2.boundingRect(rim)
    if not (left > 0 and top > 0 and left + wide < shape[1] and top + tall < shape[0]):
        return False
    area = cv2.contourArea(rim) + 0.5 * len(rim)
    alike = _ALIKE[0] < 2.0 * float(np.sqrt(area / np.pi)) / diameter < _ALIKE[1]
    radius = cv2.minEnclosingCircle(rim)[1] + 0.5
    return bool(alike and area > _ROUND * np.pi * radius**2)
