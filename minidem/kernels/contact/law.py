"""The contact law: from the kinematics of one contact to force, torques and new history.

One function serves particle pairs (its model switches are constants there, and the branches
vanish at compile time) and walls (the switches come from a table). Formulas are those of
LIGGGHTS-PUBLIC 3.8.0, normal models ``hertz`` and ``hooke``, tangential ``history`` and
``no_history``, rolling ``cdt``, ``epsd``, ``epsd2``, cohesion ``sjkr``, ``sjkr2``.
"""

from __future__ import annotations

from math import pi, sqrt
from typing import Any

from minidem.kernels.machine.jit import inlined

__all__ = ["COLUMNS", "SWITCHES", "contact_law", "pair_area", "wall_area"]

SWITCHES = (
    "normal",
    "tangential",
    "rolling",
    "cohesion",
    "tangential_damping",
    "limit_force",
    "torsion_torque",
    "tangential_reduce",
    "kt_to_kn",
    "static_friction",
    "velocity_restitution",
)
"""Meaning of the eleven model switches, in order; the last two are extensions of minidem.

normal 0 hertz 1 hooke; tangential 0 none 1 history 2 no_history; rolling 0 off 1 cdt 2 epsd
3 epsd2; cohesion 0 off 1 sjkr 2 sjkr2; the rest 0 off 1 on.
"""

COLUMNS = (
    "young",  # effective Young's modulus, Pa
    "shear",  # effective shear modulus, Pa
    "damping",  # -2 sqrt(5/6) B with B = ln e / sqrt(ln(e)^2 + pi^2)
    "spare",
    "friction",
    "rolling",
    "cohesion",  # cohesion energy density, J/m3
    "viscous",  # rolling viscous damping ratio (epsd)
    "log_restitution",
    "velocity",  # characteristic velocity (hooke), m/s
    "static",  # static friction
    "weakening",  # sliding speed over which static becomes kinetic friction, m/s
    "exponent",  # of the impact speed in the restitution
    "reference",  # impact speed above which restitution falls, m/s
)
"""Columns of a coefficient row; one row per ordered pair of types."""

KT_TO_KN = 0.285714286  # 2/7 as LIGGGHTS writes it


@inlined
def pair_area(kind: int, r: float, ri: float, rj: float, overlap: float) -> Any:
    """Return the contact area of two particles that the cohesion model uses, m2."""
    if kind == 1:
        return -pi / 4.0 * ((r - ri - rj) * (r + ri - rj) * (r - ri + rj) * (r + ri + rj)) / (r * r)
    return 2.0 * pi * (2.0 * ri * rj / (ri + rj)) * overlap


@inlined
def wall_area(kind: int, r: float, ri: float, overlap: float) -> Any:
    """Return the contact area of a particle and a wall that the cohesion model uses, m2."""
    if kind == 1:
        return pi * (ri * ri - r * r)
    return 2.0 * pi * ri * overlap


@inlined
def contact_law(
    normal: int, tangential: int, rolling: int, cohesion: int, damped: int, limited: int,
    torsion: int, reduce: int, kt_to_kn: int,
    young: float, shear: float, damping: float, friction: float, resist: float, density: float,
    viscous: float, loss: float, speed: float,
    update: int, dt: float, overlap: float, area: float, reff: float, meff: float, inertia: float,
    nx: float, ny: float, nz: float, dx: float, dy: float, dz: float,
    vx: float, vy: float, vz: float, wx: float, wy: float, wz: float,
    ux: float, uy: float, uz: float, sx: float, sy: float, sz: float,
    mx: float, my: float, mz: float,
) -> Any:  # fmt: skip
    """Return force on i, tangential lever n x Ft, rolling torque, and the new history.

    Parameters
    ----------
    normal .. kt_to_kn : int
        Model switches, see `SWITCHES`.
    young .. speed : float
        Coefficients of the pair of types, see `COLUMNS`.
    update : int
        1 in a time step, 0 at setup (history is used but does not advance).
    dt, overlap, area, reff, meff, inertia : float
        Step, s; overlap, m; cohesion area, m2; effective radius, mass and rolling inertia.
    nx .. nz, dx .. dz : float
        Unit normal from j to i and the vector between the centres (or wall point and centre).
    vx .. vz, wx .. wz, ux .. uz : float
        Relative velocity, weighted spin ``(cri wi + crj wj)/r`` and relative spin.
    sx .. sz, mx .. mz : float
        Tangential displacement and spring torque stored for this contact.

    Returns
    -------
    tuple of 15 float
        Force on i; n x Ft; rolling torque M (i gets -M); displacement; stored torque.
    """
    s = sqrt(reff * overlap)
    # the order of operations is LIGGGHTS', so that few-body trajectories agree to the last bits
    if normal == 0:
        kn = 4.0 / 3.0 * young * s
        kt = 8.0 * shear * s
        gn = damping * sqrt(2.0 * young * s * meff)
        gt = damping * sqrt(kt * meff)
    else:
        sq = sqrt(reff)
        kn = 16.0 / 15.0 * sq * young * (15.0 * meff * speed * speed / (16.0 * sq * young)) ** 0.2
        kt = kn
        if kt_to_kn == 1:
            kt = kn * KT_TO_KN
        log2 = loss * loss
        gn = sqrt(4.0 * meff * kn * log2 / (log2 + pi * pi))
        gt = gn
    if damped == 0:
        gt = 0.0
    vn = vx * nx + vy * ny + vz * nz
    elastic = kn * overlap
    fn = elastic - gn * vn
    if limited == 1 and fn < 0.0:
        fn = 0.0
    force = fn
    if cohesion != 0:
        pull = -density * area
        force += pull
        if reduce == 1:
            fn += pull
    hold = abs(fn)
    # tangential velocity of the surfaces
    tx = vx - vn * nx - (wy * dz - wz * dy)
    ty = vy - vn * ny - (wz * dx - wx * dz)
    tz = vz - vn * nz - (wx * dy - wy * dx)
    fx = 0.0
    fy = 0.0
    fz = 0.0
    if tangential == 1:
        if update == 1:
            sx += tx * dt
            sy += ty * dt
            sz += tz * dt
            along = sx * nx + sy * ny + sz * nz
            sx -= along * nx
            sy -= along * ny
            sz -= along * nz
        fx = -kt * sx
        fy = -kt * sy
        fz = -kt * sz
        spring2 = fx * fx + fy * fy + fz * fz
        limit = friction * hold
        if spring2 > limit * limit or limit < 0.0:
            if spring2 > 0.0:
                scale = limit / sqrt(spring2)
                fx *= scale
                fy *= scale
                fz *= scale
                if update == 1:
                    sx = -fx / kt
                    sy = -fy / kt
                    sz = -fz / kt
        else:
            fx -= gt * tx
            fy -= gt * ty
            fz -= gt * tz
    elif tangential == 2:
        slip = sqrt(tx * tx + ty * ty + tz * tz)
        if slip > 0.0:
            ft = min(friction * hold, gt * slip) / slip
            fx = -ft * tx
            fy = -ft * ty
            fz = -ft * tz
    ax = 0.0
    ay = 0.0
    az = 0.0
    if rolling == 1:
        spin = sqrt(ux * ux + uy * uy + uz * uz)
        if spin > 0.0:
            scale = resist * elastic * reff / spin
            ax = scale * ux
            ay = scale * uy
            az = scale * uz
            if torsion == 0:
                along = ax * nx + ay * ny + az * nz
                ax -= along * nx
                ay -= along * ny
                az -= along * nz
    elif rolling >= 2:
        if torsion == 0:
            along = ux * nx + uy * ny + uz * nz
            ux -= along * nx
            uy -= along * ny
            uz -= along * nz
        kr = 2.25 * kn * resist * resist * reff * reff if rolling == 2 else kt * reff * reff
        ax = mx + kr * dt * ux
        ay = my + kr * dt * uy
        az = mz + kr * dt * uz
        spring2 = ax * ax + ay * ay + az * az
        limit = resist * reff * hold
        full = spring2 > limit * limit
        if full:
            scale = limit / sqrt(spring2)
            ax *= scale
            ay *= scale
            az *= scale
        if update == 1:
            mx = ax
            my = ay
            mz = az
        if rolling == 2 and not full:
            damp = viscous * 2.0 * sqrt(inertia * kr)
            ax += damp * ux
            ay += damp * uy
            az += damp * uz
    return (
        force * nx + fx, force * ny + fy, force * nz + fz,
        ny * fz - nz * fy, nz * fx - nx * fz, nx * fy - ny * fx,
        ax, ay, az, sx, sy, sz, mx, my, mz,
    )  # fmt: skip
