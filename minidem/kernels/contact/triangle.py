"""Distance of a sphere centre to a triangle, with the rules of LIGGGHTS for edges and corners.

A shared edge or corner belongs to one triangle only (the flags), otherwise a sphere on it would
be pushed twice. What looks odd here is LIGGGHTS' behaviour, kept on purpose: an obtuse angle is
heeded at node 2 only.
"""

from __future__ import annotations

from math import sqrt
from typing import Any, NamedTuple

import numpy as np

from minidem.kernels.columns import AB, BC, CA, CORNER_BIT, EDGE_BIT, OBTUSE_BIT, A, B, C, X, Y, Z
from minidem.kernels.machine.jit import inlined, inner

__all__ = ["FAR", "Nearest", "closest", "coplanar", "near", "unchanged"]

FAR = 1.0e6
"""Distance that stands for no contact."""

EPS = 1.0e-10  # m, tolerance at the ends of edges
SHARP = 1.0e-8  # m, tolerance of the sides of the face and of equal nodes


class Nearest(NamedTuple):
    """The point of a triangle that is nearest to a given one.

    Attributes
    ----------
    distance : float
        m; `FAR` if the nearest feature belongs to another triangle.
    dx, dy, dz : float
        From the nearest point to the given one, m.
    wa, wb, wc : float
        Barycentric coordinates of the nearest point.
    face : int
        1 if the given point projects into the triangle.
    """

    distance: float
    dx: float
    dy: float
    dz: float
    wa: float
    wb: float
    wc: float
    face: int


@inlined
def _weights(mesh: Any, t: int, x: float, y: float, z: float) -> Any:
    """Return the weights of the nodes A, B, C at the projection of a point on triangle t.

    Then the number above which one counts as positive, and the squared sine of the angle at A.
    """
    node = mesh.node
    edge = mesh.edge
    length = mesh.length
    px = x - node[t, A, X]
    py = y - node[t, A, Y]
    pz = z - node[t, A, Z]
    a = px * edge[t, AB, X] + py * edge[t, AB, Y] + pz * edge[t, AB, Z]
    b = px * edge[t, CA, X] + py * edge[t, CA, Y] + pz * edge[t, CA, Z]
    c = (
        edge[t, AB, X] * edge[t, CA, X]
        + edge[t, AB, Y] * edge[t, CA, Y]
        + edge[t, AB, Z] * edge[t, CA, Z]
    )
    det = 1.0 - c * c
    wb = (a - b * c) / (length[t, AB] * det)
    wc = (a * c - b) / (length[t, CA] * det)
    return 1.0 - wb - wc, wb, wc, -SHARP / (2.0 * mesh.bound[t]), det


@inlined
def closest(mesh: Any, t: int, x: float, y: float, z: float) -> Any:
    """Return the point of triangle t that is nearest to a point, as a `Nearest`."""
    node = mesh.node
    edge = mesh.edge
    length = mesh.length
    normal = mesh.normal
    flags = mesh.flags
    wa, wb, wc, tiny, _ = _weights(mesh, t, x, y, z)
    sign = int(wa > tiny) + 2 * int(wb > tiny) + 4 * int(wc > tiny)
    if sign == 7:
        d = (
            (x - node[t, A, X]) * normal[t, X]
            + (y - node[t, A, Y]) * normal[t, Y]
            + (z - node[t, A, Z]) * normal[t, Z]
        )
        return Nearest(abs(d), d * normal[t, X], d * normal[t, Y], d * normal[t, Z], wa, wb, wc, 1)
    # which edge e (at s from its first node) or which corner k is nearest
    e = -1
    k = -1
    s = 0.0
    if sign == 3:
        e = AB
    elif sign == 6:
        e = BC
    elif sign == 5:
        e = CA
    else:
        k = A if sign == 1 else (B if sign == 2 else C)
    if e >= 0:
        s = (
            (x - node[t, e, X]) * edge[t, e, X]
            + (y - node[t, e, Y]) * edge[t, e, Y]
            + (z - node[t, e, Z]) * edge[t, e, Z]
        )
        if s < -EPS:
            k = e
        elif s > length[t, e] + EPS:
            k = (e + 1) % 3
    elif k == C and (flags[t] >> OBTUSE_BIT) & 1:
        qx = x - node[t, C, X]
        qy = y - node[t, C, Y]
        qz = z - node[t, C, Z]
        s = qx * edge[t, BC, X] + qy * edge[t, BC, Y] + qz * edge[t, BC, Z]
        if s < EPS:
            k = -1 if s > -length[t, BC] else B
            e = BC
            s += length[t, BC]
        else:
            s = qx * edge[t, CA, X] + qy * edge[t, CA, Y] + qz * edge[t, CA, Z]
            if s > -EPS:
                k = -1 if s < length[t, CA] else A
                e = CA
    at = k if k >= 0 else e
    if not (flags[t] >> (CORNER_BIT + k if k >= 0 else EDGE_BIT + e)) & 1:
        return Nearest(FAR, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0)
    w = 1.0
    if k >= 0:
        s = 0.0
    else:
        w = 1.0 - s / length[t, e]
    dx = x - (node[t, at, X] + s * edge[t, at, X])
    dy = y - (node[t, at, Y] + s * edge[t, at, Y])
    dz = z - (node[t, at, Z] + s * edge[t, at, Z])
    wa = w if at == A else (1.0 - w if at == C else 0.0)
    wb = w if at == B else (1.0 - w if at == A else 0.0)
    wc = w if at == C else (1.0 - w if at == B else 0.0)
    return Nearest(sqrt(dx * dx + dy * dy + dz * dz), dx, dy, dz, wa, wb, wc, 0)


@inner
def unchanged(mesh: Any, t: int, x: float, y: float, z: float, nearby: float) -> Any:
    """Return how far a point may move, m, until another feature of triangle t is nearest to it.

    For points with `closest` at `FAR`: so long it stays there. The weights of the nodes, whose
    signs tell the features apart, change by no more than the way over the height of the triangle.
    A triangle that turns is seen from the point to move by its angle times the distance from the
    axis, which is no more than that of its nodes and `nearby`, m, as long as the point is so near.
    """
    edge = mesh.edge
    length = mesh.length
    wa, wb, wc, tiny, det = _weights(mesh, t, x, y, z)
    if not (wa > tiny or wb > tiny) and (mesh.flags[t] >> OBTUSE_BIT) & 1:
        return 0.0  # an angle that is heeded
    sine = sqrt(det)
    way = abs(wc - tiny) * length[t, CA] * sine
    way = min(way, abs(wb - tiny) * length[t, AB] * sine)
    way = min(way, abs(wa - tiny) * length[t, AB] * length[t, CA] * sine / length[t, BC])
    apart = np.inf
    for e in range(3):
        px = x - mesh.node[t, e, X]
        py = y - mesh.node[t, e, Y]
        pz = z - mesh.node[t, e, Z]
        s = px * edge[t, e, X] + py * edge[t, e, Y] + pz * edge[t, e, Z]
        way = min(way, min(abs(s + EPS), abs(s - length[t, e] - EPS)))
        s = min(max(s, 0.0), length[t, e])
        px -= s * edge[t, e, X]
        py -= s * edge[t, e, Y]
        pz -= s * edge[t, e, Z]
        apart = min(apart, px * px + py * py + pz * pz)
    return max(min(way, nearby - sqrt(apart)), 0.0)


@inner
def coplanar(mesh: Any, a: int, b: int, limit: float) -> bool:
    """Return True if two triangles share a node and are coplanar within the curvature limit."""
    node = mesh.node
    normal = mesh.normal
    dot = normal[a, X] * normal[b, X] + normal[a, Y] * normal[b, Y] + normal[a, Z] * normal[b, Z]
    if not abs(dot) > limit:
        return False
    for i in range(3):
        for j in range(3):
            if (
                abs(node[a, i, X] - node[b, j, X]) < SHARP
                and abs(node[a, i, Y] - node[b, j, Y]) < SHARP
                and abs(node[a, i, Z] - node[b, j, Z]) < SHARP
            ):
                return True
    return False


@inlined
def near(mesh: Any, t: int, x: float, y: float, z: float, reach: float) -> bool:
    """Return True if a point may come within ``reach`` of the triangle (never wrongly False)."""
    node = mesh.node
    edge = mesh.edge
    normal = mesh.normal
    gap = (
        (x - node[t, A, X]) * normal[t, X]
        + (y - node[t, A, Y]) * normal[t, Y]
        + (z - node[t, A, Z]) * normal[t, Z]
    )
    if abs(gap) > reach:
        return False
    for k in range(3):
        ox = edge[t, k, Y] * normal[t, Z] - edge[t, k, Z] * normal[t, Y]
        oy = edge[t, k, Z] * normal[t, X] - edge[t, k, X] * normal[t, Z]
        oz = edge[t, k, X] * normal[t, Y] - edge[t, k, Y] * normal[t, X]
        out = (x - node[t, k, X]) * ox + (y - node[t, k, Y]) * oy + (z - node[t, k, Z]) * oz
        if out > reach:
            return False
    return True
