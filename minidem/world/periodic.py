"""Boxes: points in periodic ones, and what the log says of a box."""

from __future__ import annotations

import numpy as np

from minidem.world.state import Box, Floats, Ints

__all__ = ["box_text", "wrapped"]


def box_text(box: Box) -> str:
    """Return how LIGGGHTS writes a box into its log."""
    low, high = (" ".join(f"{c:g}" for c in corner) for corner in (box.lo, box.hi))
    return f"orthogonal box = ({low}) to ({high})"


def wrapped(box: Box, points: Floats) -> tuple[Floats, Ints]:
    """Return points brought into the periodic directions of a box, and by how many periods.

    Parameters
    ----------
    box : Box
        The box.
    points : ndarray, shape (n, 3)
        m.

    Examples
    --------
    >>> corners = np.zeros(3), np.ones(3)
    >>> place, turns = wrapped(Box(*corners, ("pp", "ff", "pp"), *corners), np.array([[1.25] * 3]))
    >>> place.tolist(), turns.tolist()
    ([[0.25, 1.25, 0.25]], [[1, 0, 1]])
    """
    period = box.period()
    steps = np.where(period > 0.0, period, np.inf)
    turns = np.where(period > 0.0, np.floor((points - box.lo) / steps), 0.0)
    found = np.where(period > 0.0, np.maximum(points - turns * period, box.lo), points)
    return found, turns.astype(np.int64)
