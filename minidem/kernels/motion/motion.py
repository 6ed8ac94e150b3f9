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

from minidem.kernels.machine.jit import inlined, inner, kernel

__all__ = ["KINDS", "WAVES", "facet_frames", "follow", "move_meshes", "nodes_moved"]

KINDS = ("linear", "wiggle", "rotate", "riggle", "viblin", "vibrot", "table", "spin table")
"""Meaning of ``Motions.spec[:, 0]``.

``Motions.value``: linear v(3); wiggle A(3) w; rotate, riggle origin(3) axis(3) w A; viblin,
vibrot origin(3) axis(3) at 0 to 5 and A, phase, w of wave k from 8 + 3 k.
"""

WAVES = 8
"""Column of the first wave."""


@inlined
def _vibration(value: Any, m: int, order: int, t: float) -> Any:
    """Return the speed of a sum of cosines."""
    found = 0.0
    for k in range(order):
        c = WAVES + 3 * k
        found -= value[m, c] * value[m, c + 2] * sin(value[m, c + 2] * t + value[m, c + 1])
    return found


@inlined
def _shift(mesh: Any, t: int, vx: float, vy: float, vz: float, dt: float) -> None:
    for k in range(3):
        mesh.node[t, k, 0] += vx * dt
        mesh.node[t, k, 1] += vy * dt
        mesh.node[t, k, 2] += vz * dt
        mesh.vel[t, k, 0] += vx
        mesh.vel[t, k, 1] += vy
        mesh.vel[t, k, 2] += vz


@inlined
def _turned(
    x: float, y: float, z: float, c: float, s: float, ax: float, ay: float, az: float
) -> Any:
    """Return a vector turned about a unit axis by an angle with half-angle cosine c and sine s."""
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
def _spin(mesh: Any, t: int, value: Any, m: int, w: float, dt: float) -> None:
    """Turn one triangle by ``w dt`` about the axis of motion m, and add the velocity w x r."""
    ax = value[m, 3]
    ay = value[m, 4]
    az = value[m, 5]
    c = cos(0.5 * w * dt)
    s = sin(0.5 * w * dt)
    for k in range(3):
        x, y, z = _turned(
            mesh.node[t, k, 0] - value[m, 0], mesh.node[t, k, 1] - value[m, 1],
            mesh.node[t, k, 2] - value[m, 2], c, s, ax, ay, az,
        )  # fmt: skip
        mesh.node[t, k, 0] = x + value[m, 0]
        mesh.node[t, k, 1] = y + value[m, 1]
        mesh.node[t, k, 2] = z + value[m, 2]
        x = mesh.node[t, k, 0] - value[m, 0]
        y = mesh.node[t, k, 1] - value[m, 1]
        z = mesh.node[t, k, 2] - value[m, 2]
        mesh.vel[t, k, 0] += (ay * w) * z - (az * w) * y
        mesh.vel[t, k, 1] += (az * w) * x - (ax * w) * z
        mesh.vel[t, k, 2] += (ax * w) * y - (ay * w) * x
        x, y, z = _turned(
            mesh.edge[t, k, 0], mesh.edge[t, k, 1], mesh.edge[t, k, 2], c, s, ax, ay, az
        )
        mesh.edge[t, k, 0] = x
        mesh.edge[t, k, 1] = y
        mesh.edge[t, k, 2] = z
    x, y, z = _turned(mesh.normal[t, 0], mesh.normal[t, 1], mesh.normal[t, 2], c, s, ax, ay, az)
    mesh.normal[t, 0] = x
    mesh.normal[t, 1] = y
    mesh.normal[t, 2] = z


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
        same = motions.spec[k, 1] == motions.spec[m, 1] and motions.spec[k, 2] == motions.spec[m, 2]
        if not same or (motions.spec[k, 0] != 2 and motions.spec[k, 0] != 7):
            continue
        if w != 0.0:
            x, y, z = _turned(
                value[k, 0] - value[m, 0], value[k, 1] - value[m, 1], value[k, 2] - value[m, 2],
                c, s, value[m, 3], value[m, 4], value[m, 5],
            )  # fmt: skip
            value[k, 0] = x + value[m, 0]
            value[k, 1] = y + value[m, 1]
            value[k, 2] = z + value[m, 2]
        else:
            value[k, 0] += x
            value[k, 1] += y
            value[k, 2] += z


@inner
def move_meshes(mesh: Any, motions: Any, count: int, step: int, dt: float) -> None:
    """Advance all moving meshes by one step.

    Parameters
    ----------
    mesh, motions : tables
        See `minidem.kernels.tables`; nodes, velocities and clocks change in place.
    count : int
        Number of motions.
    step : int
        The step that is being made.
    dt : float
        Time step, s.
    """
    value = motions.value
    for m in range(count):
        motions.clock[m] += dt
        t = motions.clock[m]
        lo = motions.spec[m, 1]
        hi = motions.spec[m, 2]
        if motions.spec[m, 3] == 1:
            mesh.vel[lo:hi] = 0.0
        kind = motions.spec[m, 0]
        vx = 0.0
        vy = 0.0
        vz = 0.0
        w = 0.0
        if kind == 0:
            vx = value[m, 0]
            vy = value[m, 1]
            vz = value[m, 2]
        elif kind == 1:
            speed = value[m, 3] * cos(value[m, 3] * t)
            vx = value[m, 0] * speed
            vy = value[m, 1] * speed
            vz = value[m, 2] * speed
        elif kind == 2:
            w = value[m, 6]
        elif kind == 3:
            w = value[m, 7] * cos(value[m, 6] * t) * value[m, 6]
        elif kind == 4:
            speed = _vibration(value, m, motions.spec[m, 4], t)
            vx = value[m, 3] * speed
            vy = value[m, 4] * speed
            vz = value[m, 5] * speed
        elif kind == 5:
            w = _vibration(value, m, motions.spec[m, 4], t)
        elif kind == 6:
            row = step - motions.base[0]
            vx = motions.table[row, m, 0]
            vy = motions.table[row, m, 1]
            vz = motions.table[row, m, 2]
        else:
            w = motions.table[step - motions.base[0], m, 0]
        if kind == 2 or kind == 3 or kind == 5 or kind == 7:
            for k in range(lo, hi):
                _spin(mesh, k, value, m, w, dt)
            if w != 0.0:
                _carry(motions, m, count, w * dt, 0.0, 0.0, 0.0)
        else:
            for k in range(lo, hi):
                _shift(mesh, k, vx, vy, vz, dt)
            _carry(motions, m, count, 0.0, vx * dt, vy * dt, vz * dt)
    follow(mesh)


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
        if motions.spec[m, 3] == 0:
            continue
        for t in range(motions.spec[m, 1], motions.spec[m, 2]):
            for k in range(3):
                dx = mesh.node[t, k, 0] - mesh.held[t, k, 0]
                dy = mesh.node[t, k, 1] - mesh.held[t, k, 1]
                dz = mesh.node[t, k, 2] - mesh.held[t, k, 2]
                if dx * dx + dy * dy + dz * dz > limit2:
                    return True
    return False


@kernel
def facet_frames(mesh: Any, lo: int, hi: int) -> None:
    """Work out edges, normals, bounding radius and the obtuse flag of triangles lo to hi."""
    for t in range(lo, hi):
        for k in range(3):
            j = (k + 1) % 3
            dx = mesh.node[t, j, 0] - mesh.node[t, k, 0]
            dy = mesh.node[t, j, 1] - mesh.node[t, k, 1]
            dz = mesh.node[t, j, 2] - mesh.node[t, k, 2]
            size = sqrt(dx * dx + dy * dy + dz * dz)
            mesh.length[t, k] = size
            inv = 1.0 / size
            mesh.edge[t, k, 0] = dx * inv
            mesh.edge[t, k, 1] = dy * inv
            mesh.edge[t, k, 2] = dz * inv
        e = mesh.edge[t]
        nx = e[0, 1] * e[1, 2] - e[0, 2] * e[1, 1]
        ny = e[0, 2] * e[1, 0] - e[0, 0] * e[1, 2]
        nz = e[0, 0] * e[1, 1] - e[0, 1] * e[1, 0]
        size = sqrt(nx * nx + ny * ny + nz * nz)
        if size < 1.0e-15:
            mesh.normal[t, 0] = -e[0, 1]
            mesh.normal[t, 1] = e[0, 0]
            mesh.normal[t, 2] = e[0, 2]
        else:
            inv = 1.0 / size
            mesh.normal[t, 0] = nx * inv
            mesh.normal[t, 1] = ny * inv
            mesh.normal[t, 2] = nz * inv
        dot = e[2, 0] * e[1, 0] + e[2, 1] * e[1, 1] + e[2, 2] * e[1, 2]
        mesh.flags[t] = (mesh.flags[t] & 63) | (64 if dot > 0.0 else 0)
        far = 0.0
        for k in range(3):
            d2 = 0.0
            for c in range(3):
                mid = (mesh.node[t, 0, c] + mesh.node[t, 1, c] + mesh.node[t, 2, c]) / 3.0
                d2 += (mesh.node[t, k, c] - mid) ** 2
            far = max(far, sqrt(d2))
        mesh.bound[t] = far
