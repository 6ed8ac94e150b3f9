"""The particle loops of a step besides forces: half kicks, moves, particles in flight."""

from __future__ import annotations

from math import sqrt
from typing import Any

from minidem.kernels.columns import (  # isort: skip
    X, Y, Z, RADIUS, VX, VY, VZ, MASS, ROW, WX, WY, WZ, SPIN, FX, FY, FZ, TX, TY, TZ, HALF_KICK,
    HALF_TURN, FORCE, FLIGHT_FROM, FLIGHT_START, FLIGHT_STOP, FLIGHT_VELOCITY, FLIGHT_FINAL,
    FLIGHT_SPIN, POST_GROUP, POST_VECTOR, INTEGRATED, LEADING, DT, UNFORCED, UNTURNED, LIMITED,
    LIMIT_OF_RADIUS, LIMIT2, ALONG,
)  # fmt: skip
from minidem.kernels.machine.jit import inlined, inner
from minidem.kernels.machine.space import columns
from minidem.kernels.motion.post import LEADER

__all__ = ["AGAIN", "UNSEEN", "factors", "farthest", "fly", "kick", "second"]

AGAIN, UNSEEN = 1, 2
"""Flags of `kick`."""


@inner
def factors(n: int, control: Any, parts: Any) -> None:
    """Store ``dt/2m`` and ``dt/2I`` of every particle beside its force, for the half kicks.

    They are zero for particles whose integrator takes no notice of forces or torques.
    """
    unforced = control.whole[UNFORCED]
    unturned = control.whole[UNTURNED]
    half = 0.5 * control.real[DT]
    half_spin = half / 0.4
    row = parts.row
    for i in range(n):
        parts.force[i, HALF_KICK] = half / row[i, MASS]
        parts.force[i, HALF_TURN] = half_spin / (row[i, RADIUS] * row[i, RADIUS] * row[i, MASS])
        if parts.mask[i] & unforced:
            parts.force[i, HALF_KICK] = 0.0
        if parts.mask[i] & unturned:
            parts.force[i, HALF_TURN] = 0.0


@inlined
def _slowed(vx: float, vy: float, vz: float, radius: float, limit2: float, relative: int) -> Any:
    """Return a velocity scaled down to the largest speed of ``nve/limit``."""
    most = limit2
    if relative == 1:
        most = limit2 * (radius * radius)
    v2 = vx * vx + vy * vy + vz * vz
    if v2 > most:
        scale = sqrt(most / v2)
        return vx * scale, vy * scale, vz * scale
    return vx, vy, vz


@inner
def kick(start: int, stop: int, control: Any, parts: Any, posts: Any, flag: int) -> Any:
    """Make the first half kick and the move of particles, and reset the forces as `lead` does.

    With `AGAIN` in the flag the second half kick of the step before comes first, in the same pass
    over the memory. With `UNSEEN` nobody asks how far particles have moved.

    Returns
    -------
    float
        Largest squared move since the rebuild, 0 with `UNSEEN`; not a number if a move is not.
    float
        Largest squared speed relative to ``ALONG``.
    """
    again = flag & AGAIN
    seen = flag & UNSEEN == 0
    nve = control.whole[INTEGRATED]
    limited = control.whole[LIMITED]
    relative = control.whole[LIMIT_OF_RADIUS]
    real = control.real
    limit2 = real[LIMIT2]
    dt = real[DT]
    row = columns(parts.row, ROW)
    spin = columns(parts.spin, SPIN)
    force = columns(parts.force, FORCE)
    held = columns(parts.held, 3)
    mask = parts.mask
    bit = 0
    gx = 0.0
    gy = 0.0
    gz = 0.0
    if control.whole[LEADING] == 1:
        bit = posts.spec[LEADER, POST_GROUP]
        gx = posts.value[LEADER, POST_VECTOR + X]
        gy = posts.value[LEADER, POST_VECTOR + Y]
        gz = posts.value[LEADER, POST_VECTOR + Z]
    along_x, along_y, along_z = real[ALONG + X], real[ALONG + Y], real[ALONG + Z]
    far = 0.0
    bad = 0.0
    fastest = 0.0
    for i in range(start, stop):
        x = row[i, X]
        y = row[i, Y]
        z = row[i, Z]
        vx = row[i, VX]
        vy = row[i, VY]
        vz = row[i, VZ]
        groups = mask[i]
        if groups & nve:
            a = force[i, HALF_KICK]
            fx = a * force[i, FX]
            fy = a * force[i, FY]
            fz = a * force[i, FZ]
            if again:
                vx += fx
                vy += fy
                vz += fz
                if groups & limited:
                    vx, vy, vz = _slowed(vx, vy, vz, row[i, RADIUS], limit2, relative)
            vx += fx
            vy += fy
            vz += fz
            if groups & limited:
                vx, vy, vz = _slowed(vx, vy, vz, row[i, RADIUS], limit2, relative)
            x += dt * vx
            y += dt * vy
            z += dt * vz
            row[i, X] = x
            row[i, Y] = y
            row[i, Z] = z
            row[i, VX] = vx
            row[i, VY] = vy
            row[i, VZ] = vz
            b = force[i, HALF_TURN]
            tx = b * force[i, TX]
            ty = b * force[i, TY]
            tz = b * force[i, TZ]
            wx = spin[i, WX]
            wy = spin[i, WY]
            wz = spin[i, WZ]
            if again:
                wx += tx
                wy += ty
                wz += tz
            spin[i, WX] = wx + tx
            spin[i, WY] = wy + ty
            spin[i, WZ] = wz + tz
        ux, uy, uz = vx - along_x, vy - along_y, vz - along_z
        speed2 = ux * ux + uy * uy + uz * uz
        fastest = max(fastest, speed2)  # `fly` moves others, too
        m = row[i, MASS] if groups & bit else 0.0
        force[i, FX] = m * gx
        force[i, FY] = m * gy
        force[i, FZ] = m * gz
        force[i, TX] = 0.0
        force[i, TY] = 0.0
        force[i, TZ] = 0.0
        if seen:
            dx = x - held[i, X]
            dy = y - held[i, Y]
            dz = z - held[i, Z]
            d2 = dx * dx + dy * dy + dz * dz
            far = max(far, d2)
            bad += d2 * 0.0
        else:
            bad += speed2 * 0.0
    return far + bad, fastest


@inner
def second(start: int, stop: int, control: Any, parts: Any) -> None:
    """Make the second half kick of particles `start` to `stop`."""
    nve = control.whole[INTEGRATED]
    limited = control.whole[LIMITED]
    relative = control.whole[LIMIT_OF_RADIUS]
    limit2 = control.real[LIMIT2]
    row = columns(parts.row, ROW)
    spin = columns(parts.spin, SPIN)
    force = columns(parts.force, FORCE)
    mask = parts.mask
    for i in range(start, stop):
        if mask[i] & nve:
            a = force[i, HALF_KICK]
            vx = row[i, VX] + a * force[i, FX]
            vy = row[i, VY] + a * force[i, FY]
            vz = row[i, VZ] + a * force[i, FZ]
            if mask[i] & limited:
                vx, vy, vz = _slowed(vx, vy, vz, row[i, RADIUS], limit2, relative)
            row[i, VX] = vx
            row[i, VY] = vy
            row[i, VZ] = vz
            b = force[i, HALF_TURN]
            spin[i, WX] += b * force[i, TX]
            spin[i, WY] += b * force[i, TY]
            spin[i, WZ] += b * force[i, TZ]


@inner
def farthest(n: int, parts: Any) -> float:
    """Return the largest squared move since positions were held; nan is left out."""
    row = columns(parts.row, ROW)
    held = columns(parts.held, 3)
    far = 0.0
    for i in range(n):
        dx = row[i, X] - held[i, X]
        dy = row[i, Y] - held[i, Y]
        dz = row[i, Z] - held[i, Z]
        far = max(far, dx * dx + dy * dy + dz * dz)
    return far


@inner
def fly(n: int, parts: Any, step: int, dt: float) -> None:
    """Hold particles of an insertion stream on their straight way until they are released."""
    flight = parts.flight
    row = parts.row
    for i in range(n):
        stop = flight[i, FLIGHT_STOP]
        if stop < step:
            continue
        passed = (step - flight[i, FLIGHT_START]) * dt
        for c in range(3):
            row[i, c] = flight[i, FLIGHT_FROM + c] + flight[i, FLIGHT_VELOCITY + c] * passed
            row[i, VX + c] = flight[i, FLIGHT_VELOCITY + c]
            parts.spin[i, WX + c] = 0.0
            parts.force[i, FX + c] = 0.0
            parts.force[i, TX + c] = 0.0
        if stop == step:
            for c in range(3):
                row[i, VX + c] = flight[i, FLIGHT_FINAL + c]
                parts.spin[i, WX + c] = flight[i, FLIGHT_SPIN + c]
