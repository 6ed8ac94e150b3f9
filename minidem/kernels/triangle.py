"""Distance of a sphere centre to a triangle, with the rules of LIGGGHTS for edges and corners.

A shared edge or corner belongs to one triangle only (the flags), otherwise a sphere on it would
be pushed twice. What looks odd here is LIGGGHTS' behaviour, kept on purpose: an obtuse angle is
heeded at node 2 only, and on its second side the point is projected along the first one.
"""

from __future__ import annotations

from math import sqrt

from minidem.kernels.jit import inlined, kernel

__all__ = ["FAR", "closest", "coplanar", "near"]

FAR = 1.0e6
"""Distance that stands for no contact."""

EPS = 1.0e-10  # m, tolerance at the ends of edges
SHARP = 1.0e-8  # m, tolerance of the sides of the face and of equal nodes


@inlined
def _to(node, t, k, x, y, z):
    """Return distance and vector from node k to the point."""
    dx = x - node[t, k, 0]
    dy = y - node[t, k, 1]
    dz = z - node[t, k, 2]
    return sqrt(dx * dx + dy * dy + dz * dz), dx, dy, dz


@inlined
def _along(edge, t, e, dx, dy, dz):
    return dx * edge[t, e, 0] + dy * edge[t, e, 1] + dz * edge[t, e, 2]


@inlined
def _weights(a, wa, b, wb):
    """Return the three barycentric coordinates from two of them."""
    w0 = 0.0
    w1 = 0.0
    w2 = 0.0
    if a == 0:
        w0 = wa
    elif a == 1:
        w1 = wa
    else:
        w2 = wa
    if b == 0:
        w0 += wb
    elif b == 1:
        w1 += wb
    else:
        w2 += wb
    return w0, w1, w2


@inlined
def _project(node, edge, t, k, e, s, x, y, z):
    """Return distance and vector to the point at ``s`` along edge ``e`` from node ``k``."""
    dx = x - (node[t, k, 0] + s * edge[t, e, 0])
    dy = y - (node[t, k, 1] + s * edge[t, e, 1])
    dz = z - (node[t, k, 2] + s * edge[t, e, 2])
    return sqrt(dx * dx + dy * dy + dz * dz), dx, dy, dz


@inlined
def _corner(node, flags, t, k, x, y, z):
    if not (flags[t] >> (3 + k)) & 1:
        return FAR, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0
    d, dx, dy, dz = _to(node, t, k, x, y, z)
    w0, w1, w2 = _weights(k, 1.0, k, 0.0)
    return d, dx, dy, dz, w0, w1, w2, 0


@inlined
def _edge(node, edge, length, flags, t, e, x, y, z):
    """Resolve a contact against edge e and its two corners."""
    e1 = (e + 1) % 3
    _, dx, dy, dz = _to(node, t, e, x, y, z)
    s = _along(edge, t, e, dx, dy, dz)
    if s < -EPS:
        return _corner(node, flags, t, e, x, y, z)
    if s > length[t, e] + EPS:
        return _corner(node, flags, t, e1, x, y, z)
    if not (flags[t] >> e) & 1:
        return FAR, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0
    d, dx, dy, dz = _project(node, edge, t, e, e, s, x, y, z)
    w = 1.0 - s / length[t, e]
    w0, w1, w2 = _weights(e, w, e1, 1.0 - w)
    return d, dx, dy, dz, w0, w1, w2, 0


@inlined
def _obtuse(node, edge, length, flags, t, x, y, z):
    """Resolve a contact in the zone of node 2 where the angle is obtuse."""
    _, dx, dy, dz = _to(node, t, 2, x, y, z)
    s = _along(edge, t, 1, dx, dy, dz)
    if s < EPS:
        if s > -length[t, 1]:
            if not (flags[t] >> 1) & 1:
                return FAR, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0
            d, ex, ey, ez = _project(node, edge, t, 2, 1, s, x, y, z)
            w = 1.0 + s / length[t, 1]
            return d, ex, ey, ez, 0.0, 1.0 - w, w, 0
        return _corner(node, flags, t, 1, x, y, z)
    s = _along(edge, t, 2, dx, dy, dz)
    if s > -EPS:
        if s < length[t, 2]:
            if not (flags[t] >> 2) & 1:
                return FAR, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0
            d, ex, ey, ez = _project(node, edge, t, 2, 1, s, x, y, z)
            w = 1.0 - s / length[t, 2]
            return d, ex, ey, ez, 1.0 - w, 0.0, w, 0
        return _corner(node, flags, t, 0, x, y, z)
    return _corner(node, flags, t, 2, x, y, z)


@kernel
def closest(node, edge, length, normal, flags, bound, t, x, y, z):
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
    _, px, py, pz = _to(node, t, 0, x, y, z)
    a = _along(edge, t, 0, px, py, pz)
    b = _along(edge, t, 2, px, py, pz)
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
    sign = 0
    if w0 > tiny:
        sign += 1
    if w1 > tiny:
        sign += 2
    if w2 > tiny:
        sign += 4
    if sign == 7:
        d = px * normal[t, 0] + py * normal[t, 1] + pz * normal[t, 2]
        return abs(d), d * normal[t, 0], d * normal[t, 1], d * normal[t, 2], w0, w1, w2, 1
    if sign == 3:
        return _edge(node, edge, length, flags, t, 0, x, y, z)
    if sign == 6:
        return _edge(node, edge, length, flags, t, 1, x, y, z)
    if sign == 5:
        return _edge(node, edge, length, flags, t, 2, x, y, z)
    if sign == 1:
        return _corner(node, flags, t, 0, x, y, z)
    if sign == 2:
        return _corner(node, flags, t, 1, x, y, z)
    if sign == 4 and (flags[t] >> 6) & 1:
        return _obtuse(node, edge, length, flags, t, x, y, z)
    return _corner(node, flags, t, 2, x, y, z)


@kernel
def coplanar(node, normal, a, b, limit):
    """Return True if two triangles share a node and are coplanar within the curvature limit."""
    dot = (
        normal[a, 0] * normal[b, 0] + normal[a, 1] * normal[b, 1] + normal[a, 2] * normal[b, 2]
    )
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
def near(node, edge, normal, t, x, y, z, reach):
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
        out = (
            (x - node[t, k, 0]) * ox + (y - node[t, k, 1]) * oy + (z - node[t, k, 2]) * oz
        )
        if out > reach:
            return False
    return True
