"""Shapes of space: whether a point is inside, and which points of the surface are near it."""

from __future__ import annotations

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from minidem.kernels.columns import ONLY, RADIUS, X, Y, Z
from minidem.kernels.insertion.shape_columns import (
    HIGH,
    LOW,
    PLANE_NORMAL,
    PLANE_POINT,
    ROUND_AXIS,
    ROUND_HIGH,
    ROUND_LOW,
    ROUND_RADIUS,
    ROUND_U,
    ROUND_V,
    SIDES,
)
from minidem.kernels.insertion.slanted import (
    axes,
    cone_contacts,
    in_cone,
    in_prism,
    prism_contacts,
)
from minidem.kernels.insertion.wedge import in_wedge, wedge_contacts
from minidem.kernels.machine.jit import inlined

__all__ = [
    "BLOCK",
    "CONE",
    "CYLINDER",
    "INTERSECT",
    "PLANE",
    "PRISM",
    "SPHERE",
    "TETS",
    "UNION",
    "WEDGE",
    "contacts",
    "inside",
]

BLOCK, CYLINDER, SPHERE, CONE, PRISM, PLANE, WEDGE, TETS, UNION, INTERSECT = range(10)
"""Kinds of regions; those from UNION on are made of others."""


@inlined
def beyond_plane(s: NDArray[np.float64], p: NDArray[np.float64]) -> float:
    """Return the distance of a point from a plane, positive on the side of its normal."""
    return (
        (p[X] - s[PLANE_POINT + X]) * s[PLANE_NORMAL + X]
        + (p[Y] - s[PLANE_POINT + Y]) * s[PLANE_NORMAL + Y]
        + (p[Z] - s[PLANE_POINT + Z]) * s[PLANE_NORMAL + Z]
    )


@inlined
def inside(kind: int, shape: NDArray[np.float64], p: NDArray[np.float64]) -> bool:
    """Tell whether a point is in a primitive or on its surface."""
    if kind == BLOCK:
        for d in range(3):  # noqa: SIM110 - Numba compiles loops, not generator expressions
            if not shape[SIDES * d + LOW] <= p[d] <= shape[SIDES * d + HIGH]:
                return False
        return True
    if kind == CYLINDER:
        axis = int(shape[ROUND_AXIS])
        i, j = axes(axis)
        a = p[i] - shape[ROUND_U]
        b = p[j] - shape[ROUND_V]
        low = shape[ROUND_LOW]
        high = shape[ROUND_HIGH]
        return sqrt(a * a + b * b) <= shape[ROUND_RADIUS] and low <= p[axis] <= high
    if kind == CONE:
        return in_cone(shape, p)
    if kind == PRISM:
        return in_prism(shape, p)
    if kind == WEDGE:
        return in_wedge(shape, p)
    if kind == PLANE:
        return beyond_plane(shape, p) >= 0.0
    a = p[X] - shape[X]
    b = p[Y] - shape[Y]
    c = p[Z] - shape[Z]
    return sqrt(a * a + b * b + c * c) <= shape[RADIUS]


@inlined
def _block_contacts(
    outer: bool, s: NDArray[np.float64], p: NDArray[np.float64], cut: float, delta: NDArray
) -> int:
    """Find surface points of a block nearer than `cut`; see `contacts`."""
    if not outer:
        n = 0
        for d in range(3):
            if p[d] < s[SIDES * d + LOW] or p[d] > s[SIDES * d + HIGH]:
                return 0
        for d in range(3):
            for side in range(SIDES):
                gap = p[d] - s[SIDES * d + LOW] if side == LOW else s[SIDES * d + HIGH] - p[d]
                if gap < cut:
                    delta[n, X] = 0.0
                    delta[n, Y] = 0.0
                    delta[n, Z] = 0.0
                    delta[n, d] = gap if side == LOW else -gap
                    n += 1
        return n
    within = True
    for d in range(3):
        if p[d] <= s[SIDES * d + LOW] - cut or p[d] >= s[SIDES * d + HIGH] + cut:
            return 0
        within = within and p[d] > s[SIDES * d + LOW] and p[d] < s[SIDES * d + HIGH]
    if within:
        return 0
    for d in range(3):
        low = s[SIDES * d + LOW]
        high = s[SIDES * d + HIGH]
        nearest = low if p[d] < low else (high if p[d] > high else p[d])
        delta[ONLY, d] = p[d] - nearest
    a, b, c = delta[ONLY, X], delta[ONLY, Y], delta[ONLY, Z]
    return 1 if sqrt(a * a + b * b + c * c) < cut else 0


@inlined
def _cylinder_contacts(
    outer: bool, s: NDArray[np.float64], p: NDArray[np.float64], cut: float, delta: NDArray
) -> int:
    """Find surface points of a cylinder nearer than `cut`; see `contacts`."""
    axis = int(s[ROUND_AXIS])
    i, j = axes(axis)
    a = p[i] - s[ROUND_U]
    b = p[j] - s[ROUND_V]
    r = sqrt(a * a + b * b)
    radius = s[ROUND_RADIUS]
    low = s[ROUND_LOW]
    high = s[ROUND_HIGH]
    h = p[axis]
    if not outer:
        if r > radius or h < low or h > high:
            return 0
        n = 0
        if radius - r < cut and r > 0.0:
            delta[n, i] = a * (1.0 - radius / r)
            delta[n, j] = b * (1.0 - radius / r)
            delta[n, axis] = 0.0
            n += 1
        if h - low < cut:
            delta[n, i] = 0.0
            delta[n, j] = 0.0
            delta[n, axis] = h - low
            n += 1
        if high - h < cut:
            delta[n, i] = 0.0
            delta[n, j] = 0.0
            delta[n, axis] = -(high - h)
            n += 1
        return n
    if r >= radius + cut or h <= low - cut or h >= high + cut:
        return 0
    if r < radius and h > low and h < high:
        return 0
    delta[ONLY, i] = p[i] - (s[ROUND_U] + a * radius / r) if r > radius else 0.0
    delta[ONLY, j] = p[j] - (s[ROUND_V] + b * radius / r) if r > radius else 0.0
    delta[ONLY, axis] = h - low if h < low else (h - high if h > high else 0.0)
    x, y, z = delta[ONLY, X], delta[ONLY, Y], delta[ONLY, Z]
    return 1 if sqrt(x * x + y * y + z * z) < cut else 0


@inlined
def _sphere_contacts(
    outer: bool, s: NDArray[np.float64], p: NDArray[np.float64], cut: float, delta: NDArray
) -> int:
    """Find the surface point of a sphere nearer than `cut`; see `contacts`."""
    a = p[X] - s[X]
    b = p[Y] - s[Y]
    c = p[Z] - s[Z]
    r = sqrt(a * a + b * b + c * c)
    radius = s[RADIUS]
    if outer:
        if r < radius:
            return 0
        gap = r - radius
    else:
        if r > radius or r == 0.0:
            return 0
        gap = radius - r
    if gap >= cut:
        return 0
    delta[ONLY, X] = a * (1.0 - radius / r)
    delta[ONLY, Y] = b * (1.0 - radius / r)
    delta[ONLY, Z] = c * (1.0 - radius / r)
    return 1


@inlined
def _plane_contacts(
    outer: bool, s: NDArray[np.float64], p: NDArray[np.float64], cut: float, delta: NDArray
) -> int:
    """Find the surface point of a half space nearer than `cut`; see `contacts`."""
    gap = beyond_plane(s, p)
    for d in range(3):
        delta[ONLY, d] = gap * s[PLANE_NORMAL + d]
    if outer:
        gap = -gap
    return 1 if 0.0 <= gap < cut else 0


@inlined
def contacts(
    kind: int,
    outer: bool,
    shape: NDArray[np.float64],
    p: NDArray[np.float64],
    cut: float,
    delta: NDArray[np.float64],
) -> int:
    """Return how many surface points of a primitive are nearer than `cut`, 0 on the other side.

    `delta` receives the vectors from them to the point.
    """
    if kind == BLOCK:
        return _block_contacts(outer, shape, p, cut, delta)
    if kind == CYLINDER:
        return _cylinder_contacts(outer, shape, p, cut, delta)
    if kind == CONE:
        return cone_contacts(outer, shape, p, cut, delta)
    if kind == PRISM:
        return prism_contacts(outer, shape, p, cut, delta)
    if kind == WEDGE:
        return wedge_contacts(outer, shape, p, cut, delta)
    if kind == PLANE:
        return _plane_contacts(outer, shape, p, cut, delta)
    if kind == TETS:
        return 0  # no surface in LIGGGHTS
    return _sphere_contacts(outer, shape, p, cut, delta)
