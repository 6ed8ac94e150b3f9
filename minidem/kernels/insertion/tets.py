"""Tetrahedra of a region: whether a point is in one, and random points in them.

Sums and products are in the order of LIGGGHTS-PUBLIC 3.8.0, so that the same seeds give the same
points to the last bit.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from minidem.kernels.columns import LOWER, UPPER, A, B, C, X, Y, Z
from minidem.kernels.insertion.random import uniform
from minidem.kernels.insertion.shape_columns import LAST
from minidem.kernels.machine.jit import inlined, inner
from minidem.kernels.machine.space import vector

__all__ = ["TetTable", "draw_in_tets", "in_tets", "near_tet_surface"]


class TetTable(NamedTuple):
    """All tetrahedra of a region and its parts.

    Attributes
    ----------
    first : (rows + 1,) int64
        Those of row k of the region are ``first[k]:first[k + 1]``.
    node : (n, 4, 3) float64
        Corners, m, so that volumes are positive.
    bound : (n, 2, 3) float64
        Lower and upper corner of what holds each of them, m.
    volume : (n,) float64
        Sum of the volumes up to and with each of a row, m3.
    start, skin : int64
        Faces near tetrahedron i are ``skin[start[i]:start[i + 1]]``.
    face : (m, 3, 3) float64
        Corners of the faces of the surface, m.
    """

    first: NDArray[np.int64]
    node: NDArray[np.float64]
    bound: NDArray[np.float64]
    volume: NDArray[np.float64]
    start: NDArray[np.int64]
    skin: NDArray[np.int64]
    face: NDArray[np.float64]


@inlined
def _volume(
    v0: NDArray[np.float64],
    v1: NDArray[np.float64],
    v2: NDArray[np.float64],
    v3: NDArray[np.float64],
) -> float:
    """Return the volume of a tetrahedron, with a sign."""
    ax, ay, az = v3[X] - v1[X], v3[Y] - v1[Y], v3[Z] - v1[Z]
    bx, by, bz = v2[X] - v1[X], v2[Y] - v1[Y], v2[Z] - v1[Z]
    cx, cy, cz = v0[X] - v1[X], v0[Y] - v1[Y], v0[Z] - v1[Z]
    return ((ay * bz - az * by) * cx + (-ax * bz + az * bx) * cy + (ax * by - ay * bx) * cz) / 6.0


@inner
def in_tets(tets: TetTable, row: int, p: NDArray[np.float64]) -> bool:
    """Tell whether a point is in a tetrahedron of a row, and not on its surface."""
    for i in range(tets.first[row], tets.first[row + 1]):
        held = True
        for d in range(3):
            held = held and tets.bound[i, LOWER, d] <= p[d] <= tets.bound[i, UPPER, d]
        if not held:
            continue
        a, b, c, e = tets.node[i, A], tets.node[i, B], tets.node[i, C], tets.node[i, LAST]
        if (
            _volume(a, b, c, p) > 0.0
            and _volume(a, b, p, e) > 0.0
            and _volume(a, p, c, e) > 0.0
            and _volume(p, b, c, e) > 0.0
        ):
            return True
    return False


@inner
def draw_in_tets(
    tets: TetTable, row: int, state: NDArray[np.float64], p: NDArray[np.float64]
) -> int:
    """Write a random point in the tetrahedra of a row; return which of them holds it."""
    low, high = tets.first[row], tets.first[row + 1] - 1
    wanted = tets.volume[high] * uniform(state)
    while low < high:
        middle = (low + high) // 2
        if wanted < tets.volume[middle]:
            high = middle
        else:
            low = middle + 1
    s, t, u = uniform(state), uniform(state), uniform(state)
    if s + t > 1.0:
        s = 1.0 - s
        t = 1.0 - t
    if t + u > 1.0:
        old = u
        u = 1.0 - s - t
        t = 1.0 - old
    elif s + t + u > 1.0:
        old = u
        u = s + t + u - 1.0
        s = 1.0 - t - old
    r = 1.0 - s - t - u
    node = tets.node[low]
    for d in range(3):
        p[d] = r * node[A, d] + s * node[B, d] + t * node[C, d] + u * node[LAST, d]
    return low


@inlined
def _beside(a: NDArray[np.float64], b: NDArray[np.float64], p: NDArray[np.float64]) -> float:
    """Return the squared distance of a point from a segment."""
    x, y, z = b[X] - a[X], b[Y] - a[Y], b[Z] - a[Z]
    u, v, w = p[X] - a[X], p[Y] - a[Y], p[Z] - a[Z]
    t = min(max((u * x + v * y + w * z) / (x * x + y * y + z * z), 0.0), 1.0)
    u, v, w = u - t * x, v - t * y, w - t * z
    return u * u + v * v + w * w


@inlined
def _touches(face: NDArray[np.float64], p: NDArray[np.float64], cut: float) -> bool:
    """Tell whether a point is nearer than `cut` to a triangle."""
    a, b, c = face[A], face[B], face[C]
    e, f, g = vector(3), vector(3), vector(3)
    for d in range(3):
        e[d] = b[d] - a[d]
        f[d] = c[d] - a[d]
        g[d] = p[d] - a[d]
    x, y, z = e[Y] * f[Z] - e[Z] * f[Y], e[Z] * f[X] - e[X] * f[Z], e[X] * f[Y] - e[Y] * f[X]
    size = x * x + y * y + z * z
    gap = x * g[X] + y * g[Y] + z * g[Z]
    if gap * gap >= cut * cut * size:
        return False
    ee = e[X] * e[X] + e[Y] * e[Y] + e[Z] * e[Z]
    ef = e[X] * f[X] + e[Y] * f[Y] + e[Z] * f[Z]
    ff = f[X] * f[X] + f[Y] * f[Y] + f[Z] * f[Z]
    eg = e[X] * g[X] + e[Y] * g[Y] + e[Z] * g[Z]
    fg = f[X] * g[X] + f[Y] * g[Y] + f[Z] * g[Z]
    u = (eg * ff - fg * ef) / size
    v = (fg * ee - eg * ef) / size
    if u >= 0.0 and v >= 0.0 and u + v <= 1.0:
        return True
    return min(_beside(a, b, p), _beside(b, c, p), _beside(c, a, p)) < cut * cut


@inner
def near_tet_surface(tets: TetTable, tet: int, p: NDArray[np.float64], cut: float) -> bool:
    """Tell whether a point of a tetrahedron is nearer than `cut` to the surface around it."""
    for k in range(tets.start[tet], tets.start[tet + 1]):
        if _touches(tets.face[tets.skin[k]], p, cut):
            return True
    return False
