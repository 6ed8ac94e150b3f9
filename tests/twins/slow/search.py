"""Neighbour search over all pairs: who may touch whom before the next search.

No cells and no half shells: every pair of spheres, every sphere and wall, with the nearest image
in periodic directions.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

from tests.twins.scene import Scene
from tests.twins.slow.triangle import barycentric
from tests.twins.slow.walls import Surface, gap_of_primitive


def nearest_image(scene: Scene, d: np.ndarray) -> np.ndarray:
    """Return a vector between two spheres, the shortest of its periodic images."""
    length = np.where(scene.periodic, 2.0 * np.array(scene.size), np.inf)
    turns = np.where(scene.periodic, np.rint(d / length), 0.0)
    return d - turns * np.where(scene.periodic, length, 0.0)


def wrapped(scene: Scene, x: np.ndarray) -> np.ndarray:
    """Return positions brought back into the box in periodic directions."""
    half = np.array(scene.size)
    low, high = (x < -half) & scene.periodic, (x >= half) & scene.periodic
    return x + 2.0 * half * low - 2.0 * half * high


def pairs_near(scene: Scene, x: np.ndarray) -> set[tuple[int, int]]:
    """Return the pairs of ids nearer than radii times the factor plus skin."""
    found = set()
    for i, j in combinations(range(len(x)), 2):
        reach = scene.factor * (scene.spheres[i].radius + scene.spheres[j].radius) + scene.skin
        if np.linalg.norm(nearest_image(scene, x[i] - x[j])) <= reach:
            found.add((i + 1, j + 1))
    return found


def primitives_near(scene: Scene, x: np.ndarray) -> set[tuple[int, int]]:
    """Return (id, primitive wall) for surfaces nearer than the skin."""
    return {
        (i + 1, w)
        for i, sphere in enumerate(scene.spheres)
        for w, wall in enumerate(scene.primitives)
        if gap_of_primitive(wall, x[i]) <= sphere.radius + scene.skin
    }


def distance_to_triangle(nodes: np.ndarray, x: np.ndarray) -> float:
    """Return the distance of a point to a triangle, m."""
    if (barycentric(nodes, x) >= 0.0).all():
        a, b, c = nodes
        n = np.cross(b - a, c - a)
        return abs(float((x - a) @ n)) / float(np.linalg.norm(n))
    found = []
    for k in range(3):
        a, b = nodes[k], nodes[(k + 1) % 3]
        part = np.clip((x - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
        found.append(float(np.linalg.norm(x - a - part * (b - a))))
    return min(found)


def triangles_near(scene: Scene, surfaces: list[Surface], x: np.ndarray) -> set[tuple[int, int]]:
    """Return (id, triangle) for triangles nearer than the skin; all meshes count on."""
    nodes = np.concatenate([surface.nodes for surface in surfaces]) if surfaces else []
    return {
        (i + 1, t)
        for i, sphere in enumerate(scene.spheres)
        for t, triangle in enumerate(nodes)
        if distance_to_triangle(triangle, x[i]) <= sphere.radius + scene.skin
    }
