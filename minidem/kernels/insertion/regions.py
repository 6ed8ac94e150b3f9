"""Regions of space: membership and distance to the surface.

A region and the ones it is made of form a table in order of definition, the region itself last,
so that membership of all is found in one pass. Whether a point is near the surface of a union or
intersection is decided by its primitive parts (leaves): a surface point of a leaf counts if it
meets a condition of membership in each sibling on the way up.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from minidem.kernels.columns import (  # isort: skip
    X, Y, Z, ONLY, RADIUS, SIDES, LOW, HIGH, ROUND_AXIS, ROUND_U, ROUND_V, ROUND_RADIUS,
    ROUND_LOW, ROUND_HIGH, SURFACE_POINT,
)  # fmt: skip
from minidem.kernels.machine.jit import inlined, kernel

__all__ = [
    "BLOCK",
    "CYLINDER",
    "INTERSECT",
    "SPHERE",
    "UNION",
    "RegionTable",
    "match_all",
    "matches",
    "near_surface",
]

BLOCK, CYLINDER, SPHERE, UNION, INTERSECT = range(5)


class RegionTable(NamedTuple):
    """A region as arrays.

    Attributes
    ----------
    kind : (n,) int64
        BLOCK, CYLINDER, SPHERE, UNION or INTERSECT.
    interior : (n,) int64
        1 for side in, 0 for side out.
    shape : (n, 6) float64
        Block: xlo xhi ylo yhi zlo zhi; cylinder: axis c1 c2 radius lo hi; sphere: centre, radius.
    child_start, child : int64
        Parts of region k are ``child[child_start[k]:child_start[k + 1]]``.
    leaf_start : (3,) int64
        Leaves of the inner surface are 0:leaf_start[1], of the outer one the rest.
    leaf, leaf_outer : (m,) int64
        Row of the leaf, and 1 if its outer surface is meant.
    condition_start, condition, wanted : int64
        Rows that a surface point of leaf i must match (wanted 1) or not match (0).
    found : (n,) bool
        Working space: membership of the last point in every row.
    """

    kind: NDArray[np.int64]
    interior: NDArray[np.int64]
    shape: NDArray[np.float64]
    child_start: NDArray[np.int64]
    child: NDArray[np.int64]
    leaf_start: NDArray[np.int64]
    leaf: NDArray[np.int64]
    leaf_outer: NDArray[np.int64]
    condition_start: NDArray[np.int64]
    condition: NDArray[np.int64]
    wanted: NDArray[np.int64]
    found: NDArray[np.bool_]


@inlined
def _axes(axis: int) -> tuple[int, int]:
    """Return the two axes that the centre of a cylinder refers to."""
    if axis == X:
        return Y, Z
    if axis == Y:
        return X, Z
    return X, Y


@inlined
def _inside(kind: int, shape: NDArray[np.float64], p: NDArray[np.float64]) -> bool:
    """Tell whether a point is in a primitive or on its surface."""
    if kind == BLOCK:
        for d in range(3):  # noqa: SIM110 - Numba compiles loops, not generator expressions
            if not shape[SIDES * d + LOW] <= p[d] <= shape[SIDES * d + HIGH]:
                return False
        return True
    if kind == CYLINDER:
        axis = int(shape[ROUND_AXIS])
        i, j = _axes(axis)
        a = p[i] - shape[ROUND_U]
        b = p[j] - shape[ROUND_V]
        low = shape[ROUND_LOW]
        high = shape[ROUND_HIGH]
        return sqrt(a * a + b * b) <= shape[ROUND_RADIUS] and low <= p[axis] <= high
    a = p[X] - shape[X]
    b = p[Y] - shape[Y]
    c = p[Z] - shape[Z]
    return sqrt(a * a + b * b + c * c) <= shape[RADIUS]


@kernel
def matches(table: RegionTable, p: NDArray[np.float64]) -> bool:
    """Find the membership of point `p` in every row of the table; return that of the region."""
    found = table.found
    root = table.kind.shape[0] - 1
    for k in range(root + 1):
        kind = table.kind[k]
        if kind < UNION:
            inside = _inside(kind, table.shape[k], p)
        else:
            inside = kind == INTERSECT
            for c in range(table.child_start[k], table.child_start[k + 1]):
                if found[table.child[c]] != inside:
                    inside = not inside
                    break
        found[k] = inside == (table.interior[k] == 1)
    return found[root]


@inlined
def _block_contacts(
    outer: bool, s: NDArray[np.float64], p: NDArray[np.float64], cut: float, delta: NDArray
) -> int:
    """Find surface points of a block nearer than `cut`; see `_contacts`."""
    if not outer:
        n = 0
        for d in range(3):
            if p[d] < s[SIDES * d + LOW] or p[d] > s[SIDES * d + HIGH]:
                return 0
        for d in range(3):
            for side in range(SIDES):
                gap = p[d] - s[SIDES * d + LOW] if side == LOW else s[SIDES * d + HIGH] - p[d]
                if gap < cut:
                    delta[n, X] = 0.0
                    delta[n, Y] = 0.0
                    delta[n, Z] = 0.0
                    delta[n, d] = gap if side == LOW else -gap
                    n += 1
        return n
    within = True
    for d in range(3):
        if p[d] <= s[SIDES * d + LOW] - cut or p[d] >= s[SIDES * d + HIGH] + cut:
            return 0
        within = within and p[d] > s[SIDES * d + LOW] and p[d] < s[SIDES * d + HIGH]
    if within:
        return 0
    for d in range(3):
        low = s[SIDES * d + LOW]
        high = s[SIDES * d + HIGH]
        nearest = low if p[d] < low else (high if p[d] > high else p[d])
        delta[ONLY, d] = p[d] - nearest
    a, b, c = delta[ONLY, X], delta[ONLY, Y], delta[ONLY, Z]
    return 1 if sqrt(a * a + b * b + c * c) < cut else 0


@inlined
def _cylinder_contacts(
    outer: bool, s: NDArray[np.float64], p: NDArray[np.float64], cut: float, delta: NDArray
) -> int:
    """Find surface points of a cylinder nearer than `cut`; see `_contacts`."""
    axis = int(s[ROUND_AXIS])
    i, j = _axes(axis)
    a = p[i] - s[ROUND_U]
    b = p[j] - s[ROUND_V]
    r = sqrt(a * a + b * b)
    radius = s[ROUND_RADIUS]
    low = s[ROUND_LOW]
    high = s[ROUND_HIGH]
    h = p[axis]
    if not outer:
        if r > radius or h < low or h > high:
            return 0
        n = 0
        if radius - r < cut and r > 0.0:
            delta[n, i] = a * (1.0 - radius / r)
            delta[n, j] = b * (1.0 - radius / r)
            delta[n, axis] = 0.0
            n += 1
        if h - low < cut:
            delta[n, i] = 0.0
            delta[n, j] = 0.0
            delta[n, axis] = h - low
            n += 1
        if high - h < cut:
            delta[n, i] = 0.0
            delta[n, j] = 0.0
            delta[n, axis] = -(high - h)
            n += 1
        return n
    if r >= radius + cut or h <= low - cut or h >= high + cut:
        return 0
    if r < radius and h > low and h < high:
        return 0
    delta[ONLY, i] = p[i] - (s[ROUND_U] + a * radius / r) if r > radius else 0.0
    delta[ONLY, j] = p[j] - (s[ROUND_V] + b * radius / r) if r > radius else 0.0
    delta[ONLY, axis] = h - low if h < low else (h - high if h > high else 0.0)
    x, y, z = delta[ONLY, X], delta[ONLY, Y], delta[ONLY, Z]
    return 1 if sqrt(x * x + y * y + z * z) < cut else 0


@inlined
def _sphere_contacts(
    outer: bool, s: NDArray[np.float64], p: NDArray[np.float64], cut: float, delta: NDArray
) -> int:
    """Find the surface point of a sphere nearer than `cut`; see `_contacts`."""
    a = p[X] - s[X]
    b = p[Y] - s[Y]
    c = p[Z] - s[Z]
    r = sqrt(a * a + b * b + c * c)
    radius = s[RADIUS]
    if outer:
        if r < radius:
            return 0
        gap = r - radius
    else:
        if r > radius or r == 0.0:
            return 0
        gap = radius - r
    if gap >= cut:
        return 0
    delta[ONLY, X] = a * (1.0 - radius / r)
    delta[ONLY, Y] = b * (1.0 - radius / r)
    delta[ONLY, Z] = c * (1.0 - radius / r)
    return 1


@inlined
def _contacts(
    kind: int,
    outer: bool,
    shape: NDArray[np.float64],
    p: NDArray[np.float64],
    cut: float,
    delta: NDArray[np.float64],
) -> int:
    """Return how many surface points of a primitive are nearer than `cut`, 0 on the other side.

    `delta` receives the vectors from them to the point.
    """
    if kind == BLOCK:
        return _block_contacts(outer, shape, p, cut, delta)
    if kind == CYLINDER:
        return _cylinder_contacts(outer, shape, p, cut, delta)
    return _sphere_contacts(outer, shape, p, cut, delta)


@kernel
def near_surface(
    table: RegionTable, outer: bool, p: NDArray[np.float64], cut: float, delta: NDArray[np.float64]
) -> bool:
    """Tell whether a point is nearer than `cut` to the region's inner or outer surface.

    False for a point on the wrong side of that surface. `delta` is (7, 3) working space.
    """
    root = table.interior.shape[0] - 1
    # For a region with side out the inner surface is the outer one of its shape.
    side = 1 if outer != (table.interior[root] == 0) else 0
    found = table.found
    for i in range(table.leaf_start[side], table.leaf_start[side + 1]):
        k = table.leaf[i]
        n = _contacts(table.kind[k], table.leaf_outer[i] == 1, table.shape[k], p, cut, delta)
        for m in range(n):
            first = table.condition_start[i]
            last = table.condition_start[i + 1]
            if first == last:
                return True
            for d in range(3):
                delta[SURFACE_POINT, d] = p[d] - delta[m, d]
            matches(table, delta[SURFACE_POINT])
            counts = True
            for c in range(first, last):
                if found[table.condition[c]] != (table.wanted[c] == 1):
                    counts = False
                    break
            if counts:
                return True
    return False


@kernel
def match_all(table: RegionTable, points: NDArray[np.float64], result: NDArray[np.bool_]) -> None:
    """Write the membership of every point to `result`, shape (N,)."""
    for i in range(points.shape[0]):
        result[i] = matches(table, points[i])
