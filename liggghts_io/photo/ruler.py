"""Find a ruler in a photograph by its ticks: marks at equal distances, along any line.

The picture is turned step by step until some strip of it repeats itself; the period is then
followed along the strip to small parts of a pixel.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

import cv2
import numpy as np

from liggghts_io.errors import CaseError
from liggghts_io.photo.light import FloatArray, FloatImage, Mask
from liggghts_io.photo.ticks import STRIP, Ruler, finest, followed

_WORK_PIXELS: Final = 2e6  # a larger photograph is searched smaller, and measured as it is
_TURNS: Final = (*range(-8, 9), *range(82, 99))  # deg: of a ruler laid along a side
_ANY_TURN: Final = (*range(9, 82), *range(99, 172))
_LEAST_PERIOD: Final = 4.0  # px between ticks
_LEAST_TICKS: Final = 8
_LEAST_LENGTH: Final = 0.25  # of the picture's side: of a strip that is looked at
_LEAST_ALIKE: Final = 0.6  # correlation of a strip with itself one period on
_SURE: Final = 0.9  # from which no other turn is looked at; less is no ruler that lies askew
_AGAIN: Final = 4  # periods on, where it must be as alike: grains in a row are not
_STRAIGHT: Final = 0.9  # of the best correlation: strips of which the shortest period is right
_SLACK: Final = 0.8  # of the best correlation has a strip that may have the finer ticks
_LEAST_CONTRAST: Final = 4.0  # grey levels, standard deviation along a strip
_SAMPLES: Final = 400  # points along a ruler
_MOST_ON_GRAINS: Final = 0.25  # of them that may lie in grains
_WELL: Final = 0.75  # of the most windows: as good as followed over all of them


def find_ruler(grey: FloatImage, missing: Mask | None = None) -> Ruler:
    """Return the ruler in a photograph, the finest of its ticks.

    Parameters
    ----------
    grey : (rows, columns) float32
        Grey levels.
    missing : (rows, columns) bool, optional
        What no camera saw.

    Raises
    ------
    CaseError
        If nothing in the picture repeats itself as ticks do.
    """
    shrink = max(1.0, float(np.sqrt(grey.size / _WORK_PIXELS)))
    small = grey if missing is None else np.where(missing, np.float32("nan"), grey)
    if shrink > 1.0:
        size = (round(grey.shape[1] / shrink), round(grey.shape[0] / shrink))
        small = np.asarray(cv2.resize(small, size, interpolation=cv2.INTER_AREA))
    found = _at(_TURNS, small)
    if max(map(_alike, found), default=0.0) < _SURE:  # a slanting line across long ticks, perhaps
        # By chance grains lie in rows along some line of so many, but never as even as ticks.
        found += [one for one in _at(_ANY_TURN, small) if one.alike >= _SURE]
    if not found:
        msg = (
            "no ruler in the picture; its ticks must be at least "
            f"{_LEAST_PERIOD * shrink:.0f} px apart. Give --scale or --points instead"
        )
        raise CaseError(msg)
    best = max(map(_alike, found))
    good = [one for one in found if one.alike >= _SLACK * best]
    shortest = min(one.pixels for one in good)
    near = [one for one in good if one.pixels < 1.3 * shortest]
    best = max(map(_alike, near))
    near = [one for one in near if one.alike >= _STRAIGHT * best]
    candidates = [followed(grey, one, shrink) for one in near]
    # A line that leaves the ticks soon tells little of how far apart they are.
    most = max(windows for _, windows in candidates)
    # Across long ticks a slanting line finds them, too, but farther apart.
    ruler = min(
        (one for one, windows in candidates if windows >= _WELL * most), key=lambda one: one.pixels
    )
    return finest(grey, ruler, _LEAST_PERIOD * shrink)


def _at(turns: Iterable[int], grey: FloatImage) -> list[Ruler]:
    """Return the best strip of each turn in which one repeats itself."""
    best_of = (max(_strips(grey, float(turn)), key=_alike, default=None) for turn in turns)
    return [one for one in best_of if one is not None]


def check_ruler(ruler: Ruler, outlines: FloatArray) -> None:
    """Refuse a ruler whose ticks are grains that lie in rows.

    Parameters
    ----------
    ruler : Ruler
    outlines : (n, k, 2) float64
        Of the grains in the picture: column and row [px].

    Raises
    ------
    CaseError
        With what to do instead.
    """
    part = np.linspace(0.0, 1.0, _SAMPLES)[:, None]
    points = ruler.line[0] * (1.0 - part) + ruler.line[1] * part
    middles = outlines.mean(axis=1)
    radii = np.linalg.norm(outlines - middles[:, None], axis=2).mean(axis=1)
    away = np.linalg.norm(points[:, None] - middles, axis=2)
    if (away < radii).any(axis=1).mean() > _MOST_ON_GRAINS:
        msg = (
            f"no ruler in the picture: what repeats itself each {ruler.pixels:.0f} px are grains "
            "in a row. Give --scale or --points instead"
        )
        raise CaseError(msg)


def _alike(one: Ruler) -> float:
    return one.alike


def _strips(grey: FloatImage, turn: float) -> Iterator[Ruler]:
    """Yield the strips of a turned picture that repeat themselves."""
    rows, columns = grey.shape
    c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    wide, tall = (
        round(abs(columns * c) + abs(rows * s)),
        round(abs(columns * s) + abs(rows * c)),
    )
    there = np.array([[c, s, 0.0], [-s, c, 0.0]])
    middle = there[:, :2] @ [0.5 * columns, 0.5 * rows]
    there[:, 2] = np.array([0.5 * wide, 0.5 * tall]) - middle
    turned = cv2.warpAffine(
        grey, there, (wide, tall), flags=cv2.INTER_LINEAR, borderValue=float("nan")
    )
    back = np.asarray(cv2.invertAffineTransform(there))
    strips = turned[: tall // STRIP * STRIP].reshape(-1, STRIP, wide).mean(axis=1)
    for k, strip in enumerate(strips):
        inside = np.flatnonzero(np.isfinite(strip))
        if len(inside) < max(_LEAST_LENGTH * wide, _LEAST_TICKS * _LEAST_PERIOD):
            continue
        first, last = int(inside[0]), int(inside[-1])
        period, alike = _period(strip[first : last + 1])
        if alike >= _LEAST_ALIKE:
            y = (k + 0.5) * STRIP
            ends = np.array([[first, y], [last, y]]) @ back[:, :2].T + back[:, 2]
            yield Ruler(period, np.asarray(ends, dtype=np.float64), alike)


def _period(strip: FloatImage) -> tuple[float, float]:
    """Return the shortest period of a strip [px], and how alike it is one period on."""
    values = strip - cv2.GaussianBlur(strip[None], (0, 0), max(4.0, len(strip) / 40))[0]
    if float(values.std()) < _LEAST_CONTRAST:
        return 0.0, 0.0
    n = len(values)
    size = cv2.getOptimalDFTSize(2 * n)  # twice as fast as a length with a large prime in it
    spectrum = np.fft.rfft(values - values.mean(), size)
    most = _AGAIN * (n // _LEAST_TICKS) + _AGAIN + 1
    alike = np.fft.irfft(np.abs(spectrum) ** 2, size)[:most] / np.arange(n, n - most, -1)
    alike /= max(float(alike[0]), 1e-12)
    inner = alike[1 : n // _LEAST_TICKS + 1]
    peaks = 1 + np.flatnonzero((inner >= alike[: len(inner)]) & (inner > alike[2:][: len(inner)]))
    peaks = peaks[(peaks >= _LEAST_PERIOD) & (alike[peaks] >= _LEAST_ALIKE)]
    if not len(peaks):
        return 0.0, 0.0
    first = int(peaks[alike[peaks] >= _SLACK * alike[peaks].max()][0])
    further = [
        float(alike[k * first - k : k * first + k + 1].max(initial=0.0))
        for k in range(1, _AGAIN + 1)
    ]
    return float(first), min(further)
