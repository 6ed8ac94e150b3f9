"""Sheets, dishes and tables in a photograph: each flat part of it may be what the grains lie on.

Where a bench is seen around a dish, or a ruler lies among the grains, the steepest edges of the
picture are not those of grains. Then every large flat part is tried as the ground, and what lies
around it is painted over.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import cv2
import numpy as np

from liggghts_io.photo.light import FloatImage, Polarity, blurred, slope_of, surface

_SMOOTH: Final = 1.5  # px, before slopes are taken
_FLAT: Final = 1.0  # grey levels per px
_QUIET: Final = 4.0  # usual slopes: noise
_LEAST: Final = 0.05  # of the picture: area of a sheet
_MOST_SHEETS: Final = 3
_POINTS: Final = 20_000
_CLEAR: Final = 6.0  # scatters of a sheet beyond which something lies on it
_SCATTER: Final = 1.0  # grey levels, at least
_MAD: Final = 1.4826
_FEW: Final = 30  # pixels of something


def sheets(grey: FloatImage, polarity: Polarity) -> Iterator[tuple[FloatImage, FloatImage]]:
    """Yield for each sheet the picture without its surroundings, and half levels on it.

    Parameters
    ----------
    grey : (rows, columns) float32
        Grey levels.
    polarity : str
        Whether grains are "dark" or "bright".
    """
    smooth = blurred(grey, _SMOOTH)
    slope = slope_of(smooth)
    limit = max(_FLAT, _QUIET * float(np.median(slope)))
    flat = cv2.erode((slope < limit).astype(np.uint8), np.ones((3, 3), np.uint8))
    count, labels, stats, _ = cv2.connectedComponentsWithStats(flat, connectivity=4)
    areas = stats[:count, cv2.CC_STAT_AREA].copy()
    areas[0] = 0
    sign = 1.0 if polarity == "bright" else -1.0
    for which in np.argsort(-areas)[:_MOST_SHEETS]:
        if areas[which] < _LEAST * grey.size:
            return
        sheet = (labels == which).astype(np.uint8)
        y, x = np.nonzero(sheet)
        step = max(1, len(y) // _POINTS)
        y, x = y[::step], x[::step]
        ground = surface(x, y, smooth[y, x].astype(np.float64), grey.shape, 2)
        outer, _ = cv2.findContours(sheet, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
        inside = cv2.drawContours(sheet, outer, -1, 1, cv2.FILLED).astype(bool)
        over = sign * (smooth - ground)
        scatter = _MAD * float(np.median(np.abs(over[y, x])))
        stands = inside & (over > _CLEAR * max(scatter, _SCATTER)) & (slope < limit)
        if stands.sum() >= _FEW:
            half = ground + np.float32(0.5 * sign * np.median(over[stands]))
            yield np.where(inside, grey, ground), half
