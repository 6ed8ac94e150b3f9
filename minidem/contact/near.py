"""Pairs of points that are near each other, without the lists of a run."""

from __future__ import annotations

from itertools import product

import numpy as np

from minidem.kernels.columns import X, Y, Z
from minidem.world.state import Bools, Box, Floats, Ints

__all__ = ["pairs_within"]

_MOST = 2**20  # cells per direction


def pairs_within(points: Floats, cutoff: float, box: Box) -> tuple[Ints, Ints]:
    """Return all ordered pairs of different points that are nearer than `cutoff`.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        m.
    cutoff : float
        Above 0 and at most half a period, m.
    box : Box
        Its periodic directions count; the nearest image is meant.

    Returns
    -------
    ndarray of int64, ndarray of int64
        The first and the second of each pair.
    """
    none = np.zeros(0, np.int64)
    if not len(points):
        return none, none
    period = np.asarray(box.period())
    cyclic = period > 0.0
    low = np.where(cyclic, box.lo, points.min(axis=0))
    length = np.where(cyclic, period, points.max(axis=0) - low + cutoff)
    cells = np.clip((length / cutoff).astype(np.int64), 1, _MOST)
    at = np.floor((points - low) / length * cells).astype(np.int64)
    at = np.where(cyclic, at % cells, np.clip(at, 0, cells - 1))
    key = _key(at, cells)
    order = np.argsort(key, kind="stable")
    listed = key[order]
    ways = {_way(step, cells, cyclic) for step in product((-1, 0, 1), repeat=3)}
    found: list[tuple[Ints, Ints]] = []
    for way in sorted(ways):
        there = at + np.array(way)
        inside = (cyclic | ((there >= 0) & (there < cells))).all(axis=1)
        there = np.where(cyclic, there % cells, there)
        wanted = _key(there, cells)
        first = np.searchsorted(listed, wanted)
        count = np.where(inside, np.searchsorted(listed, wanted, side="right") - first, 0)
        one = np.repeat(np.arange(len(points)), count)
        place = np.arange(len(one)) - np.repeat(np.cumsum(count) - count, count)
        other = order[np.repeat(first, count) + place]
        apart = points[one] - points[other]
        apart -= period * np.rint(apart / np.where(cyclic, period, 1.0))
        near = ((apart * apart).sum(axis=1) < cutoff * cutoff) & (one != other)
        found.append((one[near], other[near]))
    return np.concatenate([a for a, _ in found]), np.concatenate([b for _, b in found])


def _way(step: tuple[int, ...], cells: Ints, cyclic: Bools) -> tuple[int, ...]:
    """Return a step to a neighbouring cell, such that no cell is reached by two of them."""
    return tuple(
        s % int(count) if turns and count < len("xyz") else s
        for s, count, turns in zip(step, cells, cyclic, strict=True)
    )


def _key(at: Ints, cells: Ints) -> Ints:
    """Return one number for each cell."""
    found: Ints = (at[:, X] * cells[Y] + at[:, Y]) * cells[Z] + at[:, Z]
    return found
