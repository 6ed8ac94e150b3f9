"""Moving meshes: every step a mesh gets its velocity, then its nodes move by velocity times step.

The position is the running sum of the velocities, as in LIGGGHTS, not the closed form of the
motion. Motions of one mesh add up in the order of their fixes, and each carries the origins of the
rotations (``rotate``, ``rotate/variable``) that come after it. The velocity at a time ``t`` (since
the fix was made) is

======== =====================================================================
linear   constant
wiggle   ``A w cos(w t)``
rotate   spin ``w`` about an axis
riggle   spin ``A w cos(w t)`` about an axis
viblin   ``-axis * sum_k A_k w_k sin(w_k t + p_k)``
vibrot   the same sum as a spin about an axis
table    worked out from script variables, for velocity or spin
======== =====================================================================
"""

from __future__ import annotations

from math import cos, sin, sqrt
from typing import Any

from minidem.kernels.columns import (  # isort: skip
    X, Y, Z, ONLY, MOTION_KIND, MOTION_FIRST, MOTION_END, MOTION_LEADS, MOTION_WAVES,
    MOTION_CARRIES, LINEAR_VELOCITY, WIGGLE_AMPLITUDE, WIGGLE_RATE, ORIGIN, AXIS, ROTATE_SPIN,
    RIGGLE_RATE, RIGGLE_AMPLITUDE, WAVES, WAVE_AMPLITUDE, WAVE_PHASE, WAVE_RATE, WAVE,
    TABLE_SPIN,
)  # fmt: skip
from minidem.kernels.machine.jit import inlined, inner

__all__ = ["KINDS", "WAVES", "follow", "move_meshes", "nodes_moved"]

KINDS = (
    "linear", "wiggle", "rotate", "riggle", "viblin", "vibrot", "table", "spin table", "turn table"
)  # fmt: skip
"""Kinds of motions, in the order of the numbers that a table of motions has for them."""

LINEAR, WIGGLE, ROTATE, RIGGLE, VIBLIN, VIBROT, TABLE, SPIN_TABLE, TURN_TABLE = range(len(KINDS))


@inlined
def _vibration(value: Any, m: int, order: int, t: float) -> Any:
    """Return the speed of a sum of cosines."""
    found = 0.0
    for k in range(order):
        wave = WAVES + WAVE * k
        rate = value[m, wave + WAVE_RATE]
        found -= (
            value[m, wave + WAVE_AMPLITUDE] * rate * sin(rate * t + value[m, wave + WAVE_PHASE])
        )
    return found


@inlined
def _shift(mesh: Any, t: int, vx: float, vy: float, vz: float, dt: float) -> None:
    for k in range(3):
        mesh.node[t, k, X] += vx * dt
        mesh.node[t, k, Y] += vy * dt
        mesh.node[t, k, Z] += vz * dt
        mesh.vel[t, k, X] += vx
        mesh.vel[t, k, Y] += vy
        mesh.vel[t, k, Z] += vz


@inlined
def _turned(x: float, y: float, z: float, turn: Any) -> Any:
    """Return a vector turned about a unit axis: cosine and sine of half the angle, and the axis."""
    c, s, ax, ay, az = turn
    qx = ax * s
    qy = ay * s
    qz = az * s
    # quaternion product q v q* with the real part folded in
    ux = c * x + qy * z - qz * y
    uy = c * y + qz * x - qx * z
    uz = c * z + qx * y - qy * x
    u0 = -qx * x - qy * y - qz * z
    return (
        c * ux - u0 * qx - qz * uy + qy * uz,
        c * uy - u0 * qy - qx * uz + qz * ux,
        c * uz - u0 * qz - qy * ux + qx * uy,
    )


@inlined
def _rotation(value: Any, m: int, angle: float) -> Any:
    """Return the rotation by an angle about the axis of motion m, as `_turned` takes it."""
    ax = value[m, AXIS + X]
    ay = value[m, AXIS + Y]
    az = value[m, AXIS + Z]
    # LIGGGHTS scales the unit vector once more
    inv = 1.0 / sqrt(ax * ax + ay * ay + az * az)
    return cos(0.5 * angle), sin(0.5 * angle), inv * ax, inv * ay, inv * az


@inlined
def _turn(mesh: Any, t: int, value: Any, m: int, turn: Any) -> None:
    """Turn one triangle about the axis of motion m."""
    for k in range(3):
        node = _turned(
            mesh.node[t, k, X] - value[m, ORIGIN + X], mesh.node[t, k, Y] - value[m, ORIGIN + Y],
            mesh.node[t, k, Z] - value[m, ORIGIN + Z], turn,
        )  # fmt: skip
        edge = _turned(mesh.edge[t, k, X], mesh.edge[t, k, Y], mesh.edge[t, k, Z], turn)
        for c in range(3):
            mesh.node[t, k, c] = node[c] + value[m, ORIGIN + c]
            mesh.edge[t, k, c] = edge[c]
    normal = _turned(mesh.normal[t, X], mesh.normal[t, Y], mesh.normal[t, Z], turn)
    for c in range(3):
        mesh.normal[t, c] = normal[c]


@inlined
def _turn_point(point: Any, k: int, value: Any, m: int, turn: Any) -> None:
    """Turn row k of a table of points as motion m turns its mesh."""
    turned = _turned(
        point[k, X] - value[m, ORIGIN + X], point[k, Y] - value[m, ORIGIN + Y],
        point[k, Z] - value[m, ORIGIN + Z], turn,
    )  # fmt: skip
    for c in range(3):
        point[k, c] = turned[c] + value[m, ORIGIN + c]


@inlined
def _spin(mesh: Any, t: int, value: Any, m: int, w: float) -> None:
    """Add the velocity w x r of a spin about the axis of motion m to the nodes of a triangle."""
    ax = value[m, AXIS + X]
    ay = value[m, AXIS + Y]
    az = value[m, AXIS + Z]
    for k in range(3):
        x = mesh.node[t, k, X] - value[m, ORIGIN + X]
        y = mesh.node[t, k, Y] - value[m, ORIGIN + Y]
        z = mesh.node[t, k, Z] - value[m, ORIGIN + Z]
        mesh.vel[t, k, X] += (ay * w) * z - (az * w) * y
        mesh.vel[t, k, Y] += (az * w) * x - (ax * w) * z
        mesh.vel[t, k, Z] += (ax * w) * y - (ay * w) * x


@inlined
def _carry(motions: Any, m: int, count: int, w: float, x: float, y: float, z: float) -> None:
    """Let motion m carry the origins of the rotations that come after it on the same mesh.

    Parameters
    ----------
    w : float
        Angle, rad; 0 for a shift.
    x, y, z : float
        Shift, m.
    """
    value = motions.value
    c = cos(0.5 * w)
    s = sin(0.5 * w)
    for k in range(m + 1, count):
        same = (
            motions.spec[k, MOTION_FIRST] == motions.spec[m, MOTION_FIRST]
            and motions.spec[k, MOTION_END] == motions.spec[m, MOTION_END]
        )
        if not same or (
            motions.spec[k, MOTION_KIND] != ROTATE and motions.spec[k, MOTION_KIND] != SPIN_TABLE
        ):
            continue
        if w != 0.0:
            x, y, z = _turned(
                value[k, ORIGIN + X] - value[m, ORIGIN + X],
                value[k, ORIGIN + Y] - value[m, ORIGIN + Y],
                value[k, ORIGIN + Z] - value[m, ORIGIN + Z],
                (c, s, value[m, AXIS + X], value[m, AXIS + Y], value[m, AXIS + Z]),
            )
            value[k, ORIGIN + X] = x + value[m, ORIGIN + X]
            value[k, ORIGIN + Y] = y + value[m, ORIGIN + Y]
            value[k, ORIGIN + Z] = z + value[m, ORIGIN + Z]
        else:
            value[k, ORIGIN + X] += x
            value[k, ORIGIN + Y] += y
            value[k, ORIGIN + Z] += z


@inlined
def _arm(mesh: Any, lo: Any, hi: Any, value: Any, m: int) -> Any:
    """Return the longest distance of a node of triangles lo to hi from the origin of motion m."""
    far = 0.0
    for t in range(lo, hi):
        for k in range(3):
            x = mesh.node[t, k, X] - value[m, ORIGIN + X]
            y = mesh.node[t, k, Y] - value[m, ORIGIN + Y]
            z = mesh.node[t, k, Z] - value[m, ORIGIN + Z]
            far = max(far, x * x + y * y + z * z)
    return sqrt(far)


@inner
def move_meshes(mesh: Any, motions: Any, count: int, step: int, dt: float, nearby: float) -> float:
    """Advance all moving meshes by one step; return a way that nobody beside them sees exceeded, m.

    Parameters
    ----------
    mesh, motions : tables
        See `minidem.kernels.tables`; nodes, velocities and clocks change in place.
    count : int
        Number of motions.
    step : int
        The step that is being made.
    dt, nearby : float
        Time step, s; distance of those who look, m, for whom a mesh that turns goes farther.
    """
    value = motions.value
    way = 0.0
    for m in range(count):
        motions.clock[m] += dt
        t = motions.clock[m]
        lo = motions.spec[m, MOTION_FIRST]
        hi = motions.spec[m, MOTION_END]
        kind = motions.spec[m, MOTION_KIND]
        if motions.spec[m, MOTION_LEADS] == 1 and kind != TURN_TABLE:  # a servo has set its own
            mesh.vel[lo:hi] = 0.0
        carries = motions.spec[m, MOTION_CARRIES] == 1 and lo < hi
        vx = vy = vz = w = 0.0
        if kind == LINEAR:
            vx = value[m, LINEAR_VELOCITY + X]
            vy = value[m, LINEAR_VELOCITY + Y]
            vz = value[m, LINEAR_VELOCITY + Z]
        elif kind == WIGGLE:
            speed = value[m, WIGGLE_RATE] * cos(value[m, WIGGLE_RATE] * t)
            vx = value[m, WIGGLE_AMPLITUDE + X] * speed
            vy = value[m, WIGGLE_AMPLITUDE + Y] * speed
            vz = value[m, WIGGLE_AMPLITUDE + Z] * speed
        elif kind == ROTATE:
            w = value[m, ROTATE_SPIN]
        elif kind == RIGGLE:
            rate = value[m, RIGGLE_RATE]
            w = rate * value[m, RIGGLE_AMPLITUDE] * cos(rate * t)
        elif kind == VIBLIN:
            speed = _vibration(value, m, motions.spec[m, MOTION_WAVES], t)
            vx = value[m, AXIS + X] * speed
            vy = value[m, AXIS + Y] * speed
            vz = value[m, AXIS + Z] * speed
        elif kind == VIBROT:
            w = _vibration(value, m, motions.spec[m, MOTION_WAVES], t)
        elif kind == TABLE:
            row = step - motions.base[ONLY]
            vx = motions.table[row, m, X]
            vy = motions.table[row, m, Y]
            vz = motions.table[row, m, Z]
        else:
            w = motions.table[step - motions.base[ONLY], m, TABLE_SPIN]
        if kind in (ROTATE, RIGGLE, VIBROT, SPIN_TABLE, TURN_TABLE):
            turn = _rotation(value, m, w * dt)
            way += abs(w * dt) * (_arm(mesh, lo, hi, value, m) + nearby)
            for k in range(lo, hi):
                _turn(mesh, k, value, m, turn)
                if kind != TURN_TABLE:
                    _spin(mesh, k, value, m, w)
            if carries:
                _turn_point(mesh.origin, mesh.owner[lo], value, m, turn)
            if w != 0.0:
                _carry(motions, m, count, w * dt, 0.0, 0.0, 0.0)
        else:
            way += sqrt(vx * vx + vy * vy + vz * vz) * dt
            for k in range(lo, hi):
                _shift(mesh, k, vx, vy, vz, dt)
            if carries:
                mesh.origin[mesh.owner[lo], X] += vx * dt
                mesh.origin[mesh.owner[lo], Y] += vy * dt
                mesh.origin[mesh.owner[lo], Z] += vz * dt
            _carry(motions, m, count, 0.0, vx * dt, vy * dt, vz * dt)
    follow(mesh)
    return way


@inner
def follow(mesh: Any) -> None:
    """Let images follow their triangles."""
    for k in range(mesh.node.shape[0]):
        b = mesh.base[k]
        if b == k:
            continue
        for i in range(3):
            for c in range(3):
                mesh.node[k, i, c] = mesh.node[b, i, c] + mesh.shift[k, c]
                mesh.vel[k, i, c] = mesh.vel[b, i, c]
                mesh.edge[k, i, c] = mesh.edge[b, i, c]
        for c in range(3):
            mesh.normal[k, c] = mesh.normal[b, c]


@inner
def nodes_moved(mesh: Any, motions: Any, count: int, limit2: float) -> bool:
    """Return True if a node of a moving mesh is farther from where it was held than allowed."""
    for m in range(count):
        if motions.spec[m, MOTION_LEADS] == 0:
            continue
        for t in range(motions.spec[m, MOTION_FIRST], motions.spec[m, MOTION_END]):
            for k in range(3):
                dx = mesh.node[t, k, X] - mesh.held[t, k, X]
                dy = mesh.node[t, k, Y] - mesh.held[t, k, Y]
                dz = mesh.node[t, k, Z] - mesh.held[t, k, Z]
                if dx * dx + dy * dy + dz * dz > limit2:
                    return True
    return False
