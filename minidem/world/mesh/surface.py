"""Triangle surfaces: which edges and corners of which triangle take contacts."""

from __future__ import annotations

from collections.abc import Sequence
from hashlib import blake2b
from math import cos, sin, sqrt
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError
from minidem.kernels.columns import AB, BC, CORNER_BIT, EDGE_BIT, A, B, C, X, Y, Z
from minidem.record import record
from minidem.world.mesh.edges import EQUAL, edges_of, node_numbers
from minidem.world.state import Floats, Ints

__all__ = [
    "BORDER",
    "CURVATURE",
    "corners_outside",
    "feature_flags",
    "turned",
    "whole",
]

T = TypeVar("T", int, Ints)

CURVATURE = 1.0 - 1.0e-5
"""Cosine above which facets are coplanar unless a script says otherwise."""

_MOST_KNOWN = 16  # meshes of which the flags are kept, 8 bytes a triangle
_KNOWN_FLAGS: dict[tuple[bytes, bytes, float, float], Ints] = {}
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


def whole(nodes: Floats, equal: float = EQUAL) -> NDArray[np.bool_]:
    """Tell which triangles have three nodes; LIGGGHTS drops those with two equal ones."""
    keep = np.ones(len(nodes), bool)
    for a, b in ((A, B), (B, C), (C, A)):
        keep &= ~(np.abs(nodes[:, a] - nodes[:, b]) < equal).all(axis=1)
    return keep


def _dot(a: Floats, b: Floats) -> Floats:
    """Return products of vectors in LIGGGHTS' order of operations."""
    found: Floats = a[..., X] * b[..., X] + a[..., Y] * b[..., Y] + a[..., Z] * b[..., Z]
    return found


def _after(node: T) -> T:
    return (node + 1) % 3


def _before(node: T) -> T:
    return (node + 2) % 3


def _overlap(nodes: Floats, normal: Floats, shared: Ints) -> NDArray[np.bool_]:
    """Return where neighbours that are coplanar lie on the same side of their common edge."""
    i, ei, j, ej = shared.T
    start = nodes[i, ei]
    out = np.cross(nodes[i, _after(ei)] - start, normal[i])
    mine = _dot(nodes[i, _before(ei)] - start, out)
    other = _dot(nodes[j, _before(ej)] - start, out)
    found: NDArray[np.bool_] = mine * other > 0.0
    return found


def feature_flags(
    nodes: Floats, limit: float, ids: Ints | None = None, equal: float = EQUAL
) -> Ints:
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
    equal : float
        Nodes nearer than this are one, m.

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
    key = (blake2b(nodes.tobytes()).digest(), blake2b(order.tobytes()).digest(), limit, equal)
    if key not in _KNOWN_FLAGS:
        if len(_KNOWN_FLAGS) >= _MOST_KNOWN:
            del _KNOWN_FLAGS[next(iter(_KNOWN_FLAGS))]
        _KNOWN_FLAGS[key] = _find_flags(nodes, limit, order, equal)
    return _KNOWN_FLAGS[key].copy()


def _find_flags(nodes: Floats, limit: float, ids: Ints, equal: float) -> Ints:
    """Find the bits of `feature_flags`."""
    count = len(nodes)
    number = node_numbers(nodes, equal)
    edges = np.roll(nodes, -1, axis=1) - nodes
    unit = edges / np.linalg.norm(edges, axis=2, keepdims=True)
    normal = np.cross(unit[:, AB], unit[:, BC])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    shared = edges_of(number)
    i, _, j, _ = shared.T
    same = (np.sort(number[i]) == np.sort(number[j])).all(axis=1)
    for one, other in zip(i[same], j[same], strict=True):
        msg = (
            f"elements {other} and {one} of the mesh are duplicate; "
            "use 'heal auto_remove_duplicates'"
        )
        raise InputError(msg)
    bent = (np.abs(_dot(normal[i], normal[j])) < limit) | _overlap(nodes, normal, shared)
    active = np.ones((count, 3), bool)
    around: list[list[int]] = [[] for _ in range(count)]
    for one, e, other, f, taken in zip(*shared.T.tolist(), bent.tolist(), strict=True):
        around[one].append(other)
        around[other].append(one)
        active[one, e] = taken and ids[one] > ids[other]
        active[other, f] = taken and ids[other] > ids[one]
    flags: Ints = (active * (1 << EDGE_BIT + np.arange(3))).sum(axis=1).astype(np.int64)
    fan = _Fan(number.tolist(), around, active.tolist(), unit, limit, ids.tolist())
    for t in range(count):
        if len(around[t]) > MAX_NEIGHBOURS * 3:
            msg = f"element {t} of the mesh has {len(around[t])} neighbours"
            raise InputError(msg)
        for k in range(3):
            if fan.is_active(t, k):
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


@record(frozen=True)
class _Fan:
    """The triangles around corners.

    Attributes
    ----------
    number : list of list of int
        Nodes of triangles.
    around : list of list of int
        Neighbours of triangles.
    active : list of list of bool
        Which edges take contacts.
    unit : ndarray, shape (n, 3, 3)
        Directions of edges.
    limit : float
        Cosine above which edges go straight on.
    ids : list of int
        Places of triangles.
    """

    number: list[list[int]]
    around: list[list[int]]
    active: list[list[bool]]
    unit: Floats
    limit: float
    ids: list[int]

    def is_active(self, t: int, k: int) -> bool:
        """Decide one corner by walking over the triangles around its node."""
        node = self.number[t][k]
        seen = {t}
        stack = [t]
        rays: list[tuple[int, int, int]] = []
        any_active = False
        while stack:
            s = stack.pop()
            if self.ids[s] > self.ids[t]:
                return False
            nodes = self.number[s]
            at = nodes.index(node)
            back = _before(at)
            rays += [(nodes[_after(at)], s, at), (nodes[back], s, back)]
            any_active = any_active or self.active[s][at] or self.active[s][back]
            for neighbour in self.around[s]:
                # LIGGGHTS finds neighbours by number: those of images lead to the triangle itself
                other = self.ids[neighbour]
                if other not in seen and node in self.number[other]:
                    seen.add(other)
                    stack.append(other)
        return any_active and not self._straight(np.array(rays))

    def _straight(self, rays: Ints) -> bool:
        """Return True if two edges at a node, to other nodes each, go straight on."""
        to, triangle, edge = rays.T
        ways = self.unit[triangle, edge]
        along = np.abs(_dot(ways[:, None], ways[None])) > self.limit
        return bool((along & (to[:, None] != to[None])).any())
