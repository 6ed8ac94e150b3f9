"""Forces between particles of all models: one contact after the other, switches as numbers.

This loop is compiled once for all models, those that have no loop of their own and those with
extensions too.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np

from minidem.kernels.columns import (  # isort: skip
    RADIUS, FX, FY, FZ, TX, TY, TZ, HEAD, REACHED, IMPACT, ADHESION, CLEAR_HISTORY, TYPES,
    PAIR_MODEL, REACH2,
)  # fmt: skip
from minidem.kernels.contact.laws.bridges import lasts, stretched
from minidem.kernels.contact.laws.liquid import drain_bridge, drops_of
from minidem.kernels.contact.normal import act
from minidem.kernels.contact.pair_contact import apart, meet
from minidem.kernels.contact.records import switches
from minidem.kernels.machine.jit import inner
from minidem.kernels.models import EASO

__all__ = ["pair_forces_general"]


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
        The list in use; its histories have as many columns as the model needs.
    update : int
        1 in a step, 0 at setup.
    overflow : float64 (cap, 8)
        Receives what is done to rows from `hi` on; its first row says how far that is.
    """
    parts = bodies.parts
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
                bridged = pairs.touch[k]
                if bridged != 0:
                    if keeps:
                        hist[k, IMPACT] = 0.0
                    if clear and square < real[REACH2] * both * both:
                        pairs.touch[k] = 0
                        for c in range(hist.shape[1]):
                            if c != ADHESION:  # which LIGGGHTS leaves
                                hist[k, c] = 0.0
                if model.cohesion < EASO or not square < real[REACH2] * both * both:
                    continue
                if bridged == 0 and model.cohesion == EASO:  # it forms at contact
                    continue
                q = parts.kind[i] * types + parts.kind[j]
                drops = drops_of(model, bodies, q, (i, j))
                mine, other = drops
                volume = mine + other
                if not lasts(bodies.coef[q], sqrt(square) - both, both, volume):
                    if bridged != 0:
                        drain_bridge(bodies, (i, j), drops, hi, overflow)
                        if j >= hi:
                            far = max(far, j + 1)
                    continue
                pairs.touch[k] = 1
                contact, ci, cj = meet(bodies, model, i, j, between)
                sizes = row[i, RADIUS], row[j, RADIUS]
                did = stretched(model.cohesion, bodies.coef[q], sizes, contact, drops)
            else:
                pairs.touch[k] = 1
                contact, ci, cj = meet(bodies, model, i, j, between)
                q = parts.kind[i] * types + parts.kind[j]
                did = act(model, bodies, q, contact, (i, j), hist, k, update)
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
