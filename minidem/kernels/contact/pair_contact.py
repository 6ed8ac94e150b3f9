"""The geometry and motion of one contact of two particles, for loops that take one at a time."""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np

from minidem.kernels.columns import (  # isort: skip
    X, Y, Z, RADIUS, VX, VY, VZ, MASS, WX, WY, WZ, FROZEN, LENGTH, INVERSE,
)  # fmt: skip
from minidem.kernels.contact.law import pair_area
from minidem.kernels.contact.records import Contact
from minidem.kernels.machine.jit import inlined

__all__ = ["apart", "meet"]


@inlined
def apart(bodies: Any, i: Any, j: Any) -> Any:
    """Return the vector from the nearest image of particle j to particle i, m."""
    row = bodies.parts.row
    real = bodies.control.real
    dx = row[i, X] - row[j, X]
    dy = row[i, Y] - row[j, Y]
    dz = row[i, Z] - row[j, Z]
    dx -= real[LENGTH + X] * np.rint(dx * real[INVERSE + X])
    dy -= real[LENGTH + Y] * np.rint(dy * real[INVERSE + Y])
    dz -= real[LENGTH + Z] * np.rint(dz * real[INVERSE + Z])
    return dx, dy, dz


@inlined
def meet(bodies: Any, model: Any, i: Any, j: Any, between: Any) -> Any:
    """Work out a contact of two particles.

    Parameters
    ----------
    bodies : Bodies
        See `minidem.kernels.scene`.
    model : Switches
        Models.
    i, j : int
        Rows of the particles, which may be apart.
    between : (float, float, float)
        From j to i, m, see `apart`.

    Returns
    -------
    Contact
        Geometry and motion.
    float, float
        From the centres of i and j to the point of contact, or across a gap to the surface, m.
    """
    parts = bodies.parts
    row = parts.row
    spin = parts.spin
    frozen = bodies.control.whole[FROZEN]
    dx, dy, dz = between
    ri = row[i, RADIUS]
    rj = row[j, RADIUS]
    both = ri + rj
    r = sqrt(dx * dx + dy * dy + dz * dz)
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
    area = 0.0
    if model.cohesion != 0:
        area = pair_area(model.cohesion, r, ri, rj, overlap)
    depth = 0.5 * max(overlap, 0.0)
    ci = ri - depth
    cj = rj - depth
    contact = Contact(
        overlap, area, ri * rj / both, meff, 1.4 * (ii * ij / (ii + ij)),
        dx * inv, dy * inv, dz * inv, dx, dy, dz,
        row[i, VX] - row[j, VX], row[i, VY] - row[j, VY], row[i, VZ] - row[j, VZ],
        (ci * spin[i, WX] + cj * spin[j, WX]) * inv,
        (ci * spin[i, WY] + cj * spin[j, WY]) * inv,
        (ci * spin[i, WZ] + cj * spin[j, WZ]) * inv,
        spin[i, WX] - spin[j, WX], spin[i, WY] - spin[j, WY], spin[i, WZ] - spin[j, WZ],
    )  # fmt: skip
    return contact, ci, cj
