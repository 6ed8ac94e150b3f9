"""Contour lines of targets over two parameters, where they cross and how near they come."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import contourpy
import numpy as np

from calibrate.arrays import Array

__all__ = ["Meeting", "contour_lines", "crossings", "meet"]


@dataclass(frozen=True)
class Meeting:
    """How the contour lines of two targets meet.

    Attributes
    ----------
    names : tuple of two str
        The targets.
    points : (n, 2) float64
        Crossings in the unit square.
    nearest : (2,) float64 or None
        Without a crossing, the middle of the shortest bridge between the lines.
    gap : float
        Length of that bridge in shares of the box.
    """

    names: tuple[str, str]
    points: Array
    nearest: Array | None
    gap: float


def contour_lines(axes: tuple[Array, Array], values: Array, level: float) -> list[Array]:
    """Return the lines on which a function on a grid takes a value.

    Parameters
    ----------
    axes : two (n,), (m,) float64
        Grid of the first and the second parameter.
    values : (n, m) float64
        Function values, first index along the first axis.
    level : float
        Value looked for; no line when it is out of reach.

    Returns
    -------
    list of (k, 2) float64
        Polylines; the columns are the two parameters.
    """
    generator = contourpy.contour_generator(axes[0], axes[1], values.T)
    return [np.asarray(line, float) for line in generator.lines(level) if len(line) > 1]


def crossings(first: list[Array], second: list[Array]) -> Array:
    """Return all points where two sets of polylines cross, (n, 2)."""
    a, b = _segments(first), _segments(second)
    if not len(a) or not len(b):
        return np.empty((0, 2))
    p, r = a[:, None, 0], (a[:, 1] - a[:, 0])[:, None]
    q, s = b[None, :, 0], (b[:, 1] - b[:, 0])[None]
    cross = r[..., 0] * s[..., 1] - r[..., 1] * s[..., 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        d = q - p
        t = (d[..., 0] * s[..., 1] - d[..., 1] * s[..., 0]) / cross
        u = (d[..., 0] * r[..., 1] - d[..., 1] * r[..., 0]) / cross
        hit = (t >= 0) & (t < 1) & (u >= 0) & (u < 1)
    i, j = np.nonzero(hit)
    return np.asarray(a[i, 0] + t[i, j, None] * (a[i, 1] - a[i, 0]))


def meet(lines: dict[str, list[Array]]) -> list[Meeting]:
    """Return how each pair of targets meets; pairs with a target out of reach are left out."""
    found = []
    for (name_a, a), (name_b, b) in combinations(lines.items(), 2):
        if not a or not b:
            continue
        points = crossings(a, b)
        nearest, gap = (None, 0.0) if len(points) else _bridge(np.vstack(a), np.vstack(b))
        found.append(Meeting((name_a, name_b), points, nearest, gap))
    return found


def _segments(lines: list[Array]) -> Array:
    parts = [np.stack([line[:-1], line[1:]], axis=1) for line in lines]
    return np.concatenate(parts) if parts else np.empty((0, 2, 2))


def _bridge(a: Array, b: Array) -> tuple[Array, float]:
    distance = np.linalg.norm(a[:, None] - b[None], axis=2)
    i, j = np.unravel_index(int(np.argmin(distance)), distance.shape)
    return 0.5 * (a[i] + b[j]), float(distance[i, j])
