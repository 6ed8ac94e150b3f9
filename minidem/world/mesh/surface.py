"""Triangle surfaces: which edges and corners of which triangle take contacts."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from hashlib import blake2b
from itertools import combinations
from math import cos, sin, sqrt

import numpy as np

from minidem.errors import InputError
from minidem.kernels.columns import AB, BC, CORNER_BIT, EDGE_BIT, A, B, C, X, Y, Z
from minidem.world.state import Floats, Ints

__all__ = [
    "CURVATURE",
    "EQUAL",
    "clean",
    "corners_outside",
    "feature_flags",
    "shared_edges",
    "turned",
]

CURVATURE = 1.0 - 1.0e-5
"""Cosine above which facets are coplanar unless a script says otherwise."""

EQUAL = 1.0e-8
"""Nodes nearer than this in each coordinate are one, m."""

_MOST_KNOWN = 16  # meshes of which the flags are kept, 8 bytes a triangle
_KNOWN_FLAGS: dict[tuple[bytes, bytes, float], Ints] = {}
MAX_NEIGHBOURS = 5
BORDER = 1.0e-8  # m, how far outside the box a corner may lie


def turned(nodes: Floats, axis: Sequence[float], angle: float) -> Floats:
    """Turn triangles about an axis through the origin.

    By a quaternion with the operations in LIGGGHTS' order: with a ``curvature`` limit of 1e-5
    degrees the last bit of a coordinate decides whether two facets are coplanar.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3, 3)
        Triangles, m.
    axis : sequence of float
        Direction, of any length.
    angle : float
        rad.

    Raises
    ------
    InputError
        If the axis is too short.
    """
    ax, ay, az = axis
    size = sqrt(ax * ax + ay * ay + az * az)
    if size < 1e-5:
        msg = f"illegal magnitude of rotation axis {size:g}; it must be at least 1e-5"
        raise InputError(msg)
    inv, c, s = 1.0 / size, cos(0.5 * angle), sin(0.5 * angle)
    qx, qy, qz = inv * ax * s, inv * ay * s, inv * az * s
    x, y, z = nodes[..., X], nodes[..., Y], nodes[..., Z]
    # quaternion product q v q* with the real part folded in
    ux = c * x + qy * z - qz * y
    uy = c * y + qz * x - qx * z
    uz = c * z + qx * y - qy * x
    u0 = -qx * x - qy * y - qz * z
    found: Floats = np.stack(
        [
            c * ux - u0 * qx - qz * uy + qy * uz,
            c * uy - u0 * qy - qx * uz + qz * ux,
            c * uz - u0 * qz - qy * ux + qx * uy,
        ],
        axis=-1,
    )
    return found


def clean(nodes: Floats) -> Floats:
    """Drop triangles with two equal nodes, as LIGGGHTS does."""
    keep = np.ones(len(nodes), bool)
    for a, b in ((A, B), (B, C), (C, A)):
        keep &= ~(np.abs(nodes[:, a] - nodes[:, b]) < EQUAL).all(axis=1)
    return np.ascontiguousarray(nodes[keep])


def _node_numbers(nodes: Floats) -> Ints:
    """Give equal nodes the same number, shape (n, 3)."""
    points = nodes.reshape(-1, 3)
    _, number = np.unique(points, axis=0, return_inverse=True)
    parent = np.arange(number.max() + 1)

    def root(a: int) -> int:
        while parent[a] != a:
            parent[a] = parent[parent[a]]
            a = int(parent[a])
        return a

    # two points nearer than a quarter of the grid share a cell in one of eight shifted grids
    for shift in np.ndindex(2, 2, 2):
        cells = np.floor(points / (4.0 * EQUAL) + 0.5 * np.array(shift))
        _, group = np.unique(cells, axis=0, return_inverse=True)
        first: dict[int, int] = {}
        for p, g in enumerate(group.ravel()):
            n = int(number.ravel()[p])
            if g in first:
                a, b = root(first[int(g)]), root(n)
                parent[max(a, b)] = min(a, b)
            else:
                first[int(g)] = n
    return np.array([root(int(a)) for a in number.ravel()], np.int64).reshape(-1, 3)


def _shared_edges(number: Ints) -> list[tuple[int, int, int, int]]:
    """Return (i, edge of i, j, edge of j), j < i, for triangles with two common nodes."""
    users: dict[tuple[int, int], list[tuple[int, int]]] = defaultdict(list)
    for t, (a, b, c) in enumerate(number.tolist()):
        for e, (p, q) in enumerate(((a, b), (b, c), (c, a))):
            users[(min(p, q), max(p, q))].append((t, e))
    found = [
        (i, ei, j, ej)
        for group in users.values()
        for k, (i, ei) in enumerate(group)
        for j, ej in group[:k]
    ]
    return sorted(found)


def shared_edges(nodes: Floats) -> tuple[Ints, list[tuple[int, int, int, int]]]:
    """Return the numbers of the nodes, equal nodes alike, and the edges triangles have in common.

    Returns
    -------
    ndarray of int64, shape (n, 3)
        Node numbers.
    list of (i, edge of i, j, edge of j)
        With j < i, for every pair of triangles with two common nodes.
    """
    number = _node_numbers(nodes)
    return number, _shared_edges(number)


def _after(node: int) -> int:
    return (node + 1) % 3


def _before(node: int) -> int:
    return (node + 2) % 3


def _overlap(nodes: Floats, normal: Floats, i: int, ei: int, j: int, ej: int) -> bool:
    """Return True if coplanar neighbours lie on the same side of their common edge."""
    edge = nodes[i, _after(ei)] - nodes[i, ei]
    out = np.cross(edge, normal[i])
    mine = np.dot(nodes[i, _before(ei)] - nodes[i, ei], out)
    other = np.dot(nodes[j, _before(ej)] - nodes[i, ei], out)
    return bool(mine * other > 0.0)


def feature_flags(nodes: Floats, limit: float, ids: Ints | None = None) -> Ints:
    """Find which edges and corners of each triangle take contacts.

    A shared edge belongs to the triangle with the larger number, or to none if the two are
    coplanar; a corner to the largest one around it, or to none if no edge there is active or two
    edges go straight on.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3, 3)
        Triangles.
    limit : float
        Cosine above which facets are coplanar and edges colinear.
    ids : ndarray of int64, shape (n,), optional
        Place of each triangle; images beyond periodic faces, which come last, have that of their
        triangle.

    Returns
    -------
    ndarray of int64, shape (n,)
        Bits 0-2 edges, 3-5 corners.

    Raises
    ------
    InputError
        If two triangles are duplicates.

    Notes
    -----
    What the last meshes had is kept: a script is rehearsed before it runs.
    """
    order = np.arange(len(nodes)) if ids is None else ids
    key = (blake2b(nodes.tobytes()).digest(), blake2b(order.tobytes()).digest(), limit)
    if key not in _KNOWN_FLAGS:
        if len(_KNOWN_FLAGS) >= _MOST_KNOWN:
            del _KNOWN_FLAGS[next(iter(_KNOWN_FLAGS))]
        _KNOWN_FLAGS[key] = _find_flags(nodes, limit, order)
    return _KNOWN_FLAGS[key].copy()


def _find_flags(nodes: Floats, limit: float, ids: Ints) -> Ints:
    """Find the bits of `feature_flags`."""
    count = len(nodes)
    number = _node_numbers(nodes)
    edges = np.roll(nodes, -1, axis=1) - nodes
    unit = edges / np.linalg.norm(edges, axis=2, keepdims=True)
    normal = np.cross(unit[:, AB], unit[:, BC])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    active = np.ones((count, 3), bool)
    around: list[list[int]] = [[] for _ in range(count)]
    for i, ei, j, ej in _shared_edges(number):
        if set(number[i]) == set(number[j]):
            msg = (
                f"elements {j} and {i} of the mesh are duplicate; use 'heal auto_remove_duplicates'"
            )
            raise InputError(msg)
        around[i].append(j)
        around[j].append(i)
        plane = abs(float(np.dot(normal[i], normal[j]))) >= limit
        if not plane or _overlap(nodes, normal, i, ei, j, ej):
            active[i, ei] = ids[i] > ids[j]
            active[j, ej] = ids[j] > ids[i]
        else:
            active[i, ei] = active[j, ej] = False
    flags: Ints = (active * (1 << EDGE_BIT + np.arange(3))).sum(axis=1).astype(np.int64)
    for t in range(count):
        if len(around[t]) > MAX_NEIGHBOURS * 3:
            msg = f"element {t} of the mesh has {len(around[t])} neighbours"
            raise InputError(msg)
        for k in range(3):
            if _corner_active(t, k, number, around, active, unit, limit, ids):
                flags[t] |= 1 << CORNER_BIT + k
    return flags


def corners_outside(nodes: Floats, lo: Floats, hi: Floats) -> Ints:
    """Return the bits of corners that lie outside the box.

    LIGGGHTS does not decide about them: each triangle there takes contacts with its own corner.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3, 3)
        Triangles, m.
    lo, hi : ndarray, shape (3,)
        Corners of the box, m.

    Returns
    -------
    ndarray of int64, shape (n,)
        As the corners in `feature_flags`.
    """
    outside = ((nodes < lo - BORDER) | (nodes >= hi + BORDER)).any(axis=2)
    bits: Ints = (outside * (1 << CORNER_BIT + np.arange(3))).sum(axis=1).astype(np.int64)
    return bits


def _corner_active(
    t: int, k: int, number: Ints, around: list[list[int]], active: Floats, unit: Floats,
    limit: float, ids: Ints,
) -> bool:  # fmt: skip
    """Decide one corner by walking over the triangles around its node."""
    node = number[t, k]
    seen = {t}
    stack = [t]
    rays: list[tuple[int, Floats]] = []
    any_active = False
    largest = ids[t]
    while stack:
        s = stack.pop()
        at = number[s].tolist().index(node)
        back = _before(at)
        largest = max(largest, ids[s])
        rays.append((int(number[s, _after(at)]), unit[s, at]))
        rays.append((int(number[s, back]), unit[s, back]))
        any_active |= bool(active[s, at] or active[s, back])
        for neighbour in around[s]:
            # LIGGGHTS finds neighbours by number: those of images lead to the triangle itself
            other = int(ids[neighbour])
            if other not in seen and node in number[other]:
                seen.add(other)
                stack.append(other)
    if not any_active or largest != ids[t]:
        return False
    return not any(
        p != q and abs(float(np.dot(u, v))) > limit for (p, u), (q, v) in combinations(rays, 2)
    )
