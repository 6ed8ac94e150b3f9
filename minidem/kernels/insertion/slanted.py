"""Cones and prisms: whether a point is inside, and near which points of the surface.

The contact functions return how many surface points are nearer than a distance, 0 for a point on
the other side of the surface, and write the vectors from them to the point.
"""

from __future__ import annotations

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from minidem.kernels.columns import ONLY, X, Y, Z

from minidem.kernels.insertion.shape_columns import (  # isort: skip
    CONE_RADIUS, EDGES, FACES, PRISM_EDGE, PRISM_HIGH, PRISM_LOW, PRISM_NORMAL, PRISM_XX, PRISM_XY,
    PRISM_XZ, PRISM_YY, PRISM_YZ, PRISM_ZZ, ROUND_AXIS, ROUND_HIGH, ROUND_LOW, ROUND_RADIUS,
    ROUND_U, ROUND_V, SIDES, VECTOR,
)  # fmt: skip
from minidem.kernels.machine.jit import inlined, inner
from minidem.kernels.machine.space import vector

__all__ = [
    "axes",
    "cone_contacts",
    "in_cone",
    "in_prism",
    "prism_contacts",
]

_FAR = 1.0e20  # m2


@inlined
def axes(axis: int) -> tuple[int, int]:
    """Return the two axes that the centre of a cylinder refers to."""
    if axis == X:
        return Y, Z
    if axis == Y:
        return X, Z
    return X, Y


@inlined
def _on_segment(
    a: NDArray[np.float64], b: NDArray[np.float64], p: NDArray[np.float64], out: NDArray[np.float64]
) -> None:
    """Write the point of the segment from `a` to `b` that is nearest to `p`."""
    x, y, z = b[X] - a[X], b[Y] - a[Y], b[Z] - a[Z]
    along = (p[X] - a[X]) * x + (p[Y] - a[Y]) * y + (p[Z] - a[Z]) * z
    t = along / (x * x + y * y + z * z)
    for d in range(3):
        if t <= 0.0:
            out[d] = a[d]
        elif t >= 1.0:
            out[d] = b[d]
        else:
            out[d] = a[d] + t * (b[d] - a[d])


@inlined
def _squared(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """Return the squared distance of two points."""
    x, y, z = a[X] - b[X], a[Y] - b[Y], a[Z] - b[Z]
    return x * x + y * y + z * z


# -- cone ------------------------------------------------------------------------------------------


@inlined
def _cone_radius(s: NDArray[np.float64], h: float) -> float:
    """Return the radius of a cone at a height."""
    low, high = s[ROUND_LOW], s[ROUND_HIGH]
    return s[ROUND_RADIUS] + (h - low) * (s[CONE_RADIUS] - s[ROUND_RADIUS]) / (high - low)


@inlined
def in_cone(s: NDArray[np.float64], p: NDArray[np.float64]) -> bool:
    """Tell whether a point is in a cone or on its surface."""
    axis = int(s[ROUND_AXIS])
    i, j = axes(axis)
    a = p[i] - s[ROUND_U]
    b = p[j] - s[ROUND_V]
    if p[axis] < s[ROUND_LOW] or p[axis] > s[ROUND_HIGH]:
        return False
    return sqrt(a * a + b * b) <= _cone_radius(s, p[axis])


@inlined
def _rim(
    s: NDArray[np.float64], p: NDArray[np.float64], radius: float, h: float, out: NDArray
) -> None:
    """Write the point at a height that is `radius` from the axis of a cone, beside `p`."""
    axis = int(s[ROUND_AXIS])
    i, j = axes(axis)
    a = p[i] - s[ROUND_U]
    b = p[j] - s[ROUND_V]
    r = sqrt(a * a + b * b)
    out[i] = s[ROUND_U] + a * radius / r
    out[j] = s[ROUND_V] + b * radius / r
    out[axis] = h


@inner
def cone_contacts(
    outer: bool, s: NDArray[np.float64], p: NDArray[np.float64], cut: float, delta: NDArray
) -> int:
    """Find surface points of a cone nearer than `cut`."""
    axis = int(s[ROUND_AXIS])
    i, j = axes(axis)
    a = p[i] - s[ROUND_U]
    b = p[j] - s[ROUND_V]
    r = sqrt(a * a + b * b)
    h, low, high = p[axis], s[ROUND_LOW], s[ROUND_HIGH]
    radius = _cone_radius(s, h)
    down, up, near = vector(3), vector(3), vector(3)
    if r > 0.0:
        _rim(s, p, s[ROUND_RADIUS], low, down)
        _rim(s, p, s[CONE_RADIUS], high, up)
        _on_segment(down, up, p, near)
    if not outer:
        if r > radius or h < low or h > high:
            return 0
        n = 0
        if r > 0.0 and sqrt(_squared(p, near)) < cut:
            for d in range(3):
                delta[n, d] = p[d] - near[d]
            n += 1
        for side in range(SIDES):
            gap = high - h if side else h - low
            if gap < cut:
                for d in range(3):
                    delta[n, d] = 0.0
                delta[n, axis] = -gap if side else gap
                n += 1
        return n
    if r == 0.0 or r >= max(s[ROUND_RADIUS], s[CONE_RADIUS]) + cut:
        return 0
    if h <= low - cut or h >= high + cut or (r < radius and low < h < high):
        return 0
    end, point, best = vector(3), vector(3), _squared(p, near)
    for d in range(3):
        delta[ONLY, d] = p[d] - near[d]
    for side in range(SIDES):
        end[i], end[j], end[axis] = s[ROUND_U], s[ROUND_V], high if side else low
        if _squared(end, up if side else down) == 0.0:
            continue  # the tip
        _on_segment(up if side else down, end, p, point)
        if _squared(p, point) < best:
            best = _squared(p, point)
            for d in range(3):
                delta[ONLY, d] = p[d] - point[d]
    return 1 if sqrt(best) < cut else 0


# -- prism -----------------------------------------------------------------------------------------


@inlined
def in_prism(s: NDArray[np.float64], p: NDArray[np.float64]) -> bool:
    """Tell whether a point is in a prism or on its surface."""
    x, y, z = p[X] - s[PRISM_LOW + X], p[Y] - s[PRISM_LOW + Y], p[Z] - s[PRISM_LOW + Z]
    a = s[PRISM_XX] * x + s[PRISM_XY] * y + s[PRISM_XZ] * z
    b = s[PRISM_YY] * y + s[PRISM_YZ] * z
    c = s[PRISM_ZZ] * z
    return 0.0 <= a <= 1.0 and 0.0 <= b <= 1.0 and 0.0 <= c <= 1.0


@inlined
def _face_gap(s: NDArray[np.float64], p: NDArray[np.float64], face: int) -> float:
    """Return how far inside of a face a point is; faces at the first corner are even."""
    corner = PRISM_HIGH if face % SIDES else PRISM_LOW
    n = PRISM_NORMAL + VECTOR * (face // SIDES)
    gap = (
        (p[X] - s[corner + X]) * s[n + X]
        + (p[Y] - s[corner + Y]) * s[n + Y]
        + (p[Z] - s[corner + Z]) * s[n + Z]
    )
    return -gap if face % SIDES else gap


@inlined
def _on_face(s: NDArray[np.float64], p: NDArray[np.float64], face: int, out: NDArray) -> None:
    """Write the point of a face of a prism that is nearest to `p`."""
    k = face // SIDES
    first, second, across = PRISM_EDGE, PRISM_EDGE + VECTOR, PRISM_EDGE + 2 * VECTOR
    if k == Y:
        first, second, across = PRISM_EDGE + 2 * VECTOR, PRISM_EDGE, PRISM_EDGE + VECTOR
    elif k == Z:
        first, second, across = PRISM_EDGE + VECTOR, PRISM_EDGE + 2 * VECTOR, PRISM_EDGE
    corner, foot, start, end = vector(3), vector(3), vector(3), vector(3)
    gap = _face_gap(s, p, face)
    sign = -1.0 if face % SIDES else 1.0
    for d in range(3):
        corner[d] = s[PRISM_LOW + d] + (s[across + d] if face % SIDES else 0.0)
        foot[d] = p[d] - gap * sign * s[PRISM_NORMAL + VECTOR * k + d]
    # place of the foot along the two edges of the face
    uu, uv, vv, fu, fv = 0.0, 0.0, 0.0, 0.0, 0.0
    for d in range(3):
        u, v, f = s[first + d], s[second + d], foot[d] - corner[d]
        uu, uv, vv, fu, fv = uu + u * u, uv + u * v, vv + v * v, fu + f * u, fv + f * v
    a = (fu * vv - fv * uv) / (uu * vv - uv * uv)
    b = (fv * uu - fu * uv) / (uu * vv - uv * uv)
    for d in range(3):
        out[d] = foot[d]
    if 0.0 <= a <= 1.0 and 0.0 <= b <= 1.0:
        return
    best = _FAR
    for edge in range(EDGES):
        along = edge < SIDES  # the edges beside the first one
        for d in range(3):
            shift = (s[second + d] if along else s[first + d]) if edge % SIDES else 0.0
            start[d] = corner[d] + shift
            end[d] = start[d] + (s[first + d] if along else s[second + d])
        _on_segment(start, end, p, foot)
        if _squared(p, foot) < best:
            best = _squared(p, foot)
            for d in range(3):
                out[d] = foot[d]


@inner
def prism_contacts(
    outer: bool, s: NDArray[np.float64], p: NDArray[np.float64], cut: float, delta: NDArray
) -> int:
    """Find surface points of a prism nearer than `cut`."""
    least = _FAR
    for face in range(FACES):
        least = min(least, _face_gap(s, p, face))
    if not outer:
        if least < 0.0:
            return 0
        n = 0
        for face in range(FACES):
            gap = _face_gap(s, p, face)
            if gap < cut:
                sign = -gap if face % SIDES else gap
                for d in range(3):
                    delta[n, d] = sign * s[PRISM_NORMAL + VECTOR * (face // SIDES) + d]
                n += 1
        return n
    if least <= -cut or least > 0.0:
        return 0
    point, best = vector(3), _FAR
    for face in range(FACES):
        _on_face(s, p, face, point)
        if _squared(p, point) < best:
            best = _squared(p, point)
            for d in range(3):
                delta[ONLY, d] = p[d] - point[d]
    return 1 if sqrt(best) < cut else 0
