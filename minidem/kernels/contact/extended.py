"""Contact laws that LIGGGHTS 3.8.0 lacks: friction and restitution that depend on speed.

A contact with an extension gets its own friction coefficient and damping; then it is handed to the
same law as every other contact. The loop over pairs here is the plain one, with the model switches
as numbers: it is compiled once for all models and leaves the loop of the base models as it is.
"""

from __future__ import annotations

from math import exp, log, pi, sqrt
from typing import Any

import numpy as np

from minidem.kernels.columns import (  # isort: skip
    X, Y, Z, RADIUS, VX, VY, VZ, MASS, WX, WY, WZ, FX, FY, FZ, TX, TY, TZ, HEAD, REACHED, SX,
    SY, SZ, MX, MY, MZ, IMPACT, CLEAR_HISTORY, FROZEN, TYPES, PAIR_MODEL, DT, REACH2, LENGTH,
    INVERSE, YOUNG, SHEAR, DAMPING, FRICTION, ROLLING_FRICTION, COHESION_ENERGY,
    ROLLING_DAMPING, LOG_RESTITUTION, CHARACTERISTIC_SPEED, STATIC_FRICTION, WEAKENING_SPEED,
    RESTITUTION_EXPONENT, RESTITUTION_SPEED, NORMAL, TANGENTIAL, ROLLING, COHESION,
    TANGENTIAL_DAMPING, LIMIT_FORCE, TORSION_TORQUE, TANGENTIAL_REDUCE, KT_TO_KN, WEAKENS,
    SLOWS, SWITCHES,
)  # fmt: skip
from minidem.kernels.contact.law import contact_law, pair_area
from minidem.kernels.machine.jit import inlined, inner

__all__ = ["IMPACT", "MODEL_AT", "extended_contact", "pair_forces_extended"]

MODEL_AT = PAIR_MODEL
LOWEST_LOG = log(0.05)  # LIGGGHTS refuses a restitution of 0.05 and less
SQRT_5_6 = sqrt(5.0 / 6.0)


@inlined
def extended_contact(
    weakens: int, slows: int, coef: Any, q: int, update: int, impact: float,
    nx: float, ny: float, nz: float, dx: float, dy: float, dz: float,
    vx: float, vy: float, vz: float, wx: float, wy: float, wz: float,
) -> Any:  # fmt: skip
    """Return damping coefficient, friction and log of restitution of a contact.

    Parameters
    ----------
    weakens, slows : int
        1 if friction falls with the sliding speed; if restitution falls with the impact speed.
    coef : float64 (types**2, columns)
        Coefficients, see `minidem.kernels.contact.law.COLUMNS`.
    q : int
        Row of the pair of types.
    update : int
        1 in a time step, 0 at setup: the impact speed is used but not kept.
    impact : float
        Impact speed kept for the contact, m/s; 0 for a new one. Its sign means nothing.
    nx .. wz : float
        As for `minidem.kernels.contact.law.contact_law`.

    Returns
    -------
    tuple of 4 float
        Damping, friction, log of restitution, impact speed to keep.

    Notes
    -----
    Friction: ``mu_k + (mu_s - mu_k) exp(-|v_t| / v_c)``. Restitution: ``e (v / v_0)**-k`` above the
    impact speed ``v_0`` and ``e`` below, at least 0.05; k = 1/4 where the impact yields plastically
    (Johnson, Contact Mechanics, 1985, section 11.5).
    """
    damping = coef[q, DAMPING]
    friction = coef[q, FRICTION]
    loss = coef[q, LOG_RESTITUTION]
    vn = vx * nx + vy * ny + vz * nz
    if weakens == 1:
        tx = vx - vn * nx - (wy * dz - wz * dy)
        ty = vy - vn * ny - (wz * dx - wx * dz)
        tz = vz - vn * nz - (wx * dy - wy * dx)
        slip = sqrt(tx * tx + ty * ty + tz * tz)
        friction += (coef[q, STATIC_FRICTION] - friction) * exp(-slip / coef[q, WEAKENING_SPEED])
    if slows == 1:
        speed = abs(impact)
        if speed == 0.0:
            speed = max(abs(vn), 1e-300)
        if update == 1:
            impact = speed
        if coef[q, RESTITUTION_EXPONENT] > 0.0 and speed > coef[q, RESTITUTION_SPEED]:
            loss = max(
                loss - coef[q, RESTITUTION_EXPONENT] * log(speed / coef[q, RESTITUTION_SPEED]),
                min(loss, LOWEST_LOG),
            )
            damping = -2.0 * SQRT_5_6 * loss / sqrt(loss * loss + pi * pi)
    return damping, friction, loss, impact


@inner
def pair_forces_extended(
    lo: int, hi: int, parts: Any, pairs: Any, coef: Any, whole: Any, real: Any, update: int,
    overflow: Any,
) -> None:  # fmt: skip
    """Add the forces of all pairs to the particles and keep their histories.

    Parameters
    ----------
    lo, hi : int
        Rows whose pairs are meant.
    parts, pairs : tables
        See `minidem.kernels.tables`; histories have seven columns.
    coef : float64 (types**2, columns)
        Contact coefficients.
    whole, real : ndarray
        See `minidem.kernels.control`.
    update : int
        1 in a step, 0 at setup.
    overflow : float64 (cap, 8)
        Receives what is done to rows from `hi` on; its first row says in column 6 how far.
    """
    row = parts.row
    spin = parts.spin
    force = parts.force
    hist = pairs.hist
    types = whole[TYPES]
    frozen = whole[FROZEN]
    clear = whole[CLEAR_HISTORY] == 1
    m = whole[PAIR_MODEL : PAIR_MODEL + SWITCHES]
    far: Any = hi
    for i in range(lo, hi):
        for k in range(pairs.start[i], pairs.start[i + 1]):
            j = np.int64(pairs.other[k])
            dx = row[i, X] - row[j, X]
            dy = row[i, Y] - row[j, Y]
            dz = row[i, Z] - row[j, Z]
            dx -= real[LENGTH + X] * np.rint(dx * real[INVERSE + X])
            dy -= real[LENGTH + Y] * np.rint(dy * real[INVERSE + Y])
            dz -= real[LENGTH + Z] * np.rint(dz * real[INVERSE + Z])
            ri = row[i, RADIUS]
            rj = row[j, RADIUS]
            both = ri + rj
            square = dx * dx + dy * dy + dz * dz
            if not square < both * both:
                if pairs.touch[k] != 0:
                    hist[k, IMPACT] = 0.0
                    if clear and square < real[REACH2] * both * both:
                        pairs.touch[k] = 0
                        for c in range(IMPACT):
                            hist[k, c] = 0.0
                continue
            pairs.touch[k] = 1
            r = sqrt(square)
            inv = 1.0 / r
            overlap = both - r
            mi = row[i, MASS]
            mj = row[j, MASS]
            meff = mi * mj / (mi + mj)
            if frozen != 0:
                if parts.mask[j] & frozen:
                    meff = mi
                elif parts.mask[i] & frozen:
                    meff = mj
            ii = mi * ri * ri
            ij = mj * rj * rj
            area = pair_area(m[COHESION], r, ri, rj, overlap) if m[COHESION] != 0 else 0.0
            ci = ri - 0.5 * overlap
            cj = rj - 0.5 * overlap
            nx = dx * inv
            ny = dy * inv
            nz = dz * inv
            vx = row[i, VX] - row[j, VX]
            vy = row[i, VY] - row[j, VY]
            vz = row[i, VZ] - row[j, VZ]
            wx = (ci * spin[i, WX] + cj * spin[j, WX]) * inv
            wy = (ci * spin[i, WY] + cj * spin[j, WY]) * inv
            wz = (ci * spin[i, WZ] + cj * spin[j, WZ]) * inv
            q = parts.kind[i] * types + parts.kind[j]
            damping, friction, loss, hist[k, IMPACT] = extended_contact(
                m[WEAKENS], m[SLOWS], coef, q, update, hist[k, IMPACT],
                nx, ny, nz, dx, dy, dz, vx, vy, vz, wx, wy, wz,
            )  # fmt: skip
            (fx, fy, fz, tx, ty, tz, ax, ay, az,
             hist[k, SX], hist[k, SY], hist[k, SZ], hist[k, MX], hist[k, MY], hist[k,
             MZ]) = contact_law(
                m[NORMAL], m[TANGENTIAL], m[ROLLING], m[COHESION], m[TANGENTIAL_DAMPING],
                m[LIMIT_FORCE], m[TORSION_TORQUE], m[TANGENTIAL_REDUCE], m[KT_TO_KN],
                coef[q, YOUNG], coef[q, SHEAR], damping, friction, coef[q, ROLLING_FRICTION],
                coef[q, COHESION_ENERGY], coef[q, ROLLING_DAMPING],
                loss, coef[q, CHARACTERISTIC_SPEED], update, real[DT], overlap, area,
                ri * rj / both, meff,
                1.4 * (ii * ij / (ii + ij)), nx, ny, nz, dx, dy, dz, vx, vy, vz, wx, wy, wz,
                spin[i, WX] - spin[j, WX], spin[i, WY] - spin[j, WY], spin[i, WZ] - spin[j, WZ],
                hist[k, SX], hist[k, SY], hist[k, SZ], hist[k, MX], hist[k, MY], hist[k, MZ],
            )  # fmt: skip
            force[i, FX] += fx
            force[i, FY] += fy
            force[i, FZ] += fz
            force[i, TX] += -ci * tx - ax
            force[i, TY] += -ci * ty - ay
            force[i, TZ] += -ci * tz - az
            target = force
            if j >= hi:
                target = overflow
                far = max(far, j + 1)
            target[j, FX] -= fx
            target[j, FY] -= fy
            target[j, FZ] -= fz
            target[j, TX] += -cj * tx + ax
            target[j, TY] += -cj * ty + ay
            target[j, TZ] += -cj * tz + az
    if far > hi:
        overflow[HEAD, REACHED] = far
