"""How far the ticks of a ruler are apart, to small parts of a pixel: followed along its length.

What repeats itself in a strip of a photograph is known in whole pixels, and may be each fifth or
tenth tick where the finer ones are too close to be told one by one.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import cv2
import numpy as np

from liggghts_io.photo.light import FloatArray, FloatImage

STRIP: Final = 4
"""Height of a strip in which ticks are looked for [px]."""

_HIGH_PASS: Final = 0.75  # periods: what varies more slowly is light
_WINDOWS: Final = 8  # in which the phase of the ticks is followed
_FEWEST_WINDOWS: Final = 3  # over which it has to be followed
_FINER: Final = 16  # points of a spectrum for one of its own
_OFF: Final = 0.75  # px that a period counted in whole pixels may be off
_UNSURE: Final = 0.02  # of a distance followed along numbers, whose width varies
_OVERLAP: Final = 1.2  # times the least distance that is seen: may have been missed, too
_ABOVE: Final = 2.0  # times the harmonics beside them, which long ticks have, too
_BESIDE: Final = 2.0  # ticks beside a ruler's line, as far as its finer ones are looked for
_SLIGHT: Final = 0.05  # of the contrast of the ticks that were found: less is noise
_LEAST_SEEN: Final = 2.2  # px between such ticks: closer ones are an even grey


class Ruler(NamedTuple):
    """Ticks found in a photograph.

    Attributes
    ----------
    pixels : float
        Between neighbouring ticks [px].
    line : (2, 2) float64
        Where they were followed: ends, column and row [px].
    alike : float
        Correlation of the strip with itself one tick further, 1 at best.
    """

    pixels: float
    line: FloatArray
    alike: float


def strip_along(grey: FloatImage, line: FloatArray, beside: FloatArray) -> FloatArray:
    """Return grey levels along a line and others beside it, (n, k), one for each pixel of length.

    Parameters
    ----------
    grey : (rows, columns) float32
    line : (2, 2) float64
        Ends, column and row.
    beside : (k,) float64
        Distances from the line [px].
    """
    length = float(np.linalg.norm(line[1] - line[0]))
    along = np.arange(0.0, length)[:, None, None] * (line[1] - line[0]) / length
    points = line[0] + along + beside[None, :, None] * across(line)
    points = points.astype(np.float32)
    levels = cv2.remap(
        grey, points[..., 0], points[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
    )
    return np.asarray(levels, dtype=np.float64)


def across(line: FloatArray) -> FloatArray:
    """Return the direction across a line (2, 2), of length 1."""
    x, y = line[1] - line[0]
    return np.array([-y, x], dtype=np.float64) / float(np.hypot(x, y))


def high_passed(levels: FloatArray, period: float) -> FloatArray:
    """Return grey levels (n, k) without what varies more slowly along n than a period."""
    slow = cv2.GaussianBlur(levels, (0, 0), sigmaX=1e-3, sigmaY=_HIGH_PASS * period)
    return np.asarray(levels - slow)


def followed(grey: FloatImage, coarse: Ruler, shrink: float) -> tuple[Ruler, int]:
    """Return a ruler whose ticks are followed from one end to the other in the whole photograph.

    Returns
    -------
    Ruler
    int
        Over how many windows of equal length it could be followed.
    """
    line, period = coarse.line * shrink, coarse.pixels * shrink
    across = np.arange(-0.5 * STRIP * shrink, 0.5 * STRIP * shrink)
    strip = strip_along(grey, line, across).mean(axis=1)
    values = high_passed(strip[:, None], period)[:, 0]
    period = _strongest(values, period, min(_OFF * shrink, 0.3 * period))
    length, along = float(len(values)), np.arange(len(values), dtype=np.float64)
    windows = 0
    for _ in range(3):
        turning = values * np.exp(-2j * np.pi * along / period)
        window = max(round(length / _WINDOWS / period), 1) * period
        edges = np.arange(0.0, length - 0.5 * window, window)
        sums = np.add.reduceat(turning, np.searchsorted(along, edges))
        strong = np.abs(sums) > 0.3 * np.abs(sums).max()
        windows = int(strong.sum())
        if windows < _FEWEST_WINDOWS:
            break
        phase = np.unwrap(np.angle(sums[strong]))
        drift = np.polyfit(edges[strong], phase, 1, w=np.abs(sums[strong]))[0]
        period = 1.0 / (1.0 / period + drift / (2.0 * np.pi))
    return Ruler(float(period), line, coarse.alike), windows


def _strongest(values: FloatArray, period: float, off: float) -> float:
    """Return the period, at most `off` from a given one, that is strongest in some values [px].

    Whole pixels are too coarse to follow a phase: over a hundred pixels ticks that are 4.6 px
    apart, and taken to be 5, are off by more than a whole tick.
    """
    size = _FINER * len(values)
    power = np.abs(np.fft.rfft(values, size))
    low, high = (max(round(size / one), 1) for one in (period + off, period - off))
    return size / (low + int(np.argmax(power[low : high + 1])))


def finest(grey: FloatImage, ruler: Ruler, seen: float) -> Ruler:
    """Return a ruler by its finest ticks, where those that were found are each fifth or tenth.

    Ticks that lie closer than what is searched make one line of the spectrum stand out. Between
    wide ticks all harmonics are alike: one has others of that strength beside it.

    Parameters
    ----------
    grey : (rows, columns) float32
    ruler : Ruler
    seen : float
        Distance from which ticks would have been found themselves [px].
    """
    reach = _BESIDE * ruler.pixels
    beside = np.arange(-reach, reach + 1.0)
    levels = high_passed(strip_along(grey, ruler.line, beside), ruler.pixels)
    power = np.abs(np.fft.rfft(levels, axis=0))
    slight = _SLIGHT * float(power.max())
    least, most = (round(len(levels) / one) for one in (_OVERLAP * seen, _LEAST_SEEN))
    best, found = 0.0, ruler
    for line in range(least, min(most + 1, len(power))):
        step, off = len(levels) / ruler.pixels, _UNSURE * line + 1.0
        others = [
            power[max(int(k - off), 0) : int(k + off) + 2] for k in (line - step, line + step)
        ]
        usual = np.maximum(np.concatenate(others).max(axis=0, initial=0.0), slight)
        clear = np.where(power[line] > _ABOVE * usual, power[line], 0.0)
        if clear.max() > best:
            best, column = float(clear.max()), int(np.argmax(clear))
            period = len(levels) / line
            period = _strongest(levels[:, column], period, _UNSURE * period)
            there = ruler.line + beside[column] * across(ruler.line)
            found = Ruler(period, there, ruler.alike)
    return found
