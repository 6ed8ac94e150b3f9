"""What is unlike the wall behind a heap, whether brighter or darker or of another colour.

A lamp at the side makes one flank of a heap bright and leaves the other in its own shadow, as
bright as the wall perhaps. No level of light parts such a heap from the wall, but its grains do:
their own light and shadow differ from the even wall, whatever their mean. So first the wall is
followed from the borders as far as it is even, then its light is known up to the heap, and what
differs from that in either way is no wall.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import cv2
import numpy as np
import numpy.typing as npt

from liggghts_io.photo.light import FloatArray, FloatImage, Mask, blurred, slope_of, surface
from liggghts_io.photo.regions.background import quiet
from liggghts_io.photo.regions.levels import Candidate, regions

_WINDOW: Final = 2.5  # px, within which differences are averaged
_UNEVEN: Final = 3.0  # usual steepness of the borders, where the wall ends
_LEAST_STEEP: Final = 0.4  # grey levels per px, the same on a wall without noise
_EDGE_SMOOTH: Final = 1.0  # px
_LEAST_SIDE: Final = 0.1  # of the sides: a part of the wall that reaches them
_LEAST_WALL: Final = 0.05  # of the picture
_ORDER: Final = 4  # of the surface that the wall's light is taken to be
_POINTS: Final = 20_000
_MOST_OF_WALL: Final = 0.98  # quantile
_CLEAR: Final = 1.5  # over what nearly all of the wall differs by
_LEAST: Final = 4.0  # grey levels
_TRIED: Final = (1.0, 2.0)  # of that


def unlike_candidates(colour: npt.NDArray[np.uint8]) -> Iterator[Candidate]:
    """Yield what may be a heap that is both brighter and darker than the wall.

    Parameters
    ----------
    colour : (rows, columns, 3) uint8
    """
    smooth = [_smooth(colour[:, :, k]) for k in range(3)]
    steep = _mean_square([slope_of(blurred(one, _EDGE_SMOOTH)) for one in smooth])
    wall, uneven = _wall(steep)
    if wall.mean() < _LEAST_WALL:
        return
    off = _mean_square([one - _light(one, wall) for one in smooth])
    least = max(_CLEAR * float(np.quantile(off[wall][::16], _MOST_OF_WALL)), _LEAST)
    for times in _TRIED:
        yield from _above(off, off > times * least, times * least)
    yield from _above(_WINDOW * steep, ~wall, _WINDOW * uneven)


def _above(picture: FloatImage, mask: Mask, level: float) -> Iterator[Candidate]:
    light = np.asarray(picture / (2.0 * level), dtype=np.float32)
    for region in regions(mask):
        yield Candidate(picture, light, region, levelled=True)


def _smooth(channel: npt.NDArray[np.uint8]) -> FloatImage:
    grey = channel.astype(np.float32)
    return blurred(np.asarray(cv2.medianBlur(grey, 3), dtype=np.float32), quiet(grey))


def _mean_square(parts: list[FloatImage]) -> FloatImage:
    """Return the root of the mean square of some pictures, near each pixel."""
    mean = np.mean([one**2 for one in parts], axis=0, dtype=np.float32)
    return np.asarray(np.sqrt(blurred(np.asarray(mean), _WINDOW)), dtype=np.float32)


def _wall(steep: FloatImage) -> tuple[Mask, float]:
    """Return what is reached from both side borders without crossing an edge, and what is one.

    Parameters
    ----------
    steep : (rows, columns) float32
        Steepness of the picture [grey levels per px].
    """
    rows, columns = steep.shape
    side, upper = max(2, columns // 30), rows // 2
    ends = np.zeros(steep.shape, dtype=bool)
    ends[:upper, :side] = ends[:upper, -side:] = True
    uneven = max(_UNEVEN * float(np.median(steep[ends])), _LEAST_STEEP)
    even = steep < uneven
    _, labels = cv2.connectedComponents(even.astype(np.uint8), connectivity=4)
    counts = np.bincount(labels[ends & even].ravel(), minlength=labels.max() + 1)
    reached = np.flatnonzero(counts > _LEAST_SIDE * ends.sum())
    return np.asarray(np.isin(labels, reached[reached > 0])), uneven


def _light(smooth: FloatImage, wall: Mask) -> FloatImage:
    """Return the light of the wall, everywhere."""
    y, x = np.nonzero(wall)
    step = max(1, len(y) // _POINTS)
    y, x = y[::step], x[::step]
    values: FloatArray = smooth[y, x].astype(np.float64)
    return surface(x, y, values, smooth.shape, _ORDER)
