"""The particle loops of a step besides contacts: half kicks, body forces, particles in flight."""

from __future__ import annotations

from math import pi, sqrt
from typing import Any

from minidem.kernels.machine.jit import columns, inlined, inner, kernel

__all__ = ["POST_KINDS", "apply_posts", "apply_range", "factors", "fly", "kick", "lead", "second"]

POST_KINDS = ("gravity", "viscous", "setforce", "addforce", "freeze", "drag/sphere")
"""Meaning of ``Posts.spec[:, 0]``; column 1 the group bit, column 2 a bit per component (setforce).

``Posts.value``: gravity acceleration(3), m/s2; viscous coefficient; setforce, addforce force(3);
drag/sphere factor, gas density, kg/m3, and viscosity, Pa s, gas velocity(3), m/s.
"""


@inner
def factors(n: int, parts: Any, dt: float) -> None:
    """Store ``dt/2m`` and ``dt/2I`` of every particle beside its force, for the half kicks."""
    half = 0.5 * dt
    half_spin = half / 0.4
    row = parts.row
    for i in range(n):
        parts.force[i, 6] = half / row[i, 7]
        parts.force[i, 7] = half_spin / (row[i, 3] * row[i, 3] * row[i, 7])


@inner
def lead(n: int, parts: Any, posts: Any, first: int) -> None:
    """Reset the forces: to the weight if gravity comes before all walls, else to zero."""
    force = parts.force
    for i in range(n):
        for c in range(6):
            force[i, c] = 0.0
        if first == 1 and parts.mask[i] & posts.spec[0, 1]:
            for c in range(3):
                force[i, c] = parts.row[i, 7] * posts.value[0, c]


@inner
def kick(
    start: int, stop: int, parts: Any, posts: Any, first: int, nve: int, dt: float, again: int
) -> Any:
    """Make the first half kick and the move of particles, and reset the forces as `lead` does.

    With ``again`` 1 the second half kick of the step before comes first, in the same pass over
    the memory.

    Returns
    -------
    float
        Largest squared move since the rebuild; not a number if a move is not.
    """
    row = columns(parts.row, 8)
    spin = columns(parts.spin, 4)
    force = columns(parts.force, 8)
    held = columns(parts.held, 3)
    mask = parts.mask
    bit = 0
    gx = 0.0
    gy = 0.0
    gz = 0.0
    if first == 1:
        bit = posts.spec[0, 1]
        gx = posts.value[0, 0]
        gy = posts.value[0, 1]
        gz = posts.value[0, 2]
    far = 0.0
    bad = 0.0
    for i in range(start, stop):
        if mask[i] & nve:
            a = force[i, 6]
            b = force[i, 7]
            if again == 1:
                row[i, 4] += a * force[i, 0]
                row[i, 5] += a * force[i, 1]
                row[i, 6] += a * force[i, 2]
                spin[i, 0] += b * force[i, 3]
                spin[i, 1] += b * force[i, 4]
                spin[i, 2] += b * force[i, 5]
            row[i, 4] += a * force[i, 0]
            row[i, 5] += a * force[i, 1]
            row[i, 6] += a * force[i, 2]
            row[i, 0] += dt * row[i, 4]
            row[i, 1] += dt * row[i, 5]
            row[i, 2] += dt * row[i, 6]
            spin[i, 0] += b * force[i, 3]
            spin[i, 1] += b * force[i, 4]
            spin[i, 2] += b * force[i, 5]
        m = row[i, 7] if mask[i] & bit else 0.0
        force[i, 0] = m * gx
        force[i, 1] = m * gy
        force[i, 2] = m * gz
        force[i, 3] = 0.0
        force[i, 4] = 0.0
        force[i, 5] = 0.0
        dx = row[i, 0] - held[i, 0]
        dy = row[i, 1] - held[i, 1]
        dz = row[i, 2] - held[i, 2]
        d2 = dx * dx + dy * dy + dz * dz
        far = max(far, d2)
        bad += d2 * 0.0
    return far + bad


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
        kind = posts.spec[p, 0]
        bit = posts.spec[p, 1]
        v0 = posts.value[p, 0]
        v1 = posts.value[p, 1]
        v2 = posts.value[p, 2]
        t0 = 0.0
        t1 = 0.0
        t2 = 0.0
        for i in range(n):
            if not parts.mask[i] & bit:
                continue
            t0 += force[i, 0]
            t1 += force[i, 1]
            t2 += force[i, 2]
            if kind == 0:
                force[i, 0] += row[i, 7] * v0
                force[i, 1] += row[i, 7] * v1
                force[i, 2] += row[i, 7] * v2
            elif kind == 1:
                force[i, 0] -= v0 * row[i, 4]
                force[i, 1] -= v0 * row[i, 5]
                force[i, 2] -= v0 * row[i, 6]
            elif kind == 2:
                if posts.spec[p, 2] & 1:
                    force[i, 0] = v0
                if posts.spec[p, 2] & 2:
                    force[i, 1] = v1
                if posts.spec[p, 2] & 4:
                    force[i, 2] = v2
            elif kind == 3:
                force[i, 0] += v0
                force[i, 1] += v1
                force[i, 2] += v2
            elif kind == 4:
                for c in range(6):
                    force[i, c] = 0.0
            elif v0 > 0.0:
                ux = posts.value[p, 3] - row[i, 4]
                uy = posts.value[p, 4] - row[i, 5]
                uz = posts.value[p, 5] - row[i, 6]
                rate = _drag(row[i, 3], sqrt(ux * ux + uy * uy + uz * uz), v0, v1, v2)
                force[i, 0] += rate * ux
                force[i, 1] += rate * uy
                force[i, 2] += rate * uz
        posts.total[p, 0] = t0
        posts.total[p, 1] = t1
        posts.total[p, 2] = t2


@kernel
def apply_range(n: int, parts: Any, posts: Any, first: int, count: int) -> None:
    """Apply some of the body forces, between those that need script variables."""
    apply_posts(n, parts, posts, first, count)


@inner
def second(start: int, stop: int, parts: Any, nve: int) -> None:
    """Make the second half kick of particles `start` to `stop`."""
    row = columns(parts.row, 8)
    spin = columns(parts.spin, 4)
    force = columns(parts.force, 8)
    mask = parts.mask
    for i in range(start, stop):
        if mask[i] & nve:
            a = force[i, 6]
            row[i, 4] += a * force[i, 0]
            row[i, 5] += a * force[i, 1]
            row[i, 6] += a * force[i, 2]
            b = force[i, 7]
            spin[i, 0] += b * force[i, 3]
            spin[i, 1] += b * force[i, 4]
            spin[i, 2] += b * force[i, 5]


@inner
def fly(n: int, parts: Any, step: int, dt: float) -> None:
    """Hold particles of an insertion stream on their straight way until they are released."""
    flight = parts.flight
    row = parts.row
    for i in range(n):
        stop = flight[i, 4]
        if stop < step:
            continue
        passed = (step - flight[i, 3]) * dt
        for c in range(3):
            row[i, c] = flight[i, c] + flight[i, 5 + c] * passed
            row[i, 4 + c] = flight[i, 5 + c]
            parts.spin[i, c] = 0.0
            parts.force[i, c] = 0.0
            parts.force[i, 3 + c] = 0.0
        if stop == step:
            for c in range(3):
                row[i, 4 + c] = flight[i, 8 + c]
                parts.spin[i, c] = flight[i, 11 + c]
