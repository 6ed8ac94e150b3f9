"""Contact laws that LIGGGHTS 3.8.0 lacks: friction, restitution and stiffness that differ.

A contact with an extension gets its own friction coefficient, damping and stiffness; then it is
handed to the same law as every other contact. The loop over pairs here is the plain one, with the
model switches as numbers: it is compiled once for all models and leaves the loop of the base models
as it is.
"""

from __future__ import annotations

from math import exp, log, pi, sqrt
from typing import Any

import numpy as np

from minidem.kernels.columns import (  # isort: skip
    RADIUS, FX, FY, FZ, TX, TY, TZ, HEAD, REACHED, SX, IMPACT, CLEAR_HISTORY, TYPES, PAIR_MODEL,
    DT, REACH2, STATIC_FRICTION, WEAKENING_SPEED, RESTITUTION_EXPONENT, RESTITUTION_SPEED,
    RESTITUTION_DEVIATION, TANGENTIAL_FACTOR,
)  # fmt: skip
from minidem.kernels.contact.law import contact_law
from minidem.kernels.contact.pair_contact import apart, meet
from minidem.kernels.contact.records import (
    Material,
    material,
    recall,
    remember,
    switches,
)
from minidem.kernels.machine.jit import inlined, inner

__all__ = ["extended_contact", "pair_forces_general"]

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


@inner
def pair_forces_general(
    lo: int, hi: int, bodies: Any, pairs: Any, update: int, overflow: Any
) -> None:
    """Add the forces of all pairs to the particles and keep their histories.

    Parameters
    ----------
    lo, hi : int
        Rows whose pairs are meant.
    bodies : Bodies
        See `minidem.kernels.tables`.
    pairs : Pairs
        The list in use; its histories have seven columns.
    update : int
        1 in a step, 0 at setup.
    overflow : float64 (cap, 8)
        Receives what is done to rows from `hi` on; its first row says how far that is.
    """
    parts = bodies.parts
    coef = bodies.coef
    whole = bodies.control.whole
    real = bodies.control.real
    row = parts.row
    force = parts.force
    hist = pairs.hist
    types = whole[TYPES]
    clear = whole[CLEAR_HISTORY] == 1
    model = switches(whole, PAIR_MODEL)
    keeps = hist.shape[1] > IMPACT
    far: Any = hi
    for i in range(lo, hi):
        for k in range(pairs.start[i], pairs.start[i + 1]):
            j = np.int64(pairs.other[k])
            between = apart(bodies, i, j)
            dx, dy, dz = between
            both = row[i, RADIUS] + row[j, RADIUS]
            square = dx * dx + dy * dy + dz * dz
            if not square < both * both:
                if pairs.touch[k] != 0:
                    if keeps:
                        hist[k, IMPACT] = 0.0
                    if clear and square < real[REACH2] * both * both:
                        pairs.touch[k] = 0
                        for c in range(SX, min(IMPACT, hist.shape[1])):
                            hist[k, c] = 0.0
                continue
            pairs.touch[k] = 1
            contact, ci, cj = meet(bodies, model, i, j, between)
            q = parts.kind[i] * types + parts.kind[j]
            before = hist[k, IMPACT] if keeps else 0.0
            own, impact = extended_contact(model, coef, q, contact, before, update)
            if keeps:
                hist[k, IMPACT] = impact
            did, kept = contact_law(model, own, contact, recall(hist, k), update, real[DT])
            remember(hist, k, kept)
            force[i, FX] += did.fx
            force[i, FY] += did.fy
            force[i, FZ] += did.fz
            force[i, TX] += -ci * did.tx - did.rx
            force[i, TY] += -ci * did.ty - did.ry
            force[i, TZ] += -ci * did.tz - did.rz
            target = force
            if j >= hi:
                target = overflow
                far = max(far, j + 1)
            target[j, FX] -= did.fx
            target[j, FY] -= did.fy
            target[j, FZ] -= did.fz
            target[j, TX] += -cj * did.tx + did.rx
            target[j, TY] += -cj * did.ty + did.ry
            target[j, TZ] += -cj * did.tz + did.rz
    if far > hi:
        overflow[HEAD, REACHED] = far
