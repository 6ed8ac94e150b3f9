"""The particle loops of a step besides contacts: half kicks, body forces, particles in flight."""

from __future__ import annotations

from math import pi, sqrt
from typing import Any

from minidem.kernels.columns import (  # isort: skip
    X, Y, Z, RADIUS, VX, VY, VZ, MASS, ROW, WX, WY, WZ, SPIN, FX, FY, FZ, TX, TY, TZ, HALF_KICK,
    HALF_TURN, FORCE, FLIGHT_FROM, FLIGHT_START, FLIGHT_STOP, FLIGHT_VELOCITY, FLIGHT_FINAL,
    FLIGHT_SPIN, POST_KIND, POST_GROUP, POST_AXES, POST_VECTOR, POST_VISCOUS, DRAG_FACTOR,
    DRAG_DENSITY, DRAG_VISCOSITY, DRAG_GAS, INTEGRATED, LEADING, DT, UNFORCED, UNTURNED, LIMITED,
    LIMIT_OF_RADIUS, LIMIT2, ALONG,
)  # fmt: skip
from minidem.kernels.machine.jit import inlined, inner, kernel
from minidem.kernels.machine.space import columns

__all__ = ["POST_KINDS", "apply_posts", "apply_range", "factors", "fly", "kick", "lead", "second"]

POST_KINDS = ("gravity", "viscous", "setforce", "addforce", "freeze", "drag/sphere")
"""Kinds of forces, in the order of the numbers that a table of posts has for them."""

GRAVITY, VISCOUS, SETFORCE, ADDFORCE, FREEZE, DRAG = range(len(POST_KINDS))
LEADER = 0  # the post that may come before all walls


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
def lead(n: int, parts: Any, posts: Any, first: int) -> None:
    """Reset the forces: to the weight if gravity comes before all walls, else to zero."""
    force = parts.force
    for i in range(n):
        for c in range(6):
            force[i, c] = 0.0
        if first == 1 and parts.mask[i] & posts.spec[LEADER, POST_GROUP]:
            for c in range(3):
                force[i, c] = parts.row[i, MASS] * posts.value[LEADER, POST_VECTOR + c]


@inner
def kick(start: int, stop: int, control: Any, parts: Any, posts: Any, again: int) -> Any:
    """Make the first half kick and the move of particles, and reset the forces as `lead` does.

    With ``again`` 1 the second half kick of the step before comes first, in the same pass over
    the memory.

    Returns
    -------
    float
        Largest squared move since the rebuild; not a number if a move is not.
    float
        Largest squared speed relative to ``ALONG``.
    """
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
            if again == 1:
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
            if again == 1:
                wx += tx
                wy += ty
                wz += tz
            spin[i, WX] = wx + tx
            spin[i, WY] = wy + ty
            spin[i, WZ] = wz + tz
        ux, uy, uz = vx - along_x, vy - along_y, vz - along_z
        fastest = max(fastest, ux * ux + uy * uy + uz * uz)  # `fly` moves others, too
        m = row[i, MASS] if groups & bit else 0.0
        force[i, FX] = m * gx
        force[i, FY] = m * gy
        force[i, FZ] = m * gz
        force[i, TX] = 0.0
        force[i, TY] = 0.0
        force[i, TZ] = 0.0
        dx = x - held[i, X]
        dy = y - held[i, Y]
        dz = z - held[i, Z]
        d2 = dx * dx + dy * dy + dz * dz
        far = max(far, d2)
        bad += d2 * 0.0
    return far + bad, fastest


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
