"""One contact of a particle with a wall: where it is, what it remembers, and its force."""

from __future__ import annotations

from math import sqrt
from typing import Any

from minidem.kernels.contact.extended import IMPACT, extended_contact
from minidem.kernels.contact.law import contact_law, wall_area
from minidem.kernels.contact.triangle import coplanar
from minidem.kernels.machine.jit import inlined, inner

__all__ = ["EARLIER", "HANDLED", "WIDE", "inherit", "lone", "primitive", "push"]

EARLIER = 1
HANDLED = 2
"""Bits of ``Walls.touch``: in contact since before; handled in this step."""
MODEL = 5  # first column of the switches in the tables
WIDE = 7
"""Columns of a wall history."""


@inner
def inherit(
    hist: Any,
    touch: Any,
    code: Any,
    owner: Any,
    node: Any,
    normal: Any,
    curve: Any,
    base: Any,
    k: int,
    lo: int,
    hi: int,
    face: int,
) -> bool:
    """Prepare the history of a new contact; return False if a coplanar neighbour has it already."""
    t = code[k]
    m = owner[t]
    for c in range(WIDE):
        hist[k, c] = 0.0
    if face == 0:
        return True
    source = k
    for other in range(lo, hi):
        u = code[other]
        if other == k or u < 0 or touch[other] == 0 or owner[u] != m:
            continue
        near = coplanar(node, normal, t, u, curve[m])
        if not near and (base[t] != t or base[u] != u):
            # images count as neighbours where their triangles are, as in LIGGGHTS
            near = coplanar(node, normal, t, base[u], curve[m]) or coplanar(
                node, normal, base[t], base[u], curve[m]
            )
        if near:
            if touch[other] & HANDLED:
                return False
            source = other
    if source != k:
        for c in range(WIDE):
            hist[k, c] = hist[source, c]
    return True


@inlined
def primitive(prim: Any, value: Any, w: int, x: float, y: float, z: float) -> Any:
    """Return distance and vector from primitive wall w to a point, and its velocity there."""
    axis = prim[w, 1]
    ux = value[w, 3]
    uy = value[w, 4]
    uz = value[w, 5]
    if prim[w, 0] == 0:
        d = (x if axis == 0 else (y if axis == 1 else z)) - value[w, 0]
        dx = d if axis == 0 else 0.0
        dy = d if axis == 1 else 0.0
        dz = d if axis == 2 else 0.0
        return abs(d), dx, dy, dz, ux, uy, uz
    px = 0.0 if axis == 0 else x - (value[w, 1] if axis == 2 else value[w, 2])
    py = 0.0 if axis == 1 else y - (value[w, 1] if axis == 0 else value[w, 2])
    pz = 0.0 if axis == 2 else z - (value[w, 1] if axis == 1 else value[w, 2])
    far = sqrt(px * px + py * py + pz * pz)
    if far == 0.0:
        return 0.0, 0.0, 0.0, 0.0, ux, uy, uz
    scale = (far - value[w, 0]) / far
    # turning about its own axis: spin x radius; for the y axis LIGGGHTS exchanges x and z
    if prim[w, 4] == 1:
        spin = value[w, 6]
        ux = spin * (px if axis == 1 else -py) if axis != 0 else 0.0
        uy = spin * (px if axis == 2 else -pz) if axis != 1 else 0.0
        uz = spin * (py if axis == 0 else -pz) if axis != 2 else 0.0
    return abs(far - value[w, 0]), px * scale, py * scale, pz * scale, ux, uy, uz


@inner
def lone(
    i: int, k: int, spec: Any, at: int, r: float, dx: float, dy: float, dz: float,
    ux: float, uy: float, uz: float, parts: Any, hist: Any, coef: Any,
    types: int, update: int, dt: float,
) -> Any:  # fmt: skip
    """Add the force of one contact with a wall of any model to its particle, and return it."""
    row = parts.row
    spin = parts.spin
    force = parts.force
    radius = row[i, 3]
    mass = row[i, 7]
    overlap = radius - r
    inv = 1.0 / r
    sticky = spec[at, MODEL + 3]
    area = wall_area(sticky, r, radius, overlap) if sticky != 0 else 0.0
    arm = radius - 0.5 * overlap
    q = parts.kind[i] * types + spec[at, 2]
    wx = arm * spin[i, 0] * inv
    wy = arm * spin[i, 1] * inv
    wz = arm * spin[i, 2] * inv
    damping = coef[q, 2]
    friction = coef[q, 4]
    loss = coef[q, 8]
    if spec[at, MODEL + 9] | spec[at, MODEL + 10]:
        damping, friction, loss, hist[k, IMPACT] = extended_contact(
            spec[at, MODEL + 9], spec[at, MODEL + 10], coef, q, update, hist[k, IMPACT],
            dx * inv, dy * inv, dz * inv, dx, dy, dz,
            row[i, 4] - ux, row[i, 5] - uy, row[i, 6] - uz, wx, wy, wz,
        )  # fmt: skip
    (fx, fy, fz, tx, ty, tz, rx, ry, rz,
     hist[k, 0], hist[k, 1], hist[k, 2], hist[k, 3], hist[k, 4], hist[k, 5]) = contact_law(
        spec[at, MODEL], spec[at, MODEL + 1], spec[at, MODEL + 2], sticky,
        spec[at, MODEL + 4], spec[at, MODEL + 5], spec[at, MODEL + 6],
        spec[at, MODEL + 7], spec[at, MODEL + 8],
        coef[q, 0], coef[q, 1], damping, friction, coef[q, 5], coef[q, 6], coef[q, 7],
        loss, coef[q, 9], update, dt, overlap, area, radius, mass,
        1.4 * mass * radius * radius, dx * inv, dy * inv, dz * inv, dx, dy, dz,
        row[i, 4] - ux, row[i, 5] - uy, row[i, 6] - uz, wx, wy, wz, wx, wy, wz,
        hist[k, 0], hist[k, 1], hist[k, 2], hist[k, 3], hist[k, 4], hist[k, 5],
    )  # fmt: skip
    force[i, 0] += fx
    force[i, 1] += fy
    force[i, 2] += fz
    force[i, 3] += -arm * tx - rx
    force[i, 4] += -arm * ty - ry
    force[i, 5] += -arm * tz - rz
    return fx, fy, fz


@inlined
def push(
    m: int, origin: Any, load: Any, x: float, y: float, z: float, fx: float, fy: float, fz: float
) -> None:
    """Add the reaction to a force at a point of mesh m to the load of that mesh."""
    load[m, 0] -= fx
    load[m, 1] -= fy
    load[m, 2] -= fz
    px = x - origin[m, 0]
    py = y - origin[m, 1]
    pz = z - origin[m, 2]
    load[m, 3] -= py * fz - pz * fy
    load[m, 4] -= pz * fx - px * fz
    load[m, 5] -= px * fy - py * fx
