"""What lies on a ruler is no grain: its ticks, its numbers, its maker's name.

Ticks begin at the edge of a ruler. Beyond that lies the ground; on their other side the face of
the ruler goes on until it looks like the ground again.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import cv2
import numpy as np
import numpy.typing as npt

from liggghts_io.errors import CaseError
from liggghts_io.photo.colour import grey_of
from liggghts_io.photo.grains.result import GrainSizes
from liggghts_io.photo.grains.shapes import NO_GRAIN
from liggghts_io.photo.light import FloatArray, FloatImage, Mask
from liggghts_io.photo.ticks import Ruler, across, high_passed, strip_along

_MOST_GONE: Final = 0.5  # of what was found may lie on it: numbers, beside few grains
_ROW: Final = 3.0  # ticks that these scatter across it, at most
_WIDEST: Final = 45.0  # ticks: a ruler in mm is hardly wider
_SLANTING: Final = 0.03  # of its length, that a line may be off the ticks at its ends
_ROUNDS: Final = 3  # in which it is laid along them
_TICKED: Final = 0.45  # of the strongest ticks, where there still are some
_AROUND: Final = 3.0  # ticks beside the ruler's line, as far as it has ticks
_FINEST: Final = 5.0  # px of a harmonic that is looked at: finer ones are blurred
_WINDOW: Final = 4  # ticks, over which they are seen to be there
_LEAST_STEP: Final = 3.0  # grey levels between ground and face; less is not seen
_NUMBERS: Final = 2.0  # ticks' lengths to the far side of its numbers, where no face is seen
_MOST_OF_FACE: Final = 0.7  # quantile of its levels: numbers may cover the rest
_LIKE_GROUND: Final = 0.4  # of that step: nearer to the ground than that is ground
_MARGIN: Final = (0.3, 3.0)  # ticks, and px beyond that, around it
_ENDS: Final = 5.0  # ticks beyond the first and the last: its number, and bare face


def without_ruler(found: GrainSizes, colour: npt.NDArray[np.uint8], ruler: Ruler) -> GrainSizes:
    """Return grains without what lies on a ruler.

    Parameters
    ----------
    found : GrainSizes
    colour : (rows, columns, 3) uint8
        The photograph.
    ruler : Ruler

    Raises
    ------
    CaseError
        If nothing else is left.
    """
    corners = face_of(colour, ruler)
    gone = _within(corners, found.outlines)
    # Blurred ticks may not tell on which side of them the face lies.
    if gone.mean() > _MOST_GONE and _scatter(found.outlines[gone], ruler) > _ROW:
        other = face_of(colour, ruler, turned=True)
        if _within(other, found.outlines).sum() < gone.sum():
            corners, gone = other, _within(other, found.outlines)
    if gone.all():
        msg = "no grain in the picture but what lies on the ruler; take more of the ground into it"
        raise CaseError(msg)
    reasons = zip(found.reasons, _within(corners, found.left_out), strict=True)
    return replace(
        found,
        diameters_m=found.diameters_m[~gone],
        circularities=found.circularities[~gone],
        outlines=found.outlines[~gone],
        left_out=np.concatenate([found.left_out, found.outlines[gone]]),
        reasons=(
            *(NO_GRAIN if there else reason for reason, there in reasons),
            *[NO_GRAIN] * int(gone.sum()),
        ),
    )


def _within(corners: FloatArray, outlines: FloatArray) -> Mask:
    """Return which outlines (n, k, 2) have their middle between corners (4, 2)."""
    face = corners.astype(np.float32)
    middles = outlines.mean(axis=1).tolist()
    inside = [cv2.pointPolygonTest(face, tuple(one), measureDist=False) >= 0 for one in middles]
    return np.array(inside, dtype=bool)


def _scatter(outlines: FloatArray, ruler: Ruler) -> float:
    """Return the standard deviation of the middles of outlines across a ruler [ticks]."""
    return float(np.std(outlines.mean(axis=1) @ across(ruler.line))) / ruler.pixels


def face_of(colour: npt.NDArray[np.uint8], ruler: Ruler, *, turned: bool = False) -> FloatArray:
    """Return the corners (4, 2) of a ruler, column and row, as far as it has ticks [px].

    Parameters
    ----------
    colour : (rows, columns, 3) uint8
    ruler : Ruler
    turned : bool
        Whether its face lies on the other side of its ticks than these tell.
    """
    tick, grey = ruler.pixels, grey_of(colour)
    line = _along_the_ticks(grey, ruler)
    beside = np.arange(-_WIDEST * tick, _WIDEST * tick + 1.0, max(1.0, 0.1 * tick))
    middle = line.mean(axis=0) + beside[:, None] * across(line)
    rows, columns = grey.shape
    seen = (middle >= 0.0).all(axis=1) & (middle[:, 0] < columns) & (middle[:, 1] < rows)
    beside = beside[seen]
    strong = _ticks(strip_along(grey, line, beside), tick).mean(axis=0)
    # A yellow ruler on white paper may be as bright as that.
    channels = (colour[..., k].astype(np.float32) for k in range(3))
    level = np.median([strip_along(one, line, beside) for one in channels], axis=1)
    near = np.abs(beside) < _reach(line, tick)
    ticked = beside[near & (strong > _TICKED * strong[near].max())]
    edges = (float(ticked[0]), float(ticked[-1]))
    low, high = _sides(beside, level, strong, edges, turned=turned)
    way = (line[1] - line[0]) / np.linalg.norm(line[1] - line[0])
    ends = line + np.array([[-_ENDS], [_ENDS]]) * tick * way
    margin = _MARGIN[0] * tick + _MARGIN[1]
    sides = np.array([low - margin, high + margin])[:, None] * across(line)
    return np.array(
        [ends[0] + sides[0], ends[1] + sides[0], ends[1] + sides[1], ends[0] + sides[1]]
    )


def _along_the_ticks(grey: FloatImage, ruler: Ruler) -> FloatArray:
    """Return the line (2, 2) through the middles of the ticks, from the first to the last [px].

    The line of a ruler may cross its ticks aslant, and goes on where it has none.
    """
    tick, line = ruler.pixels, ruler.line
    length = float(np.linalg.norm(line[1] - line[0]))
    reach = _reach(line, tick)
    beside = np.arange(-reach, reach + 1.0, max(1.0, 0.1 * tick))
    ends = np.array([0.0, length])
    for _ in range(_ROUNDS):
        power = _ticks(strip_along(grey, line, beside), tick)
        power = np.where(power > _TICKED * power.max(), power, 0.0)
        total = power.sum(axis=1)
        there = np.flatnonzero(total)
        off = power[there] @ beside / total[there]
        along = (there + 0.5) * _WINDOW * tick
        slope, at = np.polyfit(along, off, 1, w=total[there]) if len(there) > 1 else (0.0, off[0])
        ends = np.array([there[0], there[-1] + 1]) * _WINDOW * tick / length
        aside = (at + slope * np.array([0.0, length]))[:, None]
        line = line + aside * across(line)
    return np.asarray(line[0] + ends[:, None] * (line[1] - line[0]))


def _reach(line: FloatArray, tick: float) -> float:
    """Return how far from a line its ticks are looked for [px].

    Not so far that grains get into it, and far enough for a line across all of the ticks.
    """
    length = float(np.linalg.norm(line[1] - line[0]))
    return min(_AROUND * tick, max(tick, _SLANTING * length))


def _ticks(levels: FloatArray, tick: float) -> FloatArray:
    """Return how strong ticks are in each window of each line (windows, k), of levels (n, k).

    Ticks are narrow, so their higher harmonics are as strong; those of grains are not.
    """
    along = np.arange(len(levels))[:, None]
    starts = np.arange(0.0, len(levels) - 0.5 * _WINDOW * tick, _WINDOW * tick).astype(int)
    values = high_passed(levels, tick)
    highest = max(1, int(tick / _FINEST))
    power = np.zeros((len(starts), levels.shape[1]))
    for harmonic in range((highest + 1) // 2, highest + 1):
        turning = values * np.exp(-2j * np.pi * harmonic * along / tick)
        power += np.abs(np.add.reduceat(turning, starts, axis=0)) ** 2
    return np.asarray(np.sqrt(power))


def _sides(
    beside: FloatArray,
    level: FloatArray,
    strong: FloatArray,
    ticks: tuple[float, float],
    *,
    turned: bool,
) -> tuple[float, float]:
    """Return where a ruler begins and ends across its line [px].

    Parameters
    ----------
    beside : (k,) float64
        Distances from its line [px].
    level : (3, k) float64
        Usual red, green and blue there.
    strong : (k,) float64
        How strong ticks are there.
    ticks : (float, float)
        Where those begin and end of which there is one at each place [px].
    turned : bool
        Whether the face lies on the other side than the longer ticks tell.
    """
    first, last = ticks
    deep = max(last - first, 2.0)

    def usual(values: FloatArray, low: float, high: float) -> FloatArray:
        there = values[..., (beside >= low) & (beside <= high)]
        if not there.shape[-1]:
            return np.full(values.shape[:-1], np.nan)
        return np.asarray(np.median(there, axis=-1))

    # Each fifth or tenth tick is longer, towards the face.
    tails = [usual(strong, *part) for part in ((first - deep, first), (last, last + deep))]
    upwards = bool(tails[1] > tails[0]) != turned
    begin, end, side = (first, last, 1.0) if upwards else (last, first, -1.0)
    ground = usual(level, *sorted((begin - 0.5 * side * deep, begin - 1.5 * side * deep)))
    away = np.abs(level - ground[:, None]).max(axis=0)
    beyond = side * (beside - begin)
    face = away[(beyond > 0.0) & (beyond < 2.0 * deep)]
    step = float(np.quantile(face, _MOST_OF_FACE)) if len(face) else 0.0
    if not step >= _LEAST_STEP:  # or no ground is seen
        return first - deep * _NUMBERS, last + deep * _NUMBERS
    far = _end(beside, away < _LIKE_GROUND * step, end, side)
    return (first, far) if upwards else (far, last)


def _end(beside: FloatArray, like_ground: Mask, last: float, side: float) -> float:
    """Return where the face ends: at the ground, at the picture's border, or as far as looked."""
    out = beside[like_ground & (side * (beside - last) > 0.0)]
    if not len(out):
        return float(beside[-1] if side > 0.0 else beside[0])
    return float(out[0] if side > 0.0 else out[-1])
