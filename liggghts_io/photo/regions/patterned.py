"""What has a colour that a patterned wall has nowhere: a heap before tiles or bricks.

No surface of light follows tiles and their joints, but both have few colours, and mixtures of these
where they are blurred. Those of the borders, where no heap is, are noted; then each place of the
picture differs from the wall by as much as its colour does from the nearest of these.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import cv2
import numpy as np
import numpy.typing as npt
from scipy.ndimage import distance_transform_edt

from liggghts_io.photo.light import FloatImage, Mask, blurred, surface
from liggghts_io.photo.regions.levels import Candidate, regions

_BLURS: Final = (0.0015, 0.004)  # of the picture's longer side: grains, and joints of bricks
_STEP: Final = 4  # grey levels of a cell of colours
_CELLS: Final = 256 // _STEP
_BLOCKS: Final = 16  # of the borders, each second of which is held against the others
_MOST_OF_WALL: Final = 0.98  # quantile
_LEAST: Final = 8.0  # grey levels
_TRIED: Final = (1.0, 2.0)  # of what nearly all of the wall differs by
_OTSU: Final = 255.0
_POINTS: Final = 20_000
_ORDER: Final = 2  # of the surface that the lamp's light on the wall is taken to be


def patterned_candidates(colour: npt.NDArray[np.uint8]) -> Iterator[Candidate]:
    """Yield what may be a heap before a wall of several colours.

    Parameters
    ----------
    colour : (rows, columns, 3) uint8
    """
    even = _evenly_lit(colour)
    strip = _strip(colour.shape[:2])
    for blur in _BLURS:
        smooth = blurred(even, max(1.0, blur * max(colour.shape)))
        off, usual = _unlike(smooth, strip)
        least = max(_LEAST, usual)
        levels = {times * least for times in _TRIED}
        bits = np.clip(off, 0.0, _OTSU).astype(np.uint8)
        levels.add(max(least, float(cv2.threshold(bits, 0, 255, cv2.THRESH_OTSU)[0])))
        for level in sorted(levels):
            light = np.asarray(off / np.float32(2.0 * level), dtype=np.float32)
            for region in regions(off > level):
                yield Candidate(off, light, region, levelled=True)


def _strip(shape: tuple[int, ...]) -> Mask:
    """Return the upper border and those beside the upper half."""
    rows, columns = shape
    strip = np.zeros(shape, dtype=bool)
    strip[: max(2, rows // 10)] = True
    side = max(2, columns // 20)
    strip[: rows // 2, :side] = strip[: rows // 2, -side:] = True
    return strip


def _evenly_lit(colour: npt.NDArray[np.uint8]) -> FloatImage:
    """Return a picture (rows, columns, 3) as if one light fell on all of its wall."""
    plain = cv2.medianBlur(colour, 3).astype(np.float32)
    grey = np.asarray(plain.mean(axis=2), dtype=np.float32)
    y, x = np.nonzero(_strip(grey.shape))
    step = max(1, len(y) // _POINTS)
    y, x = y[::step], x[::step]
    lamp = surface(x, y, grey[y, x].astype(np.float64), grey.shape, _ORDER)
    usual = float(np.median(lamp[y, x]))
    lit = np.clip(lamp / max(usual, 1.0), 0.5, 2.0)
    return np.asarray(np.clip(plain / lit[:, :, None], 0.0, 255.0), dtype=np.float32)


def _unlike(smooth: FloatImage, strip: Mask) -> tuple[FloatImage, float]:
    """Return by how much each place differs from the wall, and by how much nearly all of that does.

    Parameters
    ----------
    smooth : (rows, columns, 3) float32
    strip : (rows, columns) bool
        Where the wall is.
    """
    cells = np.minimum(smooth.astype(np.int32) // _STEP, _CELLS - 1)
    rows, columns = strip.shape
    y, x = np.mgrid[:rows, :columns]
    block = (y * _BLOCKS // max(rows, columns) + x * _BLOCKS // max(rows, columns)) % 2
    usual = max(
        float(np.quantile(_away(cells[strip & (block == k)])[tuple(cells[strip & (block != k)].T)],
                          _MOST_OF_WALL))
        for k in (0, 1)
    )  # fmt: skip
    off = _away(cells[strip])[tuple(np.moveaxis(cells, -1, 0))]
    return blurred(np.asarray(off, dtype=np.float32), 1.0), usual


def _away(cells: npt.NDArray[np.int32]) -> npt.NDArray[np.float64]:
    """Return the distance of all colours from those of some cells (n, 3) [grey levels]."""
    free = np.ones((_CELLS,) * 3, dtype=bool)
    free[tuple(cells.T)] = False
    return np.asarray(distance_transform_edt(free, sampling=_STEP))
