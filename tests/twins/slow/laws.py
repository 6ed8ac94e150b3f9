"""The laws of a contact as the textbook has them, on NumPy arrays of three numbers.

Written from the formulas of LIGGGHTS-PUBLIC 3.8.0 (manual: gran model hertz, hooke; tangential
history, no_history; cohesion sjkr, sjkr2; rolling_friction cdt, epsd, epsd2), for those that the
manual lacks (tan_luding, rolling_friction luding) from what they do there, and, for the extensions,
from `minidem.contact.extensions`.

Symbols: d from the other body to the sphere, n = d / |d|, delta overlap, Y, G effective moduli, e
restitution, k_n, k_t, g_n, g_t stiffness and damping, F_n normal force, s tangential displacement,
m rolling torque.
"""

from __future__ import annotations

import struct
from dataclasses import replace
from math import exp, pi, sqrt
from typing import NamedTuple

import numpy as np

from tests.twins.slow.normal import Stiffness
from tests.twins.slow.touch import Materials, Touch

LOWEST_RESTITUTION = 0.05
TIE = 1e-9


class Pull(NamedTuple):
    """Tangential force, N, or rolling torque, N m; what is kept of its spring; see `Result`."""

    value: np.ndarray
    kept: np.ndarray
    tie: bool = False


# -- cohesion --------------------------------------------------------------------------------------


def sjkr(touch: Touch) -> float:
    """Return the area of the disc in which the spheres, or sphere and wall, intersect, m2."""
    r, ri = touch.distance, touch.i.radius
    if touch.j.radius is None:
        return pi * (ri**2 - r**2)
    rj = touch.j.radius
    return -pi / 4.0 * (r - ri - rj) * (r + ri - rj) * (r - ri + rj) * (r + ri + rj) / r**2


def sjkr2(touch: Touch) -> float:
    """Return 2 pi delta (2 R*), of a wall 2 pi delta r, m2."""
    if touch.j.radius is None:
        return 2.0 * pi * touch.delta * touch.i.radius
    return 2.0 * pi * touch.delta * 2.0 * touch.radius


COHESION = {"off": None, "sjkr": sjkr, "sjkr2": sjkr2}


# -- tangential models -----------------------------------------------------------------------------


def is_tie(spring: float, limit: float) -> bool:
    """Return True if rounding decides which is larger."""
    return limit > 0.0 and abs(spring - limit) < TIE * limit


class Slip(NamedTuple):
    """What the tangential models need beside the contact."""

    k: Stiffness
    limit: float
    dt: float
    advance: bool
    slip: float = 1.0


def frictionless(touch: Touch, slip: Slip, s: np.ndarray) -> Pull:
    """No tangential force."""
    del touch, slip
    return Pull(np.zeros(3), s)


def with_history(touch: Touch, slip: Slip, s: np.ndarray) -> Pull:
    """Spring and dashpot until the limit, above it the limit alone."""
    kt = slip.k.kt
    if slip.advance:
        s = s + touch.v_t * slip.dt
        s = s - (s @ touch.n) * touch.n
    spring = kt * float(np.linalg.norm(s))
    tie = is_tie(spring, slip.limit)
    if not spring > slip.limit:
        return Pull(-kt * s - slip.k.gt * touch.v_t, s, tie)
    force = -kt * s * slip.limit / spring
    return Pull(force, -force / kt if slip.advance else s, tie)


def no_history(touch: Touch, slip: Slip, s: np.ndarray) -> Pull:
    """Dashpot, at most the limit."""
    speed = float(np.linalg.norm(touch.v_t))
    if speed == 0.0:
        return Pull(np.zeros(3), s)
    return Pull(-min(slip.k.gt * speed, slip.limit) * touch.v_t / speed, s)


def tan_luding(touch: Touch, slip: Slip, s: np.ndarray) -> Pull:
    """Spring and dashpot until the static limit, above it the dynamic one; kept at setup too."""
    found = with_history(touch, slip, s)
    moved = s
    if slip.advance:
        moved = s + touch.v_t * slip.dt
        moved = moved - (moved @ touch.n) * touch.n
    spring = slip.k.kt * float(np.linalg.norm(moved))
    if not spring > slip.limit:
        return found
    force = -slip.k.kt * moved * slip.limit * slip.slip / spring
    return Pull(force, -force / slip.k.kt, found.tie)


TANGENTIAL = {
    "off": frictionless,
    "history": with_history,
    "no_history": no_history,
    "tan_luding": tan_luding,
}


# -- rolling models --------------------------------------------------------------------------------


class Roll(NamedTuple):
    """What the rolling models need beside the contact; force is |F_n|."""

    k: Stiffness
    resistance: float
    viscosity: float
    force: float
    full: bool
    dt: float
    advance: bool
    stiffness: float = 2.25
    held: float = 0.0
    torsion: bool = False


def across(vector: np.ndarray, touch: Touch, roll: Roll) -> np.ndarray:
    """Return the part of a vector in the contact plane, all of it with ``torsionTorque on``."""
    return vector if roll.full else vector - (vector @ touch.n) * touch.n


def smooth(touch: Touch, roll: Roll, m: np.ndarray) -> Pull:
    """No rolling resistance."""
    del touch, roll
    return Pull(np.zeros(3), m)


def cdt(touch: Touch, roll: Roll, m: np.ndarray) -> Pull:
    """Constant directional torque of the elastic force."""
    speed = float(np.linalg.norm(touch.w_rel))
    if speed == 0.0:
        return Pull(np.zeros(3), m)
    size = roll.resistance * roll.k.kn * touch.delta * touch.radius
    return Pull(across(size * touch.w_rel / speed, touch, roll), m)


def epsd(touch: Touch, roll: Roll, m: np.ndarray) -> Pull:
    """Spring and dashpot until the limit (Ai et al., Powder Technology 206, 2011, 269)."""
    return epsd3(touch, roll._replace(stiffness=2.25), m)


def epsd3(touch: Touch, roll: Roll, m: np.ndarray) -> Pull:
    """Return the same with a factor of the stiffness that is given."""
    kr = roll.stiffness * roll.k.kn * roll.resistance**2 * touch.radius**2
    (torque, kept, tie), at_limit = _spring(kr, touch, roll, m)
    if not at_limit:
        damping = roll.viscosity * 2.0 * sqrt(inertia(touch) * kr)
        torque = torque + damping * across(touch.w_rel, touch, roll)
    return Pull(torque, kept, tie)


def inertia(touch: Touch) -> float:
    """Return the moment of inertia that rolls about the contact, kg m2."""
    found = touch.i.mass * touch.i.radius**2
    if touch.j.radius is not None:
        other = touch.j.mass * touch.j.radius**2
        found = found * other / (found + other)
    return 1.4 * found


def roll_luding(touch: Touch, roll: Roll, m: np.ndarray) -> Pull:
    """Spring and dashpot of rolling, and, by the same spring, of torsion; kept at setup too."""
    kr = roll.stiffness * roll.k.kt * touch.radius**2
    damping = roll.k.gt * roll.viscosity * 2.0 * sqrt(inertia(touch) * kr)
    roll = roll._replace(force=roll.held, advance=True, full=True)
    spin = touch.w_rel
    normal = (spin @ touch.n) * touch.n
    (found, kept, tie), at_limit = _spring(kr, replace(touch, w_rel=spin - normal), roll, m)
    torque = found if at_limit else found + damping * (spin - normal)
    if roll.torsion:
        wall = touch.j.radius is None
        turned = normal * touch.distance / touch.arm if wall else normal
        (found, kept, tie_too), at_limit = _spring(kr, replace(touch, w_rel=turned), roll, kept)
        torque = (torque if wall else 0.0) + (found if at_limit else found + damping * turned)
        tie = tie or tie_too
    return Pull(torque, kept, tie)


def epsd2(touch: Touch, roll: Roll, m: np.ndarray) -> Pull:
    """Spring of the tangential stiffness, no dashpot (Iwashita and Oda)."""
    return _spring(roll.k.kt * touch.radius**2, touch, roll, m)[0]


def _spring(kr: float, touch: Touch, roll: Roll, m: np.ndarray) -> tuple[Pull, bool]:
    """Return the torque of a spring with a limit, and whether it is there."""
    torque = m + kr * roll.dt * across(touch.w_rel, touch, roll)
    limit = roll.resistance * touch.radius * roll.force
    size = float(np.linalg.norm(torque))
    at_limit = size > limit
    if at_limit:
        torque = torque * limit / size
    return Pull(torque, torque if roll.advance else m, is_tie(size, limit)), at_limit


ROLLING = {
    "off": smooth,
    "cdt": cdt,
    "epsd": epsd,
    "epsd2": epsd2,
    "epsd3": epsd3,
    "luding": roll_luding,
}


# -- extensions ------------------------------------------------------------------------------------


def weakened_friction(touch: Touch, materials: Materials) -> float:
    """Return mu_k + (mu_s - mu_k) exp(-v_t / v_c)."""
    kinetic = materials.pair("coefficientFriction", *touch.kinds)
    static = materials.pair("coefficientStaticFriction", *touch.kinds)
    v_c = materials.pair("weakeningVelocity", *touch.kinds)
    return kinetic + (static - kinetic) * exp(-float(np.linalg.norm(touch.v_t)) / v_c)


def slowed_restitution(touch: Touch, materials: Materials, speed: float) -> float:
    """Return e_0 (v / v_0)^-k above v_0, at least 0.05; e_0 below."""
    e = materials.pair("coefficientRestitution", *touch.kinds)
    v_0 = materials.pair("restitutionVelocity", *touch.kinds)
    k = materials.pair("restitutionExponent", *touch.kinds)
    if speed <= v_0:
        return e
    return max(e * (speed / v_0) ** -k, min(e, LOWEST_RESTITUTION))


def lowbias32(word: int) -> int:
    """Return the hash of 32 bits that https://github.com/skeeto/hash-prospector gives."""
    word ^= word >> 16
    word = word * 0x7FEB352D % 2**32
    word ^= word >> 15
    word = word * 0x846CA68B % 2**32
    return word ^ word >> 16


def scattered_restitution(touch: Touch, materials: Materials, e: float, speed: float) -> float:
    """Return e (1 + s x) with x from the speed, uniform in +- sqrt(3); at least 0.05, at most 1."""
    (bits,) = struct.unpack("I", struct.pack("f", speed))
    x = sqrt(3.0) * (lowbias32((bits + 0x9E3779B9) % 2**32) - (2**31 - 0.5)) / 2**31
    s = materials.pair("restitutionDeviation", *touch.kinds)
    return min(max(e * (1.0 + s * x), LOWEST_RESTITUTION), 1.0) if s > 0.0 else e
