"""Regions of a photograph that may be a heap: what differs from the light of the background."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

import cv2
import numpy as np
import numpy.typing as npt

from liggghts_io.photo.light import FloatArray, FloatImage, Mask, blurred, surface

_LEAST_CONTRAST: Final = 12.0  # grey levels
_LEAST_CLEAR: Final = 1.5  # contrast over the scatter of the ground
_LEAST_APART: Final = 3.0  # the same of two parts of what stands out over their own
_SMALLEST: Final = 0.004  # of the picture: area of a heap
_CLASSES: Final = 24  # grey levels that are tried as thresholds between three kinds of things
_OF_ALL: Final = 0.15  # of all that stands out: area of a heap; a pattern has many parts
_AWAY: Final = 13  # px around an edge that are neither inside nor outside
_POINTS: Final = 20_000
_SAMPLE: Final = 400  # points of the borders that a plane is held against
_PLANES: Final = 600  # planes through three of them
_APART: Final = 6.0  # median deviations beyond which a point is something else
_EDGE: Final = 1.5  # of that: what is as far off within some pixels is behind an edge
_LEAST_LIT: Final = 0.3  # of the usual light, anywhere
_FEW: Final = 200
_LARGEST: Final = 3  # regions of each kind
_STREAM: Final = 0.04  # of the picture: width of grains that fall on a heap, at most


@dataclass(frozen=True)
class Candidate:
    """What may be a heap.

    Attributes
    ----------
    smooth : (rows, columns) float32
        Grey levels without noise.
    light : (rows, columns) float32
        Half at its edge, 0 in the background.
    mask : (rows, columns) bool
        Where it is, without holes.
    contrast : float
        Of its edges at least, over that of what stands out from the background; 1 for the whole of
        that, less for a part, as of a heap beside its shadow.
    """

    smooth: FloatImage
    light: FloatImage
    mask: Mask
    contrast: float = 1.0

    @property
    def whole(self) -> bool:
        """Whether it is all that stands out in its place."""
        return self.contrast == 1.0


def candidates(grey: FloatImage, order: int) -> Iterator[Candidate]:
    """Yield what may be a heap.

    Parameters
    ----------
    grey : (rows, columns) float32
        Grey levels.
    order : int
        Highest power of the surface that the background's light is taken to be.
    """
    smooth = blurred(np.asarray(cv2.medianBlur(grey, 3), dtype=np.float32), _quiet(grey))
    background = _background(smooth, order)
    level = smooth - background
    for sign in (-1.0, 1.0):
        values = np.clip(sign * level, 0.0, None)
        for low, high in _thresholds(values):
            scatter = float(np.std(level[sign * level < low]))
            if high < _LEAST_CONTRAST or high < _LEAST_CLEAR * scatter:
                continue
            light = np.asarray(values / (2.0 * low), dtype=np.float32)
            for region in _regions(values > low):
                yield Candidate(smooth, light, region)
                for part, contrast in _parts(values, region):
                    yield Candidate(smooth, light, part, contrast)


def _quiet(grey: FloatImage) -> float:
    """Return how much a picture is smoothed, by its noise [px]."""
    fine = grey - blurred(grey, 1.0)
    noise = 1.4826 * float(np.median(np.abs(fine)))
    return float(np.clip(0.25 * noise, 0.6, 2.5))


def _background(smooth: FloatImage, order: int) -> FloatImage:
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
    return planes[best], max(_LEAST_CONTRAST, _APART * float(middle[best]))


def _thresholds(values: FloatImage) -> list[tuple[float, float]]:
    """Return thresholds between two and between three kinds of things, and the level above each."""
    top = float(np.percentile(values, 99.5))
    if top < _LEAST_CONTRAST:
        return []
    counts, edges = np.histogram(np.minimum(values, top), bins=_CLASSES, range=(0.0, top))
    middle = 0.5 * (edges[1:] + edges[:-1])
    n, total = np.cumsum(counts).astype(np.float64), np.cumsum(counts * middle)

    def between(i: int, j: int) -> float:
        """Return the weight of the bins i to j times the square of their mean."""
        first = i > 0
        weight = n[j] - (n[i - 1] if first else 0.0)
        mean = (total[j] - (total[i - 1] if first else 0.0)) / max(weight, 1.0)
        return float(weight * mean**2)

    last = _CLASSES - 1
    two = max(range(last), key=lambda i: between(0, i) + between(i + 1, last))
    three = max(
        ((i, j) for i in range(last - 1) for j in range(i + 1, last)),
        key=lambda one: (
            between(0, one[0]) + between(one[0] + 1, one[1]) + between(one[1] + 1, last)
        ),
    )
    cuts = dict.fromkeys((two, *three))
    return [(float(edges[cut + 1]), float(values[values > edges[cut + 1]].mean())) for cut in cuts]


def _parts(values: FloatImage, region: Mask) -> Iterator[tuple[Mask, float]]:
    """Yield the parts of a region of two kinds of things, such as a heap and its shadow.

    With each goes the contrast between them, over that of the stronger one to the background.
    """
    own = values[region]
    cut, _ = cv2.threshold(own.astype(np.uint8), 0, 255, cv2.THRESH_BINARY | cv2.THRESH_OTSU)
    upper = own > cut
    if not 0 < upper.sum() < len(own):
        return
    apart = float(own[upper].mean() - own[~upper].mean())
    scatter = float(np.sqrt(np.mean([own[upper].var(), own[~upper].var()])))
    if apart < _LEAST_CONTRAST or apart < _LEAST_APART * scatter:
        return
    contrast = apart / float(own[upper].mean())
    for part in (values > cut, values <= cut):
        yield from ((one, contrast) for one in _regions(part & region))


def _regions(mask: Mask) -> Iterator[Mask]:
    """Yield the large regions of a mask, filled, without what hangs from the upper border.

    A heap that a stream of grains joins to its funnel is cut off where it gets wide.
    """
    closed = cv2.morphologyEx(mask.astype(np.uint8), cv2.MORPH_CLOSE, np.ones((3, 3), np.uint8))
    opened = cv2.morphologyEx(closed, cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))
    for region in _largest(opened):
        outer, _ = cv2.findContours(region, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
        filled = cv2.drawContours(region, outer, -1, 1, cv2.FILLED)
        standing = _below_its_stream(filled) if filled[0].any() else filled
        if standing is not None:
            yield standing.astype(bool)


def _largest(bits: npt.NDArray[Any]) -> Iterator[npt.NDArray[np.uint8]]:
    """Yield the connected regions that may be a heap by their area, the largest first."""
    count, labels, stats, _ = cv2.connectedComponentsWithStats(bits, connectivity=8)
    areas = stats[:count, cv2.CC_STAT_AREA].copy()
    areas[0] = 0
    for which in np.argsort(-areas)[:_LARGEST]:
        if areas[which] >= max(_SMALLEST * bits.size, _OF_ALL * areas.sum()):
            yield (labels == which).astype(np.uint8)


def _below_its_stream(region: npt.NDArray[Any]) -> npt.NDArray[np.uint8] | None:
    """Return the part of a region below a neck as narrow as a stream, None where it has none."""
    side = max(3, round(_STREAM * region.shape[1])) | 1
    round_bits = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (side, side))
    # Outside the picture is taken for the same as its border, so that nothing is narrow there.
    wide = cv2.morphologyEx(
        cv2.copyMakeBorder(region, side, side, side, side, cv2.BORDER_REPLICATE),
        cv2.MORPH_OPEN,
        round_bits,
    )[side:-side, side:-side]
    for part in _largest(wide):
        if not part[0].any():
            below = region.copy()
            below[: int(np.argmax(part.any(axis=1)))] = 0
            _, labels = cv2.connectedComponents(below, connectivity=8)
            return np.asarray(labels == labels[part > 0][0], dtype=np.uint8)
    return None


def relit(smooth: FloatImage, region: Mask, above: Mask) -> FloatImage | None:
    """Return the picture as 0 in the background and 1 in a region, whatever lights them.

    Parameters
    ----------
    smooth : (rows, columns) float32
        Grey levels.
    region : (rows, columns) bool
        What stands out, to a few pixels.
    above : (rows, columns) bool
        Above the plate.

    Returns
    -------
    (rows, columns) float32 or None
        None where light and region cannot be told apart.
    """
    bits, square = region.astype(np.uint8), np.ones((_AWAY, _AWAY), np.uint8)
    y, x = np.nonzero((cv2.dilate(bits, square) == 0) & above)
    inside = (cv2.erode(bits, square) > 0) & above
    if len(y) < _FEW or inside.sum() < _FEW:
        return None
    step = max(1, len(y) // _POINTS)
    y, x = y[::step], x[::step]
    background = surface(x, y, smooth[y, x].astype(np.float64), smooth.shape, 2)
    usual = float(np.median(background[inside]))
    contrast = float(np.median(smooth[inside])) - usual
    if abs(contrast) < 0.5 * _LEAST_CONTRAST:
        return None
    # One light falls on both; a direction in colour has no level at which there is no light.
    lit = background / max(usual, 1.0)
    depth = contrast * (lit if lit.min() > _LEAST_LIT else np.ones_like(lit))
    return np.asarray((smooth - background) / depth, dtype=np.float32)
