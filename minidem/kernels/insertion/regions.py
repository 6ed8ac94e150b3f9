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
    if axis == 0:
        return 1, 2
    if axis == 1:
        return 0, 2
    return 0, 1


@inlined
def _inside(kind: int, shape: NDArray[np.float64], p: NDArray[np.float64]) -> bool:
    """Tell whether a point is in a primitive or on its surface."""
    if kind == BLOCK:
        return (
            p[0] >= shape[0]
            and p[0] <= shape[1]
            and p[1] >= shape[2]
            and p[1] <= shape[3]
            and p[2] >= shape[4]
            and p[2] <= shape[5]
        )
    if kind == CYLINDER:
        axis = int(shape[0])
        i, j = _axes(axis)
        a = p[i] - shape[1]
        b = p[j] - shape[2]
        return sqrt(a * a + b * b) <= shape[3] and p[axis] >= shape[4] and p[axis] <= shape[5]
    a = p[0] - shape[0]
    b = p[1] - shape[1]
    c = p[2] - shape[2]
    return sqrt(a * a + b * b + c * c) <= shape[3]


@kernel
def matches(table: RegionTable, p: NDArray[np.float64]) -> bool:
    """Find the membership of point `p` in every row of the table; return that of the region."""
    found = table.found
    n = table.kind.shape[0]
    for k in range(n):
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
    return found[n - 1]


@inlined
def _block_contacts(
    outer: bool, s: NDArray[np.float64], p: NDArray[np.float64], cut: float, delta: NDArray
) -> int:
    """Find surface points of a block nearer than `cut`; see `_contacts`."""
    if not outer:
        n = 0
        for d in range(3):
            if p[d] < s[2 * d] or p[d] > s[2 * d + 1]:
                return 0
        for d in range(3):
            for side in range(2):
                gap = p[d] - s[2 * d] if side == 0 else s[2 * d + 1] - p[d]
                if gap < cut:
                    delta[n, 0] = 0.0
                    delta[n, 1] = 0.0
                    delta[n, 2] = 0.0
                    delta[n, d] = gap if side == 0 else -gap
                    n += 1
        return n
    within = True
    for d in range(3):
        if p[d] <= s[2 * d] - cut or p[d] >= s[2 * d + 1] + cut:
            return 0
        within = within and p[d] > s[2 * d] and p[d] < s[2 * d + 1]
    if within:
        return 0
    for d in range(3):
        nearest = s[2 * d] if p[d] < s[2 * d] else (s[2 * d + 1] if p[d] > s[2 * d + 1] else p[d])
        delta[0, d] = p[d] - nearest
    a, b, c = delta[0, 0], delta[0, 1], delta[0, 2]
    return 1 if sqrt(a * a + b * b + c * c) < cut else 0


@inlined
def _cylinder_contacts(
    outer: bool, s: NDArray[np.float64], p: NDArray[np.float64], cut: float, delta: NDArray
) -> int:
    """Find surface points of a cylinder nearer than `cut`; see `_contacts`."""
    axis = int(s[0])
    i, j = _axes(axis)
    a = p[i] - s[1]
    b = p[j] - s[2]
    r = sqrt(a * a + b * b)
    radius = s[3]
    low = s[4]
    high = s[5]
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
    delta[0, i] = p[i] - (s[1] + a * radius / r) if r > radius else 0.0
    delta[0, j] = p[j] - (s[2] + b * radius / r) if r > radius else 0.0
    delta[0, axis] = h - low if h < low else (h - high if h > high else 0.0)
    x, y, z = delta[0, 0], delta[0, 1], delta[0, 2]
    return 1 if sqrt(x * x + y * y + z * z) < cut else 0


@inlined
def _sphere_contacts(
    outer: bool, s: NDArray[np.float64], p: NDArray[np.float64], cut: float, delta: NDArray
) -> int:
    """Find the surface point of a sphere nearer than `cut`; see `_contacts`."""
    a = p[0] - s[0]
    b = p[1] - s[1]
    c = p[2] - s[2]
    r = sqrt(a * a + b * b + c * c)
    radius = s[3]
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
    delta[0, 0] = a * (1.0 - radius / r)
    delta[0, 1] = b * (1.0 - radius / r)
    delta[0, 2] = c * (1.0 - radius / r)
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
                delta[6, d] = p[d] - delta[m, d]
            matches(table, delta[6])
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
