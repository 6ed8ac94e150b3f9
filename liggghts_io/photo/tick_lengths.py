"""Whether the ticks of a ruler are its finest, or each fifth or tenth of ticks that blur has taken.

Of a blurred ruler in millimetres those of each half or whole centimetre are left, because they are
longer: read as millimetres they make everything five or ten times too small. A ruler shows which
ticks they are where longer ones stand among them, at each fifth or tenth.
"""

from __future__ import annotations

from typing import Final

import cv2
import numpy as np

from liggghts_io.photo.light import FloatArray, FloatImage
from liggghts_io.photo.ticks import Ruler, high_passed, strip_along

__all__ = ["are_finest"]

_BESIDE: Final = 2.5  # ticks beside the line that was followed, as far as longer ones may reach
_SHARP: Final = 0.05  # of the distance of ticks: less blur leaves ticks five times finer visible
_COLUMNS: Final = 3  # lines beside each other that have to show longer ticks
_SLOW: Final = 5.0  # ticks: what varies more slowly is light
_PADDED: Final = 8  # points of a spectrum for one of its own
_CLEAR: Final = 2.0  # times what lies between the harmonics
_SLIGHT: Final = 0.05  # of the contrast of the ticks
_STEPS: Final = ((5, 4.0), (10, 5.0))  # each how many ticks, and how many standard errors darker
_NOISE: Final = 1.0  # grey level, of a mean over some ticks


def are_finest(grey: FloatImage, ruler: Ruler) -> bool:
    """Return whether no finer ticks can be missing: longer ones tell, or the photo is sharp.

    Parameters
    ----------
    grey : (rows, columns) float32
        Grey levels.
    ruler : Ruler
    """
    beside = np.arange(-_BESIDE * ruler.pixels, _BESIDE * ruler.pixels + 1.0)
    levels = strip_along(grey, ruler.line, beside)
    ticks = levels[:, np.abs(beside) <= 2.0].mean(axis=1)
    if _blur(ticks) < _SHARP * ruler.pixels:
        return True
    return (
        _in_spectrum(levels, ruler.pixels) >= _COLUMNS
        or _tick_by_tick(levels, ticks, ruler.pixels) >= _COLUMNS
    )


def _blur(ticks: FloatArray) -> float:
    """Return the blur of thin lines, a standard deviation [px], by how steep their flanks are."""
    low, high = np.percentile(ticks, (1.0, 99.0))
    steepest = max(float(np.percentile(np.abs(np.gradient(ticks)), 99.0)), 1e-9)
    return float(np.exp(-0.5) * (high - low) / steepest)  # of a Gaussian, at its point of inflexion


def _in_spectrum(levels: FloatArray, period: float) -> int:
    """Return in how many columns each fifth or tenth tick is another, by harmonics of these."""
    slow = cv2.GaussianBlur(levels, (0, 0), sigmaX=1e-3, sigmaY=_SLOW * period)
    size = _PADDED * len(levels)
    power = np.abs(np.fft.rfft((levels - slow) * np.hanning(len(levels))[:, None], size, axis=0))

    def at(part: float) -> FloatArray:
        middle = part * size / period
        near = power[max(int(middle) - _PADDED, 0) : int(middle) + _PADDED + 1]
        return np.asarray(near.max(axis=0))

    fifths = np.minimum(at(0.2), at(0.4))  # of both, each fifth tick and each tenth
    between = np.max([at(part) for part in (0.25, 0.35, 0.45, 0.55)], axis=0)
    longer = (fifths > _CLEAR * between) & (fifths > _SLIGHT * float(at(1.0).max()))
    return int(longer.sum())


def _tick_by_tick(levels: FloatArray, ticks: FloatArray, period: float) -> int:
    """Return in how many columns side by side each fifth or tenth tick is darker than others."""
    along = np.arange(len(ticks), dtype=np.float64)
    turning = high_passed(ticks[:, None], period)[:, 0] * np.exp(-2j * np.pi * along / period)
    first = (np.pi - np.angle(turning.sum())) / (2.0 * np.pi) * period % period
    places = np.arange(first, len(ticks) - 0.5 * period, period)
    places = places[places >= 0.5 * period]

    def at(where: FloatArray) -> FloatArray:
        return np.asarray(levels[np.clip(np.rint(where).astype(int), 0, len(levels) - 1)])

    darker = 0.5 * (at(places - 0.5 * period) + at(places + 0.5 * period)) - at(places)
    most = 0
    for step, errors in _STEPS:
        for k in range(step):
            one = np.arange(len(places)) % step == k
            if one.sum() < 2 or (~one).sum() < 2:
                continue
            own, others = darker[one], darker[~one]
            error = np.sqrt(own.var(0, ddof=1) / len(own) + others.var(0, ddof=1) / len(others))
            clear = own.mean(0) - others.mean(0) > errors * (error + _NOISE)
            most = max(most, _longest(clear))
    return most


def _longest(true: np.ndarray[tuple[int], np.dtype[np.bool_]]) -> int:
    """Return how many stand side by side at most."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], true, [False])).astype(np.int8)))
    return int((edges[1::2] - edges[::2]).max(initial=0))
