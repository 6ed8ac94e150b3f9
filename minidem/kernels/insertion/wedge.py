"""Wedges, which are parts of cylinders: whether a point is inside, and what is near it."""

from __future__ import annotations

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from minidem.kernels.columns import X, Y, Z
from minidem.kernels.insertion.shape_columns import (
    ROUND_AXIS,
    ROUND_HIGH,
    ROUND_LOW,
    ROUND_RADIUS,
    ROUND_U,
    ROUND_V,
    SIDES,
    WEDGE_FIRST,
    WEDGE_SECOND,
    WEDGE_WIDE,
)
from minidem.kernels.machine.jit import inlined, inner

__all__ = ["in_wedge", "wedge_contacts"]


@inlined
def _following(axis: int) -> tuple[int, int]:
    """Return the two axes that follow one in turn."""
    if axis == X:
        return Y, Z
    if axis == Y:
        return Z, X
    return X, Y


@inlined
def in_wedge(s: NDArray[np.float64], p: NDArray[np.float64]) -> bool:
    """Tell whether a point is in a wedge or on its surface."""
    axis = int(s[ROUND_AXIS])
    i, j = _following(axis)
    a = p[i] - s[ROUND_U]
    b = p[j] - s[ROUND_V]
    if p[axis] < s[ROUND_LOW] or p[axis] > s[ROUND_HIGH]:
        return False
    if a * a + b * b > s[ROUND_RADIUS] * s[ROUND_RADIUS]:
        return False
    first = s[WEDGE_FIRST + X] * a + s[WEDGE_FIRST + Y] * b > 0.0
    second = s[WEDGE_SECOND + X] * a + s[WEDGE_SECOND + Y] * b > 0.0
    if s[WEDGE_WIDE] > 0.0:
        return not (first and second)
    return not (first or second)


@inner
def wedge_contacts(
    outer: bool, s: NDArray[np.float64], p: NDArray[np.float64], cut: float, delta: NDArray
) -> int:
    """Find points of the inner surface of a wedge nearer than `cut`; LIGGGHTS has no outer one."""
    if outer or not in_wedge(s, p):
        return 0
    axis = int(s[ROUND_AXIS])
    i, j = _following(axis)
    a = p[i] - s[ROUND_U]
    b = p[j] - s[ROUND_V]
    r = sqrt(a * a + b * b)
    n = 0
    for side in range(SIDES):
        gap = p[axis] - s[ROUND_LOW] if side else s[ROUND_HIGH] - p[axis]
        if gap < cut:
            delta[n, i], delta[n, j], delta[n, axis] = 0.0, 0.0, gap if side else -gap
            n += 1
    if s[ROUND_RADIUS] - r < cut and r > 0.0:
        scale = s[ROUND_RADIUS] / r
        delta[n, i], delta[n, j], delta[n, axis] = a - a * scale, b - b * scale, 0.0
        n += 1
    for normal in (WEDGE_FIRST, WEDGE_SECOND):
        gap = a * s[normal + X] + b * s[normal + Y]
        if abs(gap) < cut:
            delta[n, i], delta[n, j] = gap * s[normal + X], gap * s[normal + Y]
            delta[n, axis] = 0.0
            n += 1
    return n
