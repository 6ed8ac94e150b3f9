"""The face that a stream of particles comes through."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError
from minidem.kernels.columns import RIM_FROM, RIM_TO, A, B, C, X, Y, Z
from minidem.kernels.insertion.stream import RIM, Face

__all__ = ["FIRST", "dot", "length", "make_face"]

PLANAR: Final = 1e-5
FIRST: Final = 0  # the triangle that stands for the face


def dot(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """Return the scalar product, added in LIGGGHTS' order."""
    return float(a[X] * b[X] + a[Y] * b[Y] + a[Z] * b[Z])


def length(a: NDArray[np.float64]) -> float:
    """Return the length of a vector."""
    return float(np.sqrt(dot(a, a)))


def _cross(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.array(
        [a[Y] * b[Z] - a[Z] * b[Y], a[Z] * b[X] - a[X] * b[Z], a[X] * b[Y] - a[Y] * b[X]]
    )


def make_face(
    triangles: NDArray[np.float64], active: NDArray[np.bool_] | None = None
) -> tuple[Face, NDArray[np.float64]]:
    """Prepare an insertion face.

    Parameters
    ----------
    triangles : (n, 3, 3) ndarray
        Vertices in m.
    active : (n, 3) ndarray of bool or None
        Edges that spheres must keep away from with ``all_in yes``.

    Returns
    -------
    Face
        Vertices, areas added up, and for each triangle the edges nearby.
    (3,) ndarray
        Unit normal of the first triangle.

    Raises
    ------
    InputError
        If the triangles do not lie in one plane.
    """
    areas = np.empty(len(triangles))
    normals = np.empty((len(triangles), 3))
    for i, nodes in enumerate(triangles):
        ab, bc = nodes[B] - nodes[A], nodes[C] - nodes[B]
        long, wide = length(ab), length(bc)
        # Reciprocals as in LIGGGHTS; a division would round differently.
        cross = _cross(ab * (1.0 / long), bc * (1.0 / wide))
        size = length(cross)
        areas[i] = 0.5 * size * long * wide
        normals[i] = cross * (1.0 / size)
    normal = normals[FIRST]
    offset = np.abs((triangles.reshape(-1, 3) - triangles[FIRST, A]) @ normal)
    extent = float(np.ptp(triangles.reshape(-1, 3), axis=0).max())
    if np.any(np.abs(normals @ normal) < 1.0 - PLANAR) or float(offset.max()) > PLANAR * extent:
        msg = "the insertion face must be planar"
        raise InputError(msg)
    if active is None:
        active = np.zeros((len(triangles), 3), np.bool_)
    rim, least = _rims(triangles, normals, active)
    return Face(np.ascontiguousarray(triangles), np.cumsum(areas), rim, least), normal


def _rims(
    triangles: NDArray[np.float64], normals: NDArray[np.float64], active: NDArray[np.bool_]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Choose the edges that a point of each triangle is compared with.

    As in LIGGGHTS every further edge takes the place of the farthest one, even if it is farther
    away itself, and the distance is that of its first node from an edge of the triangle.

    Returns
    -------
    (n, 6, 2, 3) ndarray
        End points, m; not a number beyond the last one.
    (n,) ndarray
        Smallest of the distances, m; no test is needed for spheres below it.
    """
    ends = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2)
    rim = np.full((len(triangles), RIM, 2, 3), np.nan)
    least = np.full(len(triangles), np.inf)
    bounded = np.flatnonzero(active.any(axis=1))
    for i in range(len(triangles) if len(bounded) else 0):
        far = np.full(RIM, 1e8)
        used = 0
        for j in bounded:
            for mine in range(3):
                for other in np.flatnonzero(active[j]):
                    slot = used if used < RIM else int(np.argmax(far))
                    used = min(used + 1, RIM)
                    rim[i, slot] = ends[j, other]
                    far[slot] = edge_distance(ends[i, mine], normals[i], triangles[j, other])
        least[i] = far.min()
    return rim, least


def edge_distance(
    ends: NDArray[np.float64], normal: NDArray[np.float64], point: NDArray[np.float64]
) -> float:
    """Return the distance of a point in the plane of a face from a straight edge of it, m.

    With the operations of LIGGGHTS: among edges at the same distance rounding chooses.
    """
    edge = ends[RIM_TO] - ends[RIM_FROM]
    size = length(edge)
    edge = edge * (1.0 / size)
    out = _cross(edge, normal)
    out = out * (1.0 / length(out))
    away = point - ends[RIM_FROM]
    s = dot(away, edge)
    if s < 0.0:
        return length(away)
    if s > size:
        return length(point - ends[RIM_TO])
    return abs(dot(out, away))
