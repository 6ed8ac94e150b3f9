"""A strip along the border that is no ground: a ruler, a scale bar, the edge of the table.

It is brighter or darker than the ground all along, and divided from it by a straight edge; ground
may follow again between it and the border. Its own edges are often the clearest of the picture, so
it is painted over before the light is levelled.
"""

from __future__ import annotations

import itertools
from typing import Final, NamedTuple

import numpy as np

from liggghts_io.photo.light import FloatArray, FloatImage, Mask, blurred

_BLOCKS: Final = 10  # of columns, in each of which the edge is looked for
_AGREE: Final = 0.75  # of the blocks must tell one straight edge
_DEEPEST: Final = 0.4  # of the picture
_LEAST_ROWS: Final = 3
_SMOOTH: Final = 1.0  # px
_LEAST_STEP: Final = 0.06  # of the range of the picture's grey levels
_LEAST_GREY: Final = 6.0  # grey levels
_STEEPEST: Final = 0.1  # of the edge, rows per column: 6 degrees
_NEAR: Final = 2.5  # px from the edge
_NEAR_PART: Final = 0.004  # of the picture's width
_BESIDE: Final = 2.5  # px that an edge is wide
_LIKE_GROUND: Final = 0.4  # of the step: rows of the strip nearer to the ground than that
_MOST_LIKE: Final = 0.2  # part of the strip's rows that may be


class _Edge(NamedTuple):
    """The upper edge of a strip along the lower border, or near it.

    Attributes
    ----------
    row, slope : float
        At the left border [px], and rows per column.
    beside : (_BLOCKS,) float64
        Grey level of the ground above it, block by block.
    depth : float
        Of the strip [px]; infinite for one that reaches the border.
    """

    row: float
    slope: float
    beside: FloatArray
    depth: float


def without_strips(grey: FloatImage) -> FloatImage:
    """Return a picture with the ground going on where a strip lies along one of its borders.

    Parameters
    ----------
    grey : (rows, columns) float32
        Grey levels.
    """
    for turn in range(4):
        upright = np.rot90(grey, turn)
        edge = _edge(np.ascontiguousarray(upright))
        if edge is not None:
            grey = np.ascontiguousarray(np.rot90(_painted(upright, edge), -turn))
    return grey


def _edge(grey: FloatImage) -> _Edge | None:
    """Return the edge of a strip along the lower border."""
    rows, columns = grey.shape
    low, high = np.quantile(grey[::4, ::4], (0.01, 0.99))
    least = max(_LEAST_STEP * float(high - low), _LEAST_GREY)
    first = round((1.0 - _DEEPEST) * rows)
    if columns < 4 * _BLOCKS or rows - first < 2 * _LEAST_ROWS:
        return None
    borders = np.linspace(0, columns, _BLOCKS + 1).astype(int)
    # The median over a block of columns hides grains above the strip, and ticks in it.
    smooth = blurred(np.ascontiguousarray(grey[first:]), _SMOOTH)
    levels = np.array([np.median(smooth[:, a:b], axis=1) for a, b in itertools.pairwise(borders)])
    far = _LEAST_ROWS
    step = levels[:, far:] - levels[:, :-far]
    elsewhere = [np.median(grey[:first:4, a:b]) for a, b in itertools.pairwise(borders)]
    middle = 0.5 * (borders[1:] + borders[:-1])
    # The clearer one first: a ruler has another edge on its other side.
    signs = (1.0, -1.0) if np.median(step.max(axis=1) + step.min(axis=1)) > 0.0 else (-1.0, 1.0)
    for sign in signs:
        edge = _edge_of(sign, levels, step, middle, np.array(elsewhere), least)
        if edge is not None:
            return edge._replace(row=first + edge.row)
    return None


def _edge_of(
    sign: float,
    levels: FloatArray,
    step: FloatArray,
    x: FloatArray,
    usual: FloatArray,
    least: float,
) -> _Edge | None:
    """Return an edge towards what is brighter (1) or darker (-1), its row from that of `levels`.

    Parameters
    ----------
    sign : float
    levels, step : (_BLOCKS, n), (_BLOCKS, n - _LEAST_ROWS) float64
        Of the rows that are looked at, and how they change.
    x, usual : (_BLOCKS,) float64
        Middles of the blocks [px] and grey levels above these rows.
    least : float
        Step of an edge.
    """
    far, blocks = _LEAST_ROWS, np.arange(_BLOCKS)
    best = np.argmax(sign * step, axis=1)
    near = _NEAR + _NEAR_PART * _BLOCKS * float(x[1] - x[0])
    row, slope, on = _straight(x, best + 0.5 * far, near)
    clear = sign * step[blocks, best] > least
    if (on & clear).mean() < _AGREE:
        return None
    # What lies beside the edge is the ground as elsewhere: else the edge is the other side of a
    # ruler that lies in the picture. Far from the edge, too, the strip is no ground.
    ground = levels[blocks, np.maximum(best - 1, 0)]
    size = float(np.median(np.abs(step[blocks, best])))
    if float(np.median(np.abs(ground - usual))) > _LIKE_GROUND * size:
        return None
    begin = np.maximum(np.ceil(row + slope * x).astype(int) + far, 0)
    count = max(levels.shape[1] - int(begin.max()), 0)
    below = np.array([one[k : k + count] for one, k in zip(levels, begin, strict=True)])
    strip = np.median(sign * (below - ground[:, None]), axis=0)
    depth = _depth(strip < _LIKE_GROUND * size)
    return None if depth is None else _Edge(row, slope, ground, depth + far)


def _depth(like_ground: Mask) -> float | None:
    """Return how many rows of a strip are none of the ground, None where it has no other end.

    Parameters
    ----------
    like_ground : (n,) bool
        From its edge to the border.
    """
    if not len(like_ground) or like_ground.mean() <= _MOST_LIKE:
        return float("inf")
    # The row at which fewest are on the wrong side: ground in the strip, or none behind it.
    wrong = np.cumsum(like_ground[:-1]) + np.cumsum(~like_ground[:0:-1])[::-1]
    end = 1 + int(np.argmin(wrong))
    strip, behind = like_ground[:end], like_ground[end:]
    if end < _LEAST_ROWS or strip.mean() > _MOST_LIKE or (~behind).mean() > _MOST_LIKE:
        return None
    return float(end)


def _straight(
    x: FloatArray, y: FloatArray, near: float
) -> tuple[float, float, np.ndarray[tuple[int], np.dtype[np.bool_]]]:
    """Return row at the left border and slope of the line that most points lie near to."""
    i, j = np.triu_indices(len(x), 1)
    slopes = (y[j] - y[i]) / (x[j] - x[i])
    i, slopes = i[np.abs(slopes) < _STEEPEST], slopes[np.abs(slopes) < _STEEPEST]
    if not len(slopes):
        return 0.0, 0.0, np.zeros(len(x), dtype=bool)
    away = np.abs(y - (y[i, None] + slopes[:, None] * (x - x[i, None])))
    best = int(np.argmax((away <= near).sum(axis=1)))
    on = away[best] <= near
    slope, row = np.polyfit(x[on], y[on], 1)
    return float(row), float(slope), on


def _painted(grey: FloatImage, edge: _Edge) -> FloatImage:
    """Return a picture whose ground goes on below an edge, as deep as the strip is."""
    rows, columns = grey.shape
    x = np.arange(columns)
    middle = (np.arange(_BLOCKS) + 0.5) * columns / _BLOCKS
    ground = np.interp(x, middle, edge.beside).astype(np.float32)
    below = np.arange(rows)[:, None] - (edge.row + edge.slope * x)
    return np.where((below > -_BESIDE) & (below < edge.depth + _BESIDE), ground, grey)
