"""Distance of a sphere centre to a triangle, with the rules of LIGGGHTS for edges and corners.

A shared edge or corner belongs to one triangle only (the flags), otherwise a sphere on it would
be pushed twice. What looks odd here is LIGGGHTS' behaviour, kept on purpose: an obtuse angle is
heeded at node 2 only.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from minidem.kernels.machine.jit import inlined, inner

__all__ = ["FAR", "closest", "coplanar", "near"]

FAR = 1.0e6
"""Distance that stands for no contact."""

EPS = 1.0e-10  # m, tolerance at the ends of edges
SHARP = 1.0e-8  # m, tolerance of the sides of the face and of equal nodes


@inlined
def closest(
    node: Any,
    edge: Any,
    length: Any,
    normal: Any,
    flags: Any,
    bound: Any,
    t: int,
    x: float,
    y: float,
    z: float,
) -> Any:
    """Return how far a point is from triangle t.

    Returns
    -------
    distance : float
        m; `FAR` if the nearest feature belongs to another triangle.
    dx, dy, dz : float
        From the nearest point to the centre.
    w0, w1, w2 : float
        Barycentric coordinates of the nearest point.
    face : int
        1 if the centre projects into the triangle.
    """
    px = x - node[t, 0, 0]
    py = y - node[t, 0, 1]
    pz = z - node[t, 0, 2]
    a = px * edge[t, 0, 0] + py * edge[t, 0, 1] + pz * edge[t, 0, 2]
    b = px * edge[t, 2, 0] + py * edge[t, 2, 1] + pz * edge[t, 2, 2]
    c = (
        edge[t, 0, 0] * edge[t, 2, 0]
        + edge[t, 0, 1] * edge[t, 2, 1]
        + edge[t, 0, 2] * edge[t, 2, 2]
    )
    det = 1.0 - c * c
    w1 = (a - b * c) / (length[t, 0] * det)
    w2 = (a * c - b) / (length[t, 2] * det)
    w0 = 1.0 - w1 - w2
    tiny = -SHARP / (2.0 * bound[t])
    sign = int(w0 > tiny) + 2 * int(w1 > tiny) + 4 * int(w2 > tiny)
    if sign == 7:
        d = px * normal[t, 0] + py * normal[t, 1] + pz * normal[t, 2]
        return abs(d), d * normal[t, 0], d * normal[t, 1], d * normal[t, 2], w0, w1, w2, 1
    # which edge e (at s from its first node) or which corner k is nearest
    e = -1
    k = -1
    s = 0.0
    if sign == 3:
        e = 0
    elif sign == 6:
        e = 1
    elif sign == 5:
        e = 2
    else:
        k = 0 if sign == 1 else (1 if sign == 2 else 2)
    if e >= 0:
        s = (
            (x - node[t, e, 0]) * edge[t, e, 0]
            + (y - node[t, e, 1]) * edge[t, e, 1]
            + (z - node[t, e, 2]) * edge[t, e, 2]
        )
        if s < -EPS:
            k = e
        elif s > length[t, e] + EPS:
            k = (e + 1) % 3
    elif k == 2 and (flags[t] >> 6) & 1:
        qx = x - node[t, 2, 0]
        qy = y - node[t, 2, 1]
        qz = z - node[t, 2, 2]
        s = qx * edge[t, 1, 0] + qy * edge[t, 1, 1] + qz * edge[t, 1, 2]
        if s < EPS:
            k = -1 if s > -length[t, 1] else 1
            e = 1
            s += length[t, 1]
        else:
            s = qx * edge[t, 2, 0] + qy * edge[t, 2, 1] + qz * edge[t, 2, 2]
            if s > -EPS:
                k = -1 if s < length[t, 2] else 0
                e = 2
    at = k if k >= 0 else e
    if not (flags[t] >> (3 + k if k >= 0 else e)) & 1:
        return FAR, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0
    w = 1.0
    if k >= 0:
        s = 0.0
    else:
        w = 1.0 - s / length[t, e]
    dx = x - (node[t, at, 0] + s * edge[t, at, 0])
    dy = y - (node[t, at, 1] + s * edge[t, at, 1])
    dz = z - (node[t, at, 2] + s * edge[t, at, 2])
    w0 = w if at == 0 else (1.0 - w if at == 2 else 0.0)
    w1 = w if at == 1 else (1.0 - w if at == 0 else 0.0)
    w2 = w if at == 2 else (1.0 - w if at == 1 else 0.0)
    return sqrt(dx * dx + dy * dy + dz * dz), dx, dy, dz, w0, w1, w2, 0


@inner
def coplanar(node: Any, normal: Any, a: int, b: int, limit: float) -> bool:
    """Return True if two triangles share a node and are coplanar within the curvature limit."""
    dot = normal[a, 0] * normal[b, 0] + normal[a, 1] * normal[b, 1] + normal[a, 2] * normal[b, 2]
    if not abs(dot) > limit:
        return False
    for i in range(3):
        for j in range(3):
            if (
                abs(node[a, i, 0] - node[b, j, 0]) < SHARP
                and abs(node[a, i, 1] - node[b, j, 1]) < SHARP
                and abs(node[a, i, 2] - node[b, j, 2]) < SHARP
            ):
                return True
    return False


@inlined
def near(
    node: Any, edge: Any, normal: Any, t: int, x: float, y: float, z: float, reach: float
) -> bool:
    """Return True if a point may come within ``reach`` of the triangle (never wrongly False)."""
    gap = (
        (x - node[t, 0, 0]) * normal[t, 0]
        + (y - node[t, 0, 1]) * normal[t, 1]
        + (z - node[t, 0, 2]) * normal[t, 2]
    )
    if abs(gap) > reach:
        return False
    for k in range(3):
        ox = edge[t, k, 1] * normal[t, 2] - edge[t, k, 2] * normal[t, 1]
        oy = edge[t, k, 2] * normal[t, 0] - edge[t, k, 0] * normal[t, 2]
        oz = edge[t, k, 0] * normal[t, 1] - edge[t, k, 1] * normal[t, 0]
        out = (x - node[t, k, 0]) * ox + (y - node[t, k, 1]) * oy + (z - node[t, k, 2]) * oz
        if out > reach:
            return False
    return True
