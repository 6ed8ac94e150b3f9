"""Rolling and torsion by springs with a limit that adhesion raises: ``rolling_friction luding``."""

from __future__ import annotations

from math import sqrt
from typing import Any

from minidem.kernels.machine.jit import inlined

__all__ = ["turn_luding"]


@inlined
def turn_luding(
    switches: Any, material: Any, contact: Any, memory: Any, load: Any, limit: float, dt: float
) -> Any:
    """Return the torque of a contact on its first particle, N m, and the torque to be kept, N m.

    Parameters
    ----------
    switches, material, contact, load : Switches, Material, Contact, Load
        See `minidem.kernels.contact.records`.
    memory : Memory
        What the contact kept.
    limit : float
        Largest torque, N m.
    dt : float
        Step, s.

    Notes
    -----
    As in LIGGGHTS 3.8.0 the spring advances at the setup of a run too; one spring serves rolling
    and torsion; between particles torsion takes the place of the dashpot of rolling, and at walls
    the torque of the spring counts twice.
    """
    nx, ny, nz = contact.nx, contact.ny, contact.nz
    ux, uy, uz = contact.ux, contact.uy, contact.uz
    stiff = load.kt * load.roll_stiffness * contact.radius * contact.radius
    damp = load.gt * material.rolling_damping * 2.0 * sqrt(contact.inertia * stiff)
    along = ux * nx + uy * ny + uz * nz
    tx = ux - along * nx
    ty = uy - along * ny
    tz = uz - along * nz
    mx, my, mz, held = _spring(memory.mx, memory.my, memory.mz, stiff * dt, (tx, ty, tz), limit)
    ax, ay, az = mx, my, mz
    if held:
        ax += damp * tx
        ay += damp * ty
        az += damp * tz
    if switches.torsion == 1:
        wall = load.turn > 0.0
        if wall:
            along *= load.turn
        tx = along * nx
        ty = along * ny
        tz = along * nz
        mx, my, mz, held = _spring(mx, my, mz, stiff * dt, (tx, ty, tz), limit)
        if not wall:
            ax = 0.0
            ay = 0.0
            az = 0.0
        ax += mx
        ay += my
        az += mz
        if held:
            ax += damp * tx
            ay += damp * ty
            az += damp * tz
    return (ax, ay, az), (mx, my, mz)


@inlined
def _spring(mx: float, my: float, mz: float, stiff: float, turned: Any, limit: float) -> Any:
    """Return the torque of a spring that was turned on, and whether it is below its limit."""
    tx, ty, tz = turned
    ax = mx + stiff * tx
    ay = my + stiff * ty
    az = mz + stiff * tz
    square = ax * ax + ay * ay + az * az
    held = square <= limit * limit
    if not held:
        scale = limit / sqrt(square)
        ax *= scale
        ay *= scale
        az *= scale
    return ax, ay, az, held
