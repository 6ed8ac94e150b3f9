"""Which nodes and edges the triangles of a surface have in common."""

from __future__ import annotations

import numpy as np

from minidem.world.state import Floats, Ints

__all__ = ["EQUAL", "edges_of", "node_numbers"]

EQUAL = 1.0e-8
"""Nodes nearer than this in each coordinate are one where a script has no `precision`, m."""


def node_numbers(nodes: Floats, equal: float = EQUAL) -> Ints:
    """Give equal nodes the same number.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3, 3)
        Triangles, m.
    equal : float
        Nodes nearer than this in each coordinate are one, m.

    Returns
    -------
    ndarray of int64, shape (n, 3)
    """
    points = nodes.reshape(-1, 3)
    number = _numbered(points)
    # two points nearer than a quarter of the grid share a cell in one of eight shifted grids
    groups = []
    for shift in np.ndindex(2, 2, 2):
        cells = np.floor(points / (4.0 * equal) + 0.5 * np.array(shift))
        groups.append(_numbered(cells))
    before = np.full_like(number, -1)
    while (number != before).any():
        before = number
        for group in groups:
            least = np.full(group.max() + 1, len(points))
            np.minimum.at(least, group, number)
            number = least[group]
    return number.reshape(-1, 3)


def _numbered(rows: Floats | Ints) -> Ints:
    """Give equal rows the same number, ascending with the rows; quicker than `numpy.unique`."""
    places = np.lexsort(rows.T[::-1])
    ordered = rows[places]
    number = np.zeros(len(rows), np.int64)
    number[places[1:]] = np.cumsum((ordered[1:] != ordered[:-1]).any(axis=1))
    return number


def edges_of(number: Ints) -> Ints:
    """Find the edges that triangles have in common.

    Parameters
    ----------
    number : ndarray of int64, shape (n, 3)
        Their nodes.

    Returns
    -------
    ndarray of int64, shape (m, 4)
        Ascending: i, edge of i, j, edge of j, with j < i, for every pair of triangles with two
        common nodes.
    """
    ends = np.stack([number, np.roll(number, -1, axis=1)], axis=2).reshape(-1, 2)
    ends.sort(axis=1)
    edge = _numbered(ends)
    order = np.argsort(edge, kind="stable")
    edge = edge[order]
    pairs = []
    apart = 1  # places between the two users of an edge; few edges have more than two
    while len(first := np.flatnonzero(edge[apart:] == edge[:-apart])):
        pairs.append(np.stack([order[first + apart], order[first]], axis=1))
        apart += 1
    users = np.concatenate([np.zeros((0, 2), np.int64), *pairs])
    later, earlier = users.T
    found = np.stack([later // 3, later % 3, earlier // 3, earlier % 3], axis=1)
    return found[np.lexsort(found.T[::-1])]
