"""Body forces and constraints of a step, and the weight that comes before walls."""

from __future__ import annotations

from math import pi, sqrt
from typing import Any

from minidem.kernels.columns import (  # isort: skip
    X, Y, Z, RADIUS, VX, VY, VZ, MASS, FX, FY, FZ, POST_KIND, POST_GROUP, POST_AXES, POST_VECTOR,
    POST_VISCOUS, DRAG_FACTOR, DRAG_DENSITY, DRAG_VISCOSITY, DRAG_GAS,
)  # fmt: skip
from minidem.kernels.machine.jit import inlined, inner, kernel

__all__ = ["LEADER", "POST_KINDS", "apply_posts", "apply_range", "lead"]

POST_KINDS = ("gravity", "viscous", "setforce", "addforce", "freeze", "drag/sphere")
"""Kinds of forces, in the order of the numbers that a table of posts has for them."""

GRAVITY, VISCOUS, SETFORCE, ADDFORCE, FREEZE, DRAG = range(len(POST_KINDS))
LEADER = 0
"""The post that may come before all walls."""


@inner
def lead(n: int, parts: Any, posts: Any, first: int) -> None:
    """Reset the forces: to the weight if gravity comes before all walls, else to zero."""
    force = parts.force
    for i in range(n):
        for c in range(6):
            force[i, c] = 0.0
        if first == 1 and parts.mask[i] & posts.spec[LEADER, POST_GROUP]:
            for c in range(3):
                force[i, c] = parts.row[i, MASS] * posts.value[LEADER, POST_VECTOR + c]


@inlined
def _drag(radius: float, speed: float, factor: float, density: float, viscosity: float) -> Any:
    """Return drag over relative speed, kg/s (Schiller and Naumann; Newton above Re = 1000)."""
    diameter = 2.0 * radius
    reynolds = density * speed * diameter / viscosity
    if reynolds > 1000.0:
        return factor * 0.44 * density * pi / 8.0 * diameter * diameter * speed
    return factor * 3.0 * pi * viscosity * diameter * (1.0 + 0.15 * reynolds**0.687)


@inner
def apply_posts(n: int, parts: Any, posts: Any, first: int, count: int) -> None:
    """Apply body forces and constraints in the order of their fixes."""
    row = parts.row
    force = parts.force
    for p in range(first, count):
        kind = posts.spec[p, POST_KIND]
        bit = posts.spec[p, POST_GROUP]
        axes = posts.spec[p, POST_AXES]
        px = posts.value[p, POST_VECTOR + X]
        py = posts.value[p, POST_VECTOR + Y]
        pz = posts.value[p, POST_VECTOR + Z]
        viscous = posts.value[p, POST_VISCOUS]
        factor = posts.value[p, DRAG_FACTOR]
        tx = 0.0
        ty = 0.0
        tz = 0.0
        for i in range(n):
            if not parts.mask[i] & bit:
                continue
            tx += force[i, FX]
            ty += force[i, FY]
            tz += force[i, FZ]
            if kind == GRAVITY:
                force[i, FX] += row[i, MASS] * px
                force[i, FY] += row[i, MASS] * py
                force[i, FZ] += row[i, MASS] * pz
            elif kind == VISCOUS:
                force[i, FX] -= viscous * row[i, VX]
                force[i, FY] -= viscous * row[i, VY]
                force[i, FZ] -= viscous * row[i, VZ]
            elif kind == SETFORCE:
                if axes & 1 << X:
                    force[i, FX] = px
                if axes & 1 << Y:
                    force[i, FY] = py
                if axes & 1 << Z:
                    force[i, FZ] = pz
            elif kind == ADDFORCE:
                force[i, FX] += px
                force[i, FY] += py
                force[i, FZ] += pz
            elif kind == FREEZE:
                for c in range(6):
                    force[i, FX + c] = 0.0
            elif factor > 0.0:
                ux = posts.value[p, DRAG_GAS + X] - row[i, VX]
                uy = posts.value[p, DRAG_GAS + Y] - row[i, VY]
                uz = posts.value[p, DRAG_GAS + Z] - row[i, VZ]
                rate = _drag(
                    row[i, RADIUS], sqrt(ux * ux + uy * uy + uz * uz), factor,
                    posts.value[p, DRAG_DENSITY], posts.value[p, DRAG_VISCOSITY],
                )  # fmt: skip
                force[i, FX] += rate * ux
                force[i, FY] += rate * uy
                force[i, FZ] += rate * uz
        posts.total[p, X] = tx
        posts.total[p, Y] = ty
        posts.total[p, Z] = tz


@kernel
def apply_range(n: int, parts: Any, posts: Any, first: int, count: int) -> None:
    """Apply some of the body forces, between those that need script variables."""
    apply_posts(n, parts, posts, first, count)
