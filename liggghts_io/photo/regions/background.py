"""The light of a photograph's background, taken from the borders where no heap is."""

from __future__ import annotations

from typing import Final

import cv2
import numpy as np
import numpy.typing as npt

from liggghts_io.photo.light import FloatArray, FloatImage, Mask, blurred, surface

LEAST_CONTRAST: Final = 12.0
"""Grey levels by which something differs from the background at least."""

_AWAY: Final = 13  # px around an edge that are neither inside nor outside
_POINTS: Final = 20_000
_SAMPLE: Final = 400  # points of the borders that a plane is held against
_PLANES: Final = 600  # planes through three of them
_APART: Final = 6.0  # median deviations beyond which a point is something else
_EDGE: Final = 1.5  # of that: what is as far off within some pixels is behind an edge


def quiet(grey: FloatImage) -> float:
    """Return how much a picture is smoothed, by its noise [px]."""
    fine = grey - blurred(grey, 1.0)
    noise = 1.4826 * float(np.median(np.abs(fine)))
    return float(np.clip(0.25 * noise, 0.6, 2.5))


def background_of(smooth: FloatImage, order: int) -> FloatImage:
    """Return the light of the background, from the upper and the side borders.

    What else hangs or stands there, such as a post, may cover less than half of them.
    """
    rows, columns = smooth.shape
    strip = np.zeros(smooth.shape, dtype=bool)
    strip[: max(2, rows // 12)] = True
    side = max(2, columns // 30)
    strip[: rows // 2, :side] = strip[: rows // 2, -side:] = True
    bare = strip & ~_things(smooth, strip)
    y, x = np.nonzero(bare if bare.any() else strip)
    step = max(1, len(y) // _POINTS)
    y, x = y[::step], x[::step]
    return surface(x, y, smooth[y, x].astype(np.float64), smooth.shape, order)


def _things(smooth: FloatImage, strip: Mask) -> Mask:
    """Return the parts of the borders that an edge divides from the plane of most of them.

    Without an edge it is the light that is uneven: it is near the plane where such a part begins.
    """
    y, x = np.nonzero(strip)
    off = np.zeros(smooth.shape, dtype=np.float32)
    plane, near = _plane_of_most(x, y, smooth[y, x].astype(np.float64))
    off[y, x] = np.abs(plane[0] + plane[1] * x + plane[2] * y - smooth[y, x])
    apart = (off >= near).astype(np.uint8)
    square = np.ones((_AWAY, _AWAY), np.uint8)
    rim = (apart > 0) & (cv2.dilate((strip & (off < near)).astype(np.uint8), square) > 0)
    count, labels, boxes, _ = cv2.connectedComponentsWithStats(apart, connectivity=8)
    things = np.zeros_like(apart)
    for which in range(1, count):
        left, top, width, height = boxes[which, : cv2.CC_STAT_AREA]
        there = np.s_[top : top + height, left : left + width]
        part = labels[there] == which
        begins = off[there][part & rim[there]]
        if len(begins) and float(np.median(begins)) > _EDGE * near:
            things[there][part] = 1
    return np.asarray(cv2.dilate(things, square) > 0)


def _plane_of_most(
    x: npt.NDArray[np.int64], y: npt.NDArray[np.int64], z: FloatArray
) -> tuple[FloatArray, float]:
    """Return the plane with the least median of distances, and how far from it a point may lie.

    Of planes through three of the points: none is moved by what stands apart, wherever and however
    far, as long as that is less than half.

    Returns
    -------
    (3,) float64
        Its value at (0, 0), and how much it gains per column and per row.
    float
        [grey levels]
    """
    few = np.linspace(0, len(z) - 1, min(_SAMPLE, len(z))).astype(np.int64)
    terms = np.stack([np.ones(len(few)), x[few], y[few]], axis=-1)
    triples = np.random.default_rng(0).integers(len(few), size=(_PLANES, 3))
    wide = np.abs(np.linalg.det(terms[triples])) > np.ptp(x) * np.ptp(y) / _SAMPLE
    planes = np.linalg.solve(terms[triples[wide]], z[few][triples[wide]][..., None])[..., 0]
    middle = np.median(np.abs(planes @ terms.T - z[few]), axis=1)
    best = int(np.argmin(middle))
    return planes[best], max(LEAST_CONTRAST, _APART * float(middle[best]))
