"""What LIGGGHTS demands of a mesh before it takes it."""

from __future__ import annotations

from math import acos, degrees

import numpy as np

from minidem.errors import InputError
from minidem.world.mesh.edges import EQUAL, edges_of, node_numbers
from minidem.world.state import Bools, Floats

__all__ = ["check_angles", "first_of_each", "is_planar", "slivers"]

SLIVER = 0.9999995
"""Cosine of the smallest angle that LIGGGHTS takes whatever a script says: 0.0573 degrees."""


def first_of_each(nodes: Floats, equal: float = EQUAL) -> Bools:
    """Tell which triangles are the first with their nodes, in whatever order these are named.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3, 3)
        Triangles, m.
    equal : float
        Nodes nearer than this are one, m.
    """
    number = node_numbers(nodes, equal)
    _, first = np.unique(np.sort(number, axis=1), axis=0, return_index=True)
    found = np.zeros(len(nodes), bool)
    found[first] = True
    return found


def slivers(nodes: Floats) -> Bools:
    """Tell which triangles have an angle below the smallest that LIGGGHTS takes."""
    return np.asarray((_cosines(nodes) > SLIVER).any(axis=1), bool)


def _cosines(nodes: Floats) -> Floats:
    """Return the cosines of the angles of triangles, (n, 3)."""
    edges = np.roll(nodes, -1, axis=1) - nodes
    unit = edges / np.linalg.norm(edges, axis=2, keepdims=True)
    found: Floats = -(unit * np.roll(unit, 1, axis=1)).sum(axis=2)
    return found


def check_angles(name: str, nodes: Floats, limit: float, *, tolerant: bool) -> None:
    """Refuse triangles with an angle below the curvature limit, and slivers in any case.

    Parameters
    ----------
    name : str
        Id of the mesh.
    nodes : ndarray, shape (n, 3, 3)
        Triangles, m.
    limit : float
        Cosine of the curvature limit.
    tolerant : bool
        ``curvature_tolerant yes``: the curvature limit does not count.

    Raises
    ------
    InputError
        With the element and the ways out.
    """
    bad = np.flatnonzero((_cosines(nodes) > limit).any(axis=1))
    if len(bad) and not tolerant:
        msg = (
            f"Mesh {name}: the smallest angle of mesh element {bad[0]} is lower than the specified "
            f"curvature ({degrees(acos(limit)):.3g} degrees); improve the mesh, set 'curvature' to "
            "1e-5 or lower, or use 'curvature_tolerant yes'"
        )
        raise InputError(msg)
    bad = np.flatnonzero(slivers(nodes))
    if len(bad):
        msg = (
            f"Mesh {name}: {len(bad)} elements, number {bad[0]} first, have an angle below "
            f"{degrees(acos(SLIVER)):.3g} degrees, which LIGGGHTS does not take either; leave them "
            "out: 'element_exclusion_list write FILE' once, then 'element_exclusion_list read FILE'"
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
