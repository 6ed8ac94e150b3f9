"""A triangle and a point, and the triangles of a mesh: which face, edge or corner takes a contact.

Corners 0, 1, 2 and edges 0 (corner 0 to 1), 1, 2. Where triangles meet, one of them takes the
contacts of the common edge or corner. The oddities of LIGGGHTS 3.8.0 are kept: an obtuse angle is
heeded at corner 2 only.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

EQUAL = 1e-8  # m, corners nearer than this in each coordinate are one
END = 1e-10  # m, how far a point may lie beyond the end of an edge


def same_point(a: np.ndarray, b: np.ndarray) -> bool:
    """Return True if two corners are one."""
    return bool((np.abs(a - b) < EQUAL).all())


def unit(vector: np.ndarray) -> np.ndarray:
    """Return the direction of a vector."""
    return vector / np.linalg.norm(vector)


class Feature(NamedTuple):
    """The nearest feature: weights of the corners in the nearest point, and what it is."""

    weights: np.ndarray
    d: np.ndarray
    edge: int | None = None
    corner: int | None = None

    @property
    def face(self) -> bool:
        """True if the point projects into the triangle."""
        return self.edge is None and self.corner is None


def barycentric(nodes: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Return the weights of the corners in the projection of a point onto their plane."""
    sides = nodes[1:] - nodes[0]
    weights = np.linalg.solve(sides @ sides.T, sides @ (x - nodes[0]))
    return np.array([1.0 - weights.sum(), *weights])


def nearest_feature(nodes: np.ndarray, x: np.ndarray) -> Feature:
    """Find out whether face, edge or corner of a triangle counts for a point."""
    weights = barycentric(nodes, x)
    size = max(np.linalg.norm(nodes - nodes.mean(axis=0), axis=1))
    positive = {int(k) for k in np.flatnonzero(weights > -EQUAL / (2.0 * size))}
    if len(positive) == 3:
        a, b, c = nodes
        n = unit(np.cross(b - a, c - a))
        return Feature(weights, ((x - a) @ n) * n)
    if len(positive) == 2:
        edge = next(k for k in range(3) if positive == {k, (k + 1) % 3})
        return _on_edge(nodes, x, edge)
    corner = positive.pop()
    if corner == 2 and (nodes[0] - nodes[2]) @ (nodes[1] - nodes[2]) < 0.0:
        return _at_obtuse_corner(nodes, x)
    return _at_corner(nodes, x, corner)


def _along(nodes: np.ndarray, x: np.ndarray, edge: int) -> tuple[float, float]:
    """Return how far along an edge a point is, and the length of the edge, m."""
    a, b = nodes[edge], nodes[(edge + 1) % 3]
    length = float(np.linalg.norm(b - a))
    return float((x - a) @ (b - a)) / length, length


def _at_corner(nodes: np.ndarray, x: np.ndarray, corner: int) -> Feature:
    return Feature(np.eye(3)[corner], x - nodes[corner], corner=corner)


def _point_of_edge(nodes: np.ndarray, x: np.ndarray, edge: int, part: float) -> Feature:
    weights = (1.0 - part) * np.eye(3)[edge] + part * np.eye(3)[(edge + 1) % 3]
    return Feature(weights, x - weights @ nodes, edge=edge)


def _on_edge(nodes: np.ndarray, x: np.ndarray, edge: int) -> Feature:
    """Return the nearest point of an edge, one of its ends if the point lies beyond."""
    s, length = _along(nodes, x, edge)
    if s < -END:
        return _at_corner(nodes, x, edge)
    if s > length + END:
        return _at_corner(nodes, x, (edge + 1) % 3)
    return _point_of_edge(nodes, x, edge, s / length)


def _at_obtuse_corner(nodes: np.ndarray, x: np.ndarray) -> Feature:
    """Corner 2, or one of the edges 1 and 2 that meet there, whichever the point is beside."""
    s, length = _along(nodes, x, 1)
    if s - length < END:
        return _point_of_edge(nodes, x, 1, s / length) if s > 0.0 else _at_corner(nodes, x, 1)
    s, length = _along(nodes, x, 2)
    if s > -END:
        return _point_of_edge(nodes, x, 2, s / length) if s < length else _at_corner(nodes, x, 0)
    return _at_corner(nodes, x, 2)


# -- which triangle takes a common edge or corner --------------------------------------------------


def active_features(nodes: np.ndarray, limit: float) -> tuple[np.ndarray, np.ndarray]:
    """Return which edges and corners of each triangle take contacts, shape (n, 3) each.

    A free edge does; of triangles with a common edge the last one, but none if they continue each
    other in one plane. A corner belongs to the last of the triangles around it, but to none if no
    edge there is active or if two edges go straight through it.
    """
    count = len(nodes)
    edges = np.ones((count, 3), bool)
    beside: list[set[int]] = [set() for _ in range(count)]
    normals = [unit(np.cross(b - a, c - a)) for a, b, c in nodes]
    for i in range(count):
        for j in range(i):
            for ei in range(3):
                for ej in range(3):
                    if not _same_edge(nodes, i, ei, j, ej):
                        continue
                    beside[i].add(j)
                    beside[j].add(i)
                    flat = abs(normals[i] @ normals[j]) >= limit
                    edges[i, ei] = not flat or _folded(nodes, normals[i], i, ei, j, ej)
                    edges[j, ej] = False
    corners = np.array(
        [
            [_corner_is_active(nodes, t, k, edges, beside, limit) for k in range(3)]
            for t in range(count)
        ]
    )
    return edges, corners


def _same_edge(nodes: np.ndarray, i: int, ei: int, j: int, ej: int) -> bool:
    a, b = nodes[i, ei], nodes[i, (ei + 1) % 3]
    c, d = nodes[j, ej], nodes[j, (ej + 1) % 3]
    return (same_point(a, c) and same_point(b, d)) or (same_point(a, d) and same_point(b, c))


def _folded(nodes: np.ndarray, normal: np.ndarray, i: int, ei: int, j: int, ej: int) -> bool:
    """Return True if both triangles lie on the same side of their edge."""
    start = nodes[i, ei]
    out = np.cross(nodes[i, (ei + 1) % 3] - start, normal)
    sides = [(nodes[t, (e + 2) % 3] - start) @ out for t, e in ((i, ei), (j, ej))]
    return bool(sides[0] * sides[1] > 0.0)


def _corner_is_active(
    nodes: np.ndarray, t: int, k: int, edges: np.ndarray, beside: list[set[int]], limit: float
) -> bool:
    point = nodes[t, k]
    around, new = {t}, [t]
    while new:
        for other in beside[new.pop()]:
            if other not in around and any(same_point(point, p) for p in nodes[other]):
                around.add(other)
                new.append(other)
    ends = []
    any_active = False
    for other in around:
        at = next(c for c in range(3) if same_point(point, nodes[other, c]))
        ends += [nodes[other, (at + 1) % 3], nodes[other, (at + 2) % 3]]
        any_active |= bool(edges[other, at] or edges[other, (at + 2) % 3])
    straight = any(
        not same_point(p, q) and abs(unit(p - point) @ unit(q - point)) > limit
        for p in ends
        for q in ends
    )
    return any_active and max(around) == t and not straight
