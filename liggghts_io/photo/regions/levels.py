"""Regions of a photograph that may be a heap: what differs from the light of the background."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

import cv2
import numpy as np
import numpy.typing as npt

from liggghts_io.photo.light import FloatImage, Mask, blurred, surface
from liggghts_io.photo.regions.background import LEAST_CONTRAST, background_of, quiet

_LEAST_CLEAR: Final = 1.5  # contrast over the scatter of the ground
_LEAST_APART: Final = 3.0  # the same of two parts of what stands out over their own
_SMALLEST: Final = 0.004  # of the picture: area of a heap
_CLASSES: Final = 24  # grey levels that are tried as thresholds between three kinds of things
_OF_ALL: Final = 0.15  # of all that stands out: area of a heap; a pattern has many parts
_AWAY: Final = 13  # px around an edge that are neither inside nor outside
_POINTS: Final = 20_000
_LEAST_LIT: Final = 0.3  # of the usual light, anywhere
_FEW: Final = 200
_LARGEST: Final = 3  # regions of each kind
_NECK: Final = 0.6  # of the greatest width below it: tip of a funnel
_TIP: Final = 1.15  # its width, over the least one, as far as it goes
_RIM: Final = 4  # px below it that its blur reaches
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
    levelled : bool
        Whether `light` is final: no one contrast parts the whole of it from the background.
    """

    smooth: FloatImage
    light: FloatImage
    mask: Mask
    contrast: float = 1.0
    levelled: bool = False

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
    smooth = blurred(np.asarray(cv2.medianBlur(grey, 3), dtype=np.float32), quiet(grey))
    background = background_of(smooth, order)
    level = smooth - background
    for sign in (-1.0, 1.0):
        values = np.clip(sign * level, 0.0, None)
        for low, high in _thresholds(values):
            scatter = float(np.std(level[sign * level < low]))
            if high < LEAST_CONTRAST or high < _LEAST_CLEAR * scatter:
                continue
            light = np.asarray(values / (2.0 * low), dtype=np.float32)
            for region in regions(values > low):
                yield Candidate(smooth, light, region)
                for part, contrast in _parts(values, region):
                    yield Candidate(smooth, light, part, contrast)


def _thresholds(values: FloatImage) -> list[tuple[float, float]]:
    """Return thresholds between two and between three kinds of things, and the level above each."""
    top = float(np.percentile(values, 99.5))
    if top < LEAST_CONTRAST:
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
    if apart < LEAST_CONTRAST or apart < _LEAST_APART * scatter:
        return
    contrast = apart / float(own[upper].mean())
    for part in (values > cut, values <= cut):
        yield from ((one, contrast) for one in regions(part & region))


def regions(mask: Mask) -> Iterator[Mask]:
    """Yield the large regions of a mask, filled, without what hangs from the upper border.

    A heap that a stream of grains joins to its funnel is cut off where it gets wide.
    """
    closed = cv2.morphologyEx(mask.astype(np.uint8), cv2.MORPH_CLOSE, np.ones((3, 3), np.uint8))
    opened = cv2.morphologyEx(closed, cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))
    for region in _largest(opened):
        outer, _ = cv2.findContours(region, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
        filled = cv2.drawContours(region, outer, -1, 1, cv2.FILLED)
        standing: npt.NDArray[Any] | None = filled
        if filled[0].any():
            standing = _below_its_stream(filled)
            standing = _below_its_neck(filled) if standing is None else standing
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


def _below_its_neck(region: npt.NDArray[Any]) -> npt.NDArray[np.uint8] | None:
    """Return the part of a region below its narrowest place, None where it has none.

    So a heap is parted from a funnel that hangs into its top, however wide that is. What reaches a
    side border, too, is no funnel but the wall beside one.
    """
    widths = region.sum(axis=1)
    widest = int(np.argmax(widths))
    if not widest or widths[:widest].min() > _NECK * widths[widest]:
        return None
    narrow = np.flatnonzero(widths[:widest] <= _TIP * widths[:widest].min())
    end = int(narrow[-1]) + _RIM
    if region[:end, [0, -1]].any():
        return None
    below = region.copy()
    below[:end] = 0
    return next(_largest(below), None)


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
    if abs(contrast) < 0.5 * LEAST_CONTRAST:
        return None
    # One light falls on both; a direction in colour has no level at which there is no light.
    lit = background / max(usual, 1.0)
    depth = contrast * (lit if lit.min() > _LEAST_LIT else np.ones_like(lit))
    return np.asarray((smooth - background) / depth, dtype=np.float32)
