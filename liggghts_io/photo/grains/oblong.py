"""Grains as long as rice: smooth, and pieces of one that a watershed has cut.

Such a grain fills the ellipse of its own moments, however long it is; two grains that touch fill
0.89 of theirs, whichever way they lie.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from liggghts_io.photo.grains.separate import Blobs
from liggghts_io.photo.light import FloatArray, Mask

LONGEST: Final = 4.5
"""Longest axis over shortest of a grain."""

_SMOOTH: Final = 0.93  # of the ellipse of equal moments
_ONE: Final = 0.96  # the same of two pieces together
_ROUNDS: Final = 3  # of joining two pieces


def oblong(blobs: Blobs) -> Mask:
    """Return which things (count,) are whole and smooth, as grains of rice are, long or not."""
    filled, aspects = _ellipses(_moments(blobs))
    return np.asarray((filled > _SMOOTH) & (aspects < LONGEST) & ~blobs.cut())


def rejoined(blobs: Blobs) -> Blobs:
    """Return things whose neighbouring pieces are one where they fill an ellipse together."""
    for _ in range(_ROUNDS):
        joined = _joined(blobs)
        if joined is blobs:
            break
        blobs = joined
    return blobs


def _joined(blobs: Blobs) -> Blobs:
    """Join each thing to at most one neighbour, those first that fill an ellipse best."""
    pairs = _touching(blobs)
    moments = _moments(blobs)
    filled, aspects = _ellipses(moments[:, pairs[:, 0]] + moments[:, pairs[:, 1]])
    # What is cut off a bent end may be a grain that lies beside it: both together are no better.
    each = _ellipses(moments)[0]
    better = filled > np.minimum(np.maximum(*each[pairs].T), _ONE)
    good = np.flatnonzero((filled > _ONE) & better & (aspects < LONGEST))
    home = np.arange(blobs.count)
    free = np.ones(blobs.count, dtype=bool)
    for one, other in pairs[good[np.argsort(-filled[good])]]:
        if free[one] and free[other]:
            home[other] = one
            free[[one, other]] = False
    if free.all():
        return blobs
    _, number = np.unique(home, return_inverse=True)
    count = int(number.max()) + 1
    inner = np.zeros(count)
    np.maximum.at(inner, number, blobs.inner)
    names = np.concatenate([[0], number + 1]).astype(np.int32)
    areas = np.bincount(number, weights=blobs.areas, minlength=count).astype(np.float64)
    return Blobs(names[blobs.labels], count, areas, inner)


def _touching(blobs: Blobs) -> npt.NDArray[np.int64]:
    """Return pairs (p, 2) of things with neighbouring pixels, counted from 0."""
    names = blobs.labels
    found = []
    for one, other in ((names[:, 1:], names[:, :-1]), (names[1:], names[:-1])):
        meet = (one != other) & (one > 0) & (other > 0)
        found.append(np.sort(np.stack([one[meet], other[meet]], axis=1), axis=1))
    return np.unique(np.concatenate(found), axis=0).astype(np.int64) - 1


def _moments(blobs: Blobs) -> FloatArray:
    """Return area and sums of x, y, x^2, y^2 and x y of each thing (6, count)."""
    y, x = (at.astype(np.float64) for at in np.nonzero(blobs.labels))
    which = blobs.labels[blobs.labels > 0] - 1
    terms = (np.ones_like(x), x, y, x * x, y * y, x * y)
    return np.stack([np.bincount(which, weights=one, minlength=blobs.count) for one in terms])


def _ellipses(moments: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the part of the ellipse of equal moments that a thing fills, and its axes' ratio."""
    area = np.maximum(moments[0], 1.0)
    x, y, xx, yy, xy = moments[1:] / area
    xx, yy, xy = xx - x * x, yy - y * y, xy - x * y
    root = np.sqrt(np.maximum(xx * yy - xy * xy, 1e-9))
    half = np.maximum(0.5 * (xx + yy) / root, 1.0)  # of a / b + b / a
    return area / (4.0 * np.pi * root), half + np.sqrt(half * half - 1.0)
