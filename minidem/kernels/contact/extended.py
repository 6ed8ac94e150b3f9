"""Contact laws that LIGGGHTS 3.8.0 lacks: friction and restitution that depend on speed.

A contact with an extension gets its own friction coefficient and damping; then it is handed to the
same law as every other contact. The loop over pairs here is the plain one, with the model switches
as numbers: it is compiled once for all models and leaves the loop of the base models as it is.
"""

from __future__ import annotations

from math import exp, log, pi, sqrt
from typing import Any

import numpy as np

from minidem.kernels.contact.law import contact_law, pair_area
from minidem.kernels.machine.jit import inlined, inner

__all__ = ["IMPACT", "MODEL_AT", "extended_contact", "pair_forces_extended"]

IMPACT = 6
"""Column of a contact's history that keeps the impact speed, m/s."""
MODEL_AT = 40
"""First of the eleven switches of the pair style in ``Control.whole``."""
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
    damping = coef[q, 2]
    friction = coef[q, 4]
    loss = coef[q, 8]
    vn = vx * nx + vy * ny + vz * nz
    if weakens == 1:
        tx = vx - vn * nx - (wy * dz - wz * dy)
        ty = vy - vn * ny - (wz * dx - wx * dz)
        tz = vz - vn * nz - (wx * dy - wy * dx)
        slip = sqrt(tx * tx + ty * ty + tz * tz)
        friction += (coef[q, 10] - friction) * exp(-slip / coef[q, 11])
    if slows == 1:
        speed = abs(impact)
        if speed == 0.0:
            speed = max(abs(vn), 1e-300)
        if update == 1:
            impact = speed
        if coef[q, 12] > 0.0 and speed > coef[q, 13]:
            loss = max(loss - coef[q, 12] * log(speed / coef[q, 13]), min(loss, LOWEST_LOG))
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
    types = whole[15]
    frozen = whole[14]
    clear = whole[9] == 1
    m = whole[MODEL_AT : MODEL_AT + 11]
    far: Any = hi
    for i in range(lo, hi):
        for k in range(pairs.start[i], pairs.start[i + 1]):
            j = np.int64(pairs.other[k])
            dx = row[i, 0] - row[j, 0]
            dy = row[i, 1] - row[j, 1]
            dz = row[i, 2] - row[j, 2]
            dx -= real[3] * np.rint(dx * real[6])
            dy -= real[4] * np.rint(dy * real[7])
            dz -= real[5] * np.rint(dz * real[8])
            ri = row[i, 3]
            rj = row[j, 3]
            both = ri + rj
            square = dx * dx + dy * dy + dz * dz
            if not square < both * both:
                if pairs.touch[k] != 0:
                    hist[k, IMPACT] = 0.0
                    if clear and square < real[2] * both * both:
                        pairs.touch[k] = 0
                        for c in range(IMPACT):
                            hist[k, c] = 0.0
                continue
            pairs.touch[k] = 1
            r = sqrt(square)
            inv = 1.0 / r
            overlap = both - r
            mi = row[i, 7]
            mj = row[j, 7]
            meff = mi * mj / (mi + mj)
            if frozen != 0:
                if parts.mask[j] & frozen:
                    meff = mi
                elif parts.mask[i] & frozen:
                    meff = mj
            ii = mi * ri * ri
            ij = mj * rj * rj
            area = pair_area(m[3], r, ri, rj, overlap) if m[3] != 0 else 0.0
            ci = ri - 0.5 * overlap
            cj = rj - 0.5 * overlap
            nx = dx * inv
            ny = dy * inv
            nz = dz * inv
            vx = row[i, 4] - row[j, 4]
            vy = row[i, 5] - row[j, 5]
            vz = row[i, 6] - row[j, 6]
            wx = (ci * spin[i, 0] + cj * spin[j, 0]) * inv
            wy = (ci * spin[i, 1] + cj * spin[j, 1]) * inv
            wz = (ci * spin[i, 2] + cj * spin[j, 2]) * inv
            q = parts.kind[i] * types + parts.kind[j]
            damping, friction, loss, hist[k, IMPACT] = extended_contact(
                m[9], m[10], coef, q, update, hist[k, IMPACT],
                nx, ny, nz, dx, dy, dz, vx, vy, vz, wx, wy, wz,
            )  # fmt: skip
            (fx, fy, fz, tx, ty, tz, ax, ay, az,
             hist[k, 0], hist[k, 1], hist[k, 2], hist[k, 3], hist[k, 4], hist[k, 5]) = contact_law(
                m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8],
                coef[q, 0], coef[q, 1], damping, friction, coef[q, 5], coef[q, 6], coef[q, 7],
                loss, coef[q, 9], update, real[0], overlap, area, ri * rj / both, meff,
                1.4 * (ii * ij / (ii + ij)), nx, ny, nz, dx, dy, dz, vx, vy, vz, wx, wy, wz,
                spin[i, 0] - spin[j, 0], spin[i, 1] - spin[j, 1], spin[i, 2] - spin[j, 2],
                hist[k, 0], hist[k, 1], hist[k, 2], hist[k, 3], hist[k, 4], hist[k, 5],
            )  # fmt: skip
            force[i, 0] += fx
            force[i, 1] += fy
            force[i, 2] += fz
            force[i, 3] += -ci * tx - ax
            force[i, 4] += -ci * ty - ay
            force[i, 5] += -ci * tz - az
            target = force
            if j >= hi:
                target = overflow
                far = max(far, j + 1)
            target[j, 0] -= fx
            target[j, 1] -= fy
            target[j, 2] -= fz
            target[j, 3] += -cj * tx + ax
            target[j, 4] += -cj * ty + ay
            target[j, 5] += -cj * tz + az
    if far > hi:
        overflow[0, 6] = far
