"""The contact law: from the kinematics of one contact to force, torques and new history.

One function serves particle pairs (its model switches are constants there, and the branches
vanish at compile time) and walls (the switches come from a table). Formulas are those of
LIGGGHTS-PUBLIC 3.8.0, normal models ``hertz`` and ``hooke``, tangential ``history`` and
``no_history``, rolling ``cdt``, ``epsd``, ``epsd2``, cohesion ``sjkr``, ``sjkr2``. What comes after
the normal model serves those of `minidem.kernels.contact.normal` too, which the loops that are
compiled for their models leave to the general one.
"""

from __future__ import annotations

from math import pi, sqrt
from typing import Any

from minidem.kernels.contact.laws.luding import turn_luding
from minidem.kernels.contact.records import Load, Memory, Reaction
from minidem.kernels.machine.jit import inlined
from minidem.kernels.models import (
    CDT,
    EASO,
    EPSD,
    EPSD2,
    HERTZ,
    HISTORY,
    NO_HISTORY,
    ROLL_LUDING,
    SJKR,
    TAN_LUDING,
)

__all__ = [
    "approach",
    "contact_law",
    "hooke_stiffness",
    "pair_area",
    "respond",
    "spring",
    "wall_area",
]

TWO_SEVENTHS = 0.285714286  # 2/7 as LIGGGHTS writes it
EPSD_STIFFNESS = 2.25  # factor of the rolling stiffness of epsd


@inlined
def pair_area(kind: int, r: float, ri: float, rj: float, overlap: float) -> Any:
    """Return the contact area of two particles that the cohesion model uses, m2."""
    if kind == SJKR:
        return -pi / 4.0 * ((r - ri - rj) * (r + ri - rj) * (r - ri + rj) * (r + ri + rj)) / (r * r)
    return 2.0 * pi * (2.0 * ri * rj / (ri + rj)) * overlap


@inlined
def wall_area(kind: int, r: float, ri: float, overlap: float) -> Any:
    """Return the contact area of a particle and a wall that the cohesion model uses, m2."""
    if kind == SJKR:
        return pi * (ri * ri - r * r)
    return 2.0 * pi * ri * overlap


@inlined
def contact_law(
    switches: Any, material: Any, contact: Any, memory: Any, update: int, dt: float
) -> Any:
    """Return what a contact does, and what it keeps.

    Parameters
    ----------
    switches : Switches
        Models.
    material : Material
        Coefficients of the pair of types.
    contact : Contact
        Geometry and motion.
    memory : Memory
        What the contact kept.
    update : int
        1 in a time step, 0 at setup (memory is used but does not advance).
    dt : float
        Step, s.

    Returns
    -------
    Reaction
        Force and torques.
    Memory
        To keep.
    """
    load = spring(switches, material, contact)
    return respond(switches, material, contact, memory, load, update, dt)


@inlined
def spring(switches: Any, material: Any, contact: Any) -> Any:
    """Return the `Load` of ``hertz`` and ``hooke``."""
    young = material.young
    overlap = contact.overlap
    reff = contact.radius
    meff = contact.mass
    s = sqrt(reff * overlap)
    # the order of operations is LIGGGHTS', so that few-body trajectories agree to the last bits
    if switches.normal == HERTZ:
        kn = 4.0 / 3.0 * young * s
        kt = 8.0 * material.shear * s
        gn = material.damping * sqrt(2.0 * young * s * meff)
        gt = material.damping * sqrt(kt * meff)
    else:
        kn = hooke_stiffness(material, contact)
        kt = kn
        if switches.kt_to_kn == 1:
            kt = kn * TWO_SEVENTHS
        log2 = material.log_restitution * material.log_restitution
        gn = sqrt(4.0 * meff * kn * log2 / (log2 + pi * pi))
        gt = gn
    if switches.tangential_damping == 0:
        gt = 0.0
    elastic = kn * overlap
    fn = elastic - gn * approach(contact)
    if switches.limit_force == 1 and fn < 0.0:
        fn = 0.0
    return Load(kn, kt, gt, elastic, fn, 0.0, 1.0, 1.0, 1.0, EPSD_STIFFNESS, 0.0, 0.0, 0.0)


@inlined
def hooke_stiffness(material: Any, contact: Any) -> Any:
    """Return the normal stiffness of ``hooke``, N/m."""
    young = material.young
    sq = sqrt(contact.radius)
    return (
        16.0
        / 15.0
        * sq
        * young
        * (15.0 * contact.mass * material.speed * material.speed / (16.0 * sq * young)) ** 0.2
    )


@inlined
def approach(contact: Any) -> Any:
    """Return the normal relative velocity, below zero while two bodies approach, m/s."""
    return contact.vx * contact.nx + contact.vy * contact.ny + contact.vz * contact.nz


@inlined
def respond(
    switches: Any, material: Any, contact: Any, memory: Any, load: Any, update: int, dt: float
) -> Any:
    """Return what a contact of any normal model does, and what it keeps, as `contact_law` does.

    Parameters
    ----------
    load : Load
        What the normal model gives.
    switches, material, contact, memory, update, dt
        As for `contact_law`.
    """
    nx, ny, nz = contact.nx, contact.ny, contact.nz
    dx, dy, dz = contact.dx, contact.dy, contact.dz
    vx, vy, vz = contact.vx, contact.vy, contact.vz
    wx, wy, wz = contact.wx, contact.wy, contact.wz
    ux, uy, uz = contact.ux, contact.uy, contact.uz
    sx, sy, sz, mx, my, mz = memory
    friction = material.friction
    resist = material.rolling
    reff = contact.radius
    kn, kt, gt = load.kn, load.kt, load.gt
    vn = approach(contact)
    fn = load.force
    force = fn
    if switches.cohesion != 0:
        pull = load.pull if switches.cohesion >= EASO else -material.cohesion * contact.area
        force += pull
        if switches.tangential_reduce == 1:
            fn += pull
    hold = abs(fn)
    # tangential velocity of the surfaces
    tx = vx - vn * nx - (wy * dz - wz * dy)
    ty = vy - vn * ny - (wz * dx - wx * dz)
    tz = vz - vn * nz - (wx * dy - wy * dx)
    fx = 0.0
    fy = 0.0
    fz = 0.0
    if switches.tangential == HISTORY or switches.tangential == TAN_LUDING:
        limit = friction * hold
        sliding = limit
        if switches.tangential == TAN_LUDING:
            kt *= load.slide_stiffness
            gt *= load.slide_damping
            limit = friction * abs(fn + load.held)
            sliding = limit * load.slip
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
        stretched = kt * sqrt(sx * sx + sy * sy + sz * sz)
        if stretched > limit or limit < 0.0:
            if stretched > 0.0:
                scale = sliding / stretched
                fx *= scale
                fy *= scale
                fz *= scale
                if update == 1 or switches.tangential == TAN_LUDING:
                    sx = -fx / kt
                    sy = -fy / kt
                    sz = -fz / kt
        else:
            fx -= gt * tx
            fy -= gt * ty
            fz -= gt * tz
    elif switches.tangential == NO_HISTORY:
        slip = sqrt(tx * tx + ty * ty + tz * tz)
        if slip > 0.0:
            ft = min(friction * hold, gt * slip) / slip
            fx = -ft * tx
            fy = -ft * ty
            fz = -ft * tz
    if switches.cohesion >= EASO:
        fx += load.drag * tx
        fy += load.drag * ty
        fz += load.drag * tz
    ax = 0.0
    ay = 0.0
    az = 0.0
    if switches.rolling == CDT:
        spin = sqrt(ux * ux + uy * uy + uz * uz)
        if spin > 0.0:
            scale = resist * load.elastic * reff / spin
            ax = scale * ux
            ay = scale * uy
            az = scale * uz
            if switches.torsion_torque == 0:
                along = ax * nx + ay * ny + az * nz
                ax -= along * nx
                ay -= along * ny
                az -= along * nz
    elif switches.rolling == ROLL_LUDING:
        limit = resist * abs(fn + load.held) * reff
        (ax, ay, az), (mx, my, mz) = turn_luding(
            switches, material, contact, memory, load, limit, dt
        )
    elif switches.rolling >= EPSD:
        if switches.torsion_torque == 0:
            along = ux * nx + uy * ny + uz * nz
            ux -= along * nx
            uy -= along * ny
            uz -= along * nz
        kr = load.kt * reff * reff
        if switches.rolling != EPSD2:
            kr = load.roll_stiffness * kn * resist * resist * reff * reff
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
        if switches.rolling != EPSD2 and not full:
            damp = material.rolling_damping * 2.0 * sqrt(contact.inertia * kr)
            ax += damp * ux
            ay += damp * uy
            az += damp * uz
    reaction = Reaction(
        force * nx + fx, force * ny + fy, force * nz + fz,
        ny * fz - nz * fy, nz * fx - nx * fz, nx * fy - ny * fx, ax, ay, az,
    )  # fmt: skip
    return reaction, Memory(sx, sy, sz, mx, my, mz)
