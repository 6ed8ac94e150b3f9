"""Contact laws that LIGGGHTS 3.8.0 lacks: friction, restitution and stiffness that differ.

A contact with an extension gets its own friction coefficient, damping and stiffness; then it is
handed to the same law as every other contact. So does one of ``viscous on``, where restitution
follows from the fluid between the surfaces (Legendre et al., Phys. Fluids 17, 2005, 097105).
"""

from __future__ import annotations

from math import exp, log, pi, sqrt
from typing import Any

import numpy as np

from minidem.kernels.models import (  # isort: skip
    STATIC_FRICTION, WEAKENING_SPEED, RESTITUTION_EXPONENT, RESTITUTION_SPEED,
    RESTITUTION_DEVIATION, TANGENTIAL_FACTOR, FLUID_VISCOSITY, CRITICAL_STOKES, MAXIMUM_RESTITUTION,
)  # fmt: skip
from minidem.kernels.contact.records import Material, material
from minidem.kernels.machine.jit import inlined

__all__ = ["extended_contact"]

LOWEST = 0.05  # LIGGGHTS refuses a restitution of 0.05 and less
LOWEST_LOG = log(LOWEST)
SQRT_3 = sqrt(3.0)
SQRT_5_6 = sqrt(5.0 / 6.0)

# a hash of 32 bits: the finaliser lowbias32 by Chris Wellons (2018), public domain
LOW_32 = np.uint64(0xFFFFFFFF)
START = np.uint64(0x9E3779B9)  # the hash alone takes 0, a contact that began at rest, to 0
FIRST, SECOND = np.uint64(0x7FEB352D), np.uint64(0x846CA68B)
SHIFT_15, SHIFT_16 = np.uint64(15), np.uint64(16)


@inlined
def drawn(speed: float) -> Any:
    """Return the number that belongs to an impact speed: mean 0, standard deviation 1.

    Notes
    -----
    Uniform between -sqrt(3) and sqrt(3), by a hash of the speed in single precision: the last
    digits of a speed are rounding, which differs between numbers of threads and compilers.
    """
    word = (np.uint64(np.float32(speed).view(np.uint32)) + START) & LOW_32
    word = ((word ^ (word >> SHIFT_16)) * FIRST) & LOW_32
    word = ((word ^ (word >> SHIFT_15)) * SECOND) & LOW_32
    word = word ^ (word >> SHIFT_16)
    return SQRT_3 * ((np.float64(word) + 0.5) / 2.0**31 - 1.0)


@inlined
def log_restitution_at(switches: Any, coef: Any, q: int, loss: float, speed: float) -> Any:
    """Return ``ln e`` of a contact that began at a speed, from that of its pair of types."""
    if switches.velocity_restitution == 1:
        exponent = coef[q, RESTITUTION_EXPONENT]
        if exponent > 0.0 and speed > coef[q, RESTITUTION_SPEED]:
            lower = loss - exponent * log(speed / coef[q, RESTITUTION_SPEED])
            loss = max(lower, min(loss, LOWEST_LOG))
    if switches.restitution_scatter == 1 and coef[q, RESTITUTION_DEVIATION] > 0.0:
        e = exp(loss) * (1.0 + coef[q, RESTITUTION_DEVIATION] * drawn(speed))
        loss = log(min(max(e, LOWEST), 1.0))
    return loss


@inlined
def extended_contact(
    switches: Any, coef: Any, q: int, contact: Any, impact: float, update: int
) -> Any:
    """Return the coefficients of a contact whose model has extensions.

    Parameters
    ----------
    switches : Switches
        Models.
    coef : float64 (types**2, columns)
        Coefficients, see `minidem.kernels.columns`.
    q : int
        Row of the pair of types.
    contact : Contact
        Geometry and motion.
    impact : float
        Impact speed kept for the contact, m/s; 0 for a new one. Its sign means nothing.
    update : int
        1 in a time step, 0 at setup: the impact speed is used but not kept.

    Returns
    -------
    Material
        With the friction, damping, restitution and stiffness of this contact.
    float
        Impact speed to keep, m/s.

    Notes
    -----
    Friction: ``mu_k + (mu_s - mu_k) exp(-|v_t| / v_c)``. Restitution: ``e (v / v_0)**-k`` above the
    impact speed ``v_0`` and ``e`` below, at least 0.05; k = 1/4 where the impact yields plastically
    (Johnson, Contact Mechanics, 1985, section 11.5). That times ``1 + s x`` with the number x of
    the contact, see `drawn`, at least 0.05 and at most 1. Stiffness: a factor on Mindlin's, which
    is 8 G* a, so on the shear modulus.
    """
    usual = material(coef, q)
    damping = usual.damping
    friction = usual.friction
    shear = usual.shear
    loss = usual.log_restitution
    vn = contact.vx * contact.nx + contact.vy * contact.ny + contact.vz * contact.nz
    if switches.tangential_stiffness == 1:
        shear *= coef[q, TANGENTIAL_FACTOR]
    if switches.static_friction == 1:
        tx = contact.vx - vn * contact.nx - (contact.wy * contact.dz - contact.wz * contact.dy)
        ty = contact.vy - vn * contact.ny - (contact.wz * contact.dx - contact.wx * contact.dz)
        tz = contact.vz - vn * contact.nz - (contact.wx * contact.dy - contact.wy * contact.dx)
        slip = sqrt(tx * tx + ty * ty + tz * tz)
        friction += (coef[q, STATIC_FRICTION] - friction) * exp(-slip / coef[q, WEAKENING_SPEED])
    if switches.viscous == 1:
        drag = 6.0 * pi * coef[q, FLUID_VISCOSITY] * contact.radius * contact.radius
        stokes = contact.mass * vn / drag
        if stokes == 0.0:
            stokes = 1e-300  # LIGGGHTS divides by zero
        loss = log(coef[q, MAXIMUM_RESTITUTION]) + coef[q, CRITICAL_STOKES] / stokes
    if switches.velocity_restitution | switches.restitution_scatter:
        speed = abs(impact)
        if speed == 0.0:
            speed = max(abs(vn), 1e-300)
        if update == 1:
            impact = speed
        loss = log_restitution_at(switches, coef, q, loss, speed)
        if loss != usual.log_restitution:
            damping = -2.0 * SQRT_5_6 * loss / sqrt(loss * loss + pi * pi)
    changed = Material(
        usual.young, shear, damping, friction, usual.rolling, usual.cohesion,
        usual.rolling_damping, loss, usual.speed,
    )  # fmt: skip
    return changed, impact
