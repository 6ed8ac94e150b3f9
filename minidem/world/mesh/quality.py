"""What LIGGGHTS demands of a mesh before it takes it."""

from __future__ import annotations

from math import acos, degrees

import numpy as np

from minidem.errors import InputError
from minidem.world.mesh.edges import edges_of, node_numbers
from minidem.world.state import Floats

__all__ = ["check_angles", "drop_duplicates", "is_planar"]


def drop_duplicates(nodes: Floats) -> Floats:
    """Keep the first of triangles with the same three nodes, in whatever order they are named."""
    number = node_numbers(nodes)
    _, first = np.unique(np.sort(number, axis=1), axis=0, return_index=True)
    return np.ascontiguousarray(nodes[np.sort(first)])


def check_angles(name: str, nodes: Floats, limit: float) -> None:
    """Refuse triangles with an angle below the curvature limit.

    Parameters
    ----------
    name : str
        Id of the mesh.
    nodes : ndarray, shape (n, 3, 3)
        Triangles, m.
    limit : float
        Cosine of the curvature limit.

    Raises
    ------
    InputError
        With the element and the ways out.
    """
    edges = np.roll(nodes, -1, axis=1) - nodes
    unit = edges / np.linalg.norm(edges, axis=2, keepdims=True)
    cosine = -(unit * np.roll(unit, 1, axis=1)).sum(axis=2)
    bad = np.flatnonzero((cosine > limit).any(axis=1))
    if len(bad):
        msg = (
            f"Mesh {name}: the smallest angle of mesh element {bad[0]} is lower than the specified "
            f"curvature ({degrees(acos(limit)):.3g} degrees); improve the mesh, set 'curvature' to "
            "1e-5 or lower, or use 'curvature_tolerant yes'"
        )
        raise InputError(msg)


def is_planar(nodes: Floats, normal: Floats, limit: float) -> bool:
    """Return True if all triangles with a common edge are coplanar within the curvature limit.

    Parameters
    ----------
    nodes, normal : ndarray, shape (n, 3, 3) and (n, 3)
        Triangles, m, and their unit normals.
    limit : float
        Cosine of the curvature limit.
    """
    one, _, other, _ = edges_of(node_numbers(nodes)).T
    dots = np.abs((normal[one] * normal[other]).sum(axis=1))
    return bool((dots >= limit).all())
