"""Regions of space: membership and distance to the surface.

A region and the ones it is made of form a table in order of definition, the region itself last,
so that membership of all is found in one pass. Whether a point is near the surface of a union or
intersection is decided by its primitive parts (leaves): a surface point of a leaf counts if it
meets a condition of membership in each sibling on the way up.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from minidem.kernels.insertion.shape_columns import CONTACTS, SURFACE_POINT
from minidem.kernels.insertion.shapes import INTERSECT, TETS, UNION, contacts, inside
from minidem.kernels.insertion.tets import TetTable, in_tets
from minidem.kernels.machine.cache import LASTING
from minidem.kernels.machine.jit import inlined, inner, kernel
from minidem.kernels.machine.space import matrix

__all__ = ["RegionTable", "list_surface", "match_all", "matches", "near_surface"]


class RegionTable(NamedTuple):
    """A region as arrays.

    Attributes
    ----------
    kind : (n,) int64
        See `minidem.kernels.insertion.shapes`.
    interior : (n,) int64
        1 for side in, 0 for side out.
    shape : (n, SHAPE) float64
        Numbers of a shape, see `minidem.kernels.insertion.shape_columns`.
    child_start, child : int64
        Parts of region k are ``child[child_start[k]:child_start[k + 1]]``.
    leaf_start : (3,) int64
        Leaves of the inner surface are 0:leaf_start[1], of the outer one the rest.
    leaf, leaf_outer : (m,) int64
        Row of the leaf, and 1 if its outer surface is meant.
    condition_start, condition, wanted : int64
        Rows that a surface point of leaf i must match (wanted 1) or not match (0).
    found : (n,) bool
        Working space: membership of the last point in every row.
    tets : TetTable
        Tetrahedra.
    """

    kind: NDArray[np.int64]
    interior: NDArray[np.int64]
    shape: NDArray[np.float64]
    child_start: NDArray[np.int64]
    child: NDArray[np.int64]
    leaf_start: NDArray[np.int64]
    leaf: NDArray[np.int64]
    leaf_outer: NDArray[np.int64]
    condition_start: NDArray[np.int64]
    condition: NDArray[np.int64]
    wanted: NDArray[np.int64]
    found: NDArray[np.bool_]
    tets: TetTable


LASTING.add(RegionTable)


@kernel
def matches(table: RegionTable, p: NDArray[np.float64]) -> bool:
    """Find the membership of point `p` in every row of the table; return that of the region."""
    found = table.found
    root = table.kind.shape[0] - 1
    for k in range(root + 1):
        kind = table.kind[k]
        if kind == TETS:
            held = in_tets(table.tets, k, p)
        elif kind < UNION:
            held = inside(kind, table.shape[k], p)
        else:
            held = kind == INTERSECT
            for c in range(table.child_start[k], table.child_start[k + 1]):
                if found[table.child[c]] != held:
                    held = not held
                    break
        found[k] = held == (table.interior[k] == 1)
    return found[root]


@inner
def _counts(table: RegionTable, leaf: int, p: NDArray[np.float64]) -> bool:
    """Tell whether point `p` of the surface of a leaf is on the surface of the region."""
    first = table.condition_start[leaf]
    last = table.condition_start[leaf + 1]
    if first < last:
        matches(table, p)
    for c in range(first, last):
        if table.found[table.condition[c]] != (table.wanted[c] == 1):
            return False
    return True


@inlined
def _side(table: RegionTable, outer: bool) -> int:
    """Return which leaves make up the inner or outer surface of the region."""
    # For a region with side out the inner surface is the outer one of its shape.
    root = table.interior.shape[0] - 1
    return 1 if outer != (table.interior[root] == 0) else 0


@kernel
def near_surface(
    table: RegionTable, outer: bool, p: NDArray[np.float64], cut: float, delta: NDArray[np.float64]
) -> bool:
    """Tell whether a point is nearer than `cut` to the region's inner or outer surface.

    False for a point on the wrong side of that surface. `delta` is (7, 3) working space.
    """
    side = _side(table, outer)
    for i in range(table.leaf_start[side], table.leaf_start[side + 1]):
        k = table.leaf[i]
        n = contacts(table.kind[k], table.leaf_outer[i] == 1, table.shape[k], p, cut, delta)
        for m in range(n):
            for d in range(3):
                delta[SURFACE_POINT, d] = p[d] - delta[m, d]
            if _counts(table, i, delta[SURFACE_POINT]):
                return True
    return False


@kernel
def list_surface(
    table: RegionTable,
    points: NDArray[np.float64],
    cut: float,
    which: NDArray[np.int64],
    away: NDArray[np.float64],
) -> int:
    """List the points of the inner surface that are nearer than `cut` to points of the region.

    Parameters
    ----------
    table : RegionTable
        The region.
    points : (n, 3)
        m.
    cut : float
        m.
    which, away : (room,) and (room, 3)
        Receive the number of the point, and the vector from the surface to it, m.

    Returns
    -------
    int
        How many there are, which may be more than there is room for.
    """
    delta = matrix(CONTACTS, 3)
    count = 0
    side = _side(table, False)
    for j in range(points.shape[0]):
        p = points[j]
        for i in range(table.leaf_start[side], table.leaf_start[side + 1]):
            k = table.leaf[i]
            n = contacts(table.kind[k], table.leaf_outer[i] == 1, table.shape[k], p, cut, delta)
            for m in range(n):
                for d in range(3):
                    delta[SURFACE_POINT, d] = p[d] - delta[m, d]
                if not _counts(table, i, delta[SURFACE_POINT]):
                    continue
                if count < which.shape[0]:
                    which[count] = j
                    for d in range(3):
                        away[count, d] = delta[m, d]
                count += 1
    return count


@kernel
def match_all(table: RegionTable, points: NDArray[np.float64], result: NDArray[np.bool_]) -> None:
    """Write the membership of every point to `result`, shape (N,)."""
    for i in range(points.shape[0]):
        result[i] = matches(table, points[i])
