"""One contact of a particle with a wall: where it is, what it remembers, and its force."""

from __future__ import annotations

from math import sqrt
from typing import Any

from minidem.kernels.columns import (  # isort: skip
    X, Y, Z, RADIUS, VX, VY, VZ, MASS, WX, WY, WZ, FX, FY, FZ, TX, TY, TZ, SX, SY, SZ, MX, MY,
    MZ, IMPACT, WITH_IMPACT, WALL_SHAPE, WALL_AXIS, WALL_TYPE, WALL_TURNS, WALL_MODEL, PLANE,
    WALL_PLACE, WALL_CENTRE, WALL_CENTRE_NEXT, WALL_VELOCITY, WALL_SPIN, HANDLED, YOUNG, SHEAR,
    DAMPING, FRICTION, ROLLING_FRICTION, COHESION_ENERGY, ROLLING_DAMPING, LOG_RESTITUTION,
    CHARACTERISTIC_SPEED, NORMAL, TANGENTIAL, ROLLING, COHESION, TANGENTIAL_DAMPING,
    LIMIT_FORCE, TORSION_TORQUE, TANGENTIAL_REDUCE, KT_TO_KN, WEAKENS, SLOWS,
)  # fmt: skip
from minidem.kernels.contact.extended import extended_contact
from minidem.kernels.contact.law import contact_law, wall_area
from minidem.kernels.contact.triangle import coplanar
from minidem.kernels.machine.jit import inlined, inner

__all__ = ["inherit", "lone", "primitive", "push"]


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
    for c in range(WITH_IMPACT):
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
        for c in range(WITH_IMPACT):
            hist[k, c] = hist[source, c]
    return True


@inlined
def primitive(prim: Any, value: Any, w: int, x: float, y: float, z: float) -> Any:
    """Return distance and vector from primitive wall w to a point, and its velocity there."""
    axis = prim[w, WALL_AXIS]
    ux = value[w, WALL_VELOCITY + X]
    uy = value[w, WALL_VELOCITY + Y]
    uz = value[w, WALL_VELOCITY + Z]
    if prim[w, WALL_SHAPE] == PLANE:
        d = (x if axis == X else (y if axis == Y else z)) - value[w, WALL_PLACE]
        dx = d if axis == X else 0.0
        dy = d if axis == Y else 0.0
        dz = d if axis == Z else 0.0
        return abs(d), dx, dy, dz, ux, uy, uz
    px = (
        0.0
        if axis == X
        else x - (value[w, WALL_CENTRE] if axis == Z else value[w, WALL_CENTRE_NEXT])
    )
    py = (
        0.0
        if axis == Y
        else y - (value[w, WALL_CENTRE] if axis == X else value[w, WALL_CENTRE_NEXT])
    )
    pz = (
        0.0
        if axis == Z
        else z - (value[w, WALL_CENTRE] if axis == Y else value[w, WALL_CENTRE_NEXT])
    )
    far = sqrt(px * px + py * py + pz * pz)
    if far == 0.0:
        return 0.0, 0.0, 0.0, 0.0, ux, uy, uz
    scale = (far - value[w, WALL_PLACE]) / far
    # turning about its own axis: spin x radius; for the y axis LIGGGHTS exchanges x and z
    if prim[w, WALL_TURNS] == 1:
        spin = value[w, WALL_SPIN]
        ux = spin * (px if axis == Y else -py) if axis != X else 0.0
        uy = spin * (px if axis == Z else -pz) if axis != Y else 0.0
        uz = spin * (py if axis == X else -pz) if axis != Z else 0.0
    return abs(far - value[w, WALL_PLACE]), px * scale, py * scale, pz * scale, ux, uy, uz


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
    radius = row[i, RADIUS]
    mass = row[i, MASS]
    overlap = radius - r
    inv = 1.0 / r
    sticky = spec[at, WALL_MODEL + COHESION]
    area = wall_area(sticky, r, radius, overlap) if sticky != 0 else 0.0
    arm = radius - 0.5 * overlap
    q = parts.kind[i] * types + spec[at, WALL_TYPE]
    wx = arm * spin[i, WX] * inv
    wy = arm * spin[i, WY] * inv
    wz = arm * spin[i, WZ] * inv
    damping = coef[q, DAMPING]
    friction = coef[q, FRICTION]
    loss = coef[q, LOG_RESTITUTION]
    if spec[at, WALL_MODEL + WEAKENS] | spec[at, WALL_MODEL + SLOWS]:
        damping, friction, loss, hist[k, IMPACT] = extended_contact(
            spec[at, WALL_MODEL + WEAKENS], spec[at, WALL_MODEL + SLOWS], coef, q, update, hist[k,
            IMPACT],
            dx * inv, dy * inv, dz * inv, dx, dy, dz,
            row[i, VX] - ux, row[i, VY] - uy, row[i, VZ] - uz, wx, wy, wz,
        )  # fmt: skip
    (fx, fy, fz, tx, ty, tz, rx, ry, rz,
     hist[k, SX], hist[k, SY], hist[k, SZ], hist[k, MX], hist[k, MY], hist[k, MZ]) = contact_law(
        spec[at, WALL_MODEL + NORMAL], spec[at, WALL_MODEL + TANGENTIAL], spec[at,
        WALL_MODEL + ROLLING], sticky,
        spec[at, WALL_MODEL + TANGENTIAL_DAMPING], spec[at, WALL_MODEL + LIMIT_FORCE], spec[at,
        WALL_MODEL + TORSION_TORQUE],
        spec[at, WALL_MODEL + TANGENTIAL_REDUCE], spec[at, WALL_MODEL + KT_TO_KN],
        coef[q, YOUNG], coef[q, SHEAR], damping, friction, coef[q, ROLLING_FRICTION], coef[q,
        COHESION_ENERGY], coef[q, ROLLING_DAMPING],
        loss, coef[q, CHARACTERISTIC_SPEED], update, dt, overlap, area, radius, mass,
        1.4 * mass * radius * radius, dx * inv, dy * inv, dz * inv, dx, dy, dz,
        row[i, VX] - ux, row[i, VY] - uy, row[i, VZ] - uz, wx, wy, wz, wx, wy, wz,
        hist[k, SX], hist[k, SY], hist[k, SZ], hist[k, MX], hist[k, MY], hist[k, MZ],
    )  # fmt: skip
    force[i, FX] += fx
    force[i, FY] += fy
    force[i, FZ] += fz
    force[i, TX] += -arm * tx - rx
    force[i, TY] += -arm * ty - ry
    force[i, TZ] += -arm * tz - rz
    return fx, fy, fz


@inlined
def push(
    m: int, origin: Any, load: Any, x: float, y: float, z: float, fx: float, fy: float, fz: float
) -> None:
    """Add the reaction to a force at a point of mesh m to the load of that mesh."""
    load[m, FX] -= fx
    load[m, FY] -= fy
    load[m, FZ] -= fz
    px = x - origin[m, X]
    py = y - origin[m, Y]
    pz = z - origin[m, Z]
    load[m, TX] -= py * fz - pz * fy
    load[m, TY] -= pz * fx - px * fz
    load[m, TZ] -= px * fy - py * fx
