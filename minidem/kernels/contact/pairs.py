"""Forces between particles: the contacts of a range of rows of the half neighbour list.

Contacts are worked on in blocks: a scan of the list collects touching pairs, their data are
gathered field after field, the law runs over the block, four contacts at a time where the machine
can, and the results are added in the order of the list.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import sqrt
from typing import Any

import numpy as np

from minidem.kernels.columns import (  # isort: skip
    X, Y, Z, RADIUS, VX, VY, VZ, MASS, ROW, WX, WY, WZ, SPIN, FX, FY, FZ, TX, TY, TZ, FORCE, HEAD,
    REACHED, SX, SY, SZ, MX, MY, MZ, SLIDING_ONLY, WITH_ROLLING, CLEAR_HISTORY, FROZEN, TYPES, DT,
    REACH2, LENGTH, INVERSE, SKIN,
)  # fmt: skip
from minidem.kernels.contact.block import BLOCK, material_of, memory_of, store_memory
from minidem.kernels.contact.law import contact_law, pair_area
from minidem.kernels.contact.records import Contact, Switches
from minidem.kernels.machine.jit import inner
from minidem.kernels.machine.space import columns, fetch, indices, vector
from minidem.kernels.models import BASIC
from minidem.kernels.near import NEAR, WORTH, is_time

__all__ = ["pair_forces_for"]

PLACES = BLOCK + 1  # a pair that does not touch is written to the last before it is dropped
FRESH = np.uint64(2**63)
STRETCH = 16  # entries of the list between two looks at the room in the block
FULL = np.uint64(BLOCK - STRETCH)

# where the fields of a block begin
(
    LEVER_X, LEVER_Y, LEVER_Z,  # from j to i, m
    SQUARE,  # of the distance, m2
    RADIUS_I, RADIUS_J, MASS_I, MASS_J,
    SPEED_X, SPEED_Y, SPEED_Z,  # of i relative to j, m/s
    SPIN_IX, SPIN_IY, SPIN_IZ, SPIN_JX, SPIN_JY, SPIN_JZ,  # rad/s
    SHIFT_X, SHIFT_Y, SHIFT_Z,  # tangential displacement, m
    SPRING_X, SPRING_Y, SPRING_Z,  # stored torque, N m
    EFFECTIVE,  # mass if one of the two is frozen, else 0, kg
    MATERIAL,  # the coefficients, as many as `BASIC`
) = range(0, 25 * BLOCK, BLOCK)  # fmt: skip
NUMBERS = MATERIAL + BASIC * BLOCK
# the law overwrites what it has read: force on i, N, and torques, N m
PUSH_X, PUSH_Y, PUSH_Z, TWIST_IX, TWIST_IY, TWIST_IZ, TWIST_JX, TWIST_JY, TWIST_JZ = range(
    0, 9 * BLOCK, BLOCK
)
# the fields that the scan of the list fills; unsigned, so that the compiler need not provide for
# negative indices
NEW_LEVER_Y, NEW_LEVER_Z, NEW_SQUARE = np.uint64(LEVER_Y), np.uint64(LEVER_Z), np.uint64(SQUARE)


@cache
def pair_forces_for(
    switches: tuple[int, ...], *, periodic: bool, shared: bool
) -> Callable[..., None]:
    """Return the pair loop for nine model switches.

    Parameters
    ----------
    switches : tuple of int
        See `minidem.kernels.contact.records.Switches`.
    periodic : bool
        True if a direction of the box is periodic.
    shared : bool
        True if other threads work on other rows: then what is done to rows from ``hi`` on goes
        to ``overflow``, and ``overflow[HEAD, REACHED]`` says up to which row.

    Returns
    -------
    callable
        ``pair_forces(lo, hi, bodies, pairs, update, overflow)`` for kernels: adds the forces of the
        pairs that rows ``lo`` to ``hi`` own.
    """
    model = Switches(*switches)
    wide = WITH_ROLLING if model.rolling >= 2 else SLIDING_ONLY
    wrap = 1 if periodic else 0
    apart = 1 if shared else 0

    @inner
    def pair_forces(lo: int, hi: int, bodies: Any, pairs: Any, update: int, overflow: Any) -> None:
        parts = bodies.parts
        coef = bodies.coef
        whole = bodies.control.whole
        real = bodies.control.real
        row = columns(parts.row, ROW)
        spin = columns(parts.spin, SPIN)
        force = columns(parts.force, FORCE)
        kind = parts.kind
        types = whole[TYPES]
        dt = real[DT]
        reach2 = real[REACH2]
        clear = whole[CLEAR_HISTORY] == 1
        frozen = whole[FROZEN]
        start = pairs.start
        owner = pairs.owner
        other = pairs.other
        touch = pairs.touch
        hist = columns(pairs.hist, wide)
        spill = columns(overflow, FORCE)
        left = indices(PLACES)
        right = indices(PLACES)
        entry = indices(PLACES)
        slot = indices(BLOCK)
        for c in range(BLOCK):
            slot[c] = FRESH
        b = vector(NUMBERS)
        for c in range(SPRING_X, MATERIAL):
            b[c] = 0.0  # stays so without stored torques, without frozen particles
        far: Any = hi
        k = start[lo]
        last = start[hi]
        soon = pairs.soon
        close = NEAR * real[SKIN]
        fill = is_time(real)
        alone = pairs.found[lo] >= 0 and not fill
        if alone:
            last = k + pairs.found[lo]
        top = np.uint64(k)
        while k < last:
            # find touching pairs, as long as the block has room for another stretch of the list
            m = np.uint64(0)
            while k < last and m <= FULL:
                stop = min(last, k + STRETCH)
                for place in range(np.uint64(k), np.uint64(stop)):
                    kk: Any = place
                    if alone:
                        kk = np.uint64(soon[place])
                    i = owner[kk]
                    j = other[kk]
                    dx = row[i, X] - row[j, X]
                    dy = row[i, Y] - row[j, Y]
                    dz = row[i, Z] - row[j, Z]
                    if wrap == 1:
                        dx -= real[LENGTH + X] * np.rint(dx * real[INVERSE + X])
                        dy -= real[LENGTH + Y] * np.rint(dy * real[INVERSE + Y])
                        dz -= real[LENGTH + Z] * np.rint(dz * real[INVERSE + Z])
                    both = row[i, RADIUS] + row[j, RADIUS]
                    square = dx * dx + dy * dy + dz * dz
                    hit = square < both * both
                    left[m] = i
                    right[m] = j
                    entry[m] = kk
                    b[m] = dx
                    b[NEW_LEVER_Y + m] = dy
                    b[NEW_LEVER_Z + m] = dz
                    b[NEW_SQUARE + m] = square
                    m += np.uint64(hit)
                    fetch(spin, j)
                    fetch(force, j)
                    if touch[kk] > np.uint8(hit) and clear and square < reach2 * both * both:
                        touch[kk] = 0
                        for c in range(wide):
                            hist[kk, c] = 0.0
                    if fill:
                        soon[top] = kk
                        within = both + close
                        top += np.uint64(square < within * within or touch[kk] != 0)
                k = stop
            # gather what the law needs, field after field
            found = np.int64(m)
            for c in range(found):
                p = left[c]
                q = right[c]
                h = entry[c]
                b[RADIUS_I + c] = row[p, RADIUS]
                b[RADIUS_J + c] = row[q, RADIUS]
                b[MASS_I + c] = row[p, MASS]
                b[MASS_J + c] = row[q, MASS]
                b[SPEED_X + c] = row[p, VX] - row[q, VX]
                b[SPEED_Y + c] = row[p, VY] - row[q, VY]
                b[SPEED_Z + c] = row[p, VZ] - row[q, VZ]
                b[SPIN_IX + c] = spin[p, WX]
                b[SPIN_IY + c] = spin[p, WY]
                b[SPIN_IZ + c] = spin[p, WZ]
                b[SPIN_JX + c] = spin[q, WX]
                b[SPIN_JY + c] = spin[q, WY]
                b[SPIN_JZ + c] = spin[q, WZ]
                b[SHIFT_X + c] = hist[h, SX]
                b[SHIFT_Y + c] = hist[h, SY]
                b[SHIFT_Z + c] = hist[h, SZ]
                if wide == WITH_ROLLING:
                    b[SPRING_X + c] = hist[h, MX]
                    b[SPRING_Y + c] = hist[h, MY]
                    b[SPRING_Z + c] = hist[h, MZ]
                if frozen != 0:
                    b[EFFECTIVE + c] = 0.0
                    if parts.mask[p] & frozen:
                        b[EFFECTIVE + c] = row[q, MASS]
                    if parts.mask[q] & frozen:
                        b[EFFECTIVE + c] = row[p, MASS]
                pick = np.uint64(kind[p] * types + kind[q])
                if pick != slot[c]:
                    slot[c] = pick
                    for f in range(BASIC):
                        b[MATERIAL + f * BLOCK + c] = coef[pick, f]
            # the law, four contacts at a time where the machine can
            for c in range(found):
                r = sqrt(b[SQUARE + c])
                inv = 1.0 / r
                ri = b[RADIUS_I + c]
                rj = b[RADIUS_J + c]
                mi = b[MASS_I + c]
                mj = b[MASS_J + c]
                both = ri + rj
                overlap = both - r
                meff = mi * mj / (mi + mj)
                if b[EFFECTIVE + c] > 0.0:
                    meff = b[EFFECTIVE + c]
                area = 0.0
                if model.cohesion != 0:
                    area = pair_area(model.cohesion, r, ri, rj, overlap)
                inertia = 0.0
                if model.rolling == 2:
                    ii = mi * ri * ri
                    ij = mj * rj * rj
                    inertia = 1.4 * (ii * ij / (ii + ij))
                ci = ri - 0.5 * overlap
                cj = rj - 0.5 * overlap
                wix = b[SPIN_IX + c]
                wiy = b[SPIN_IY + c]
                wiz = b[SPIN_IZ + c]
                wjx = b[SPIN_JX + c]
                wjy = b[SPIN_JY + c]
                wjz = b[SPIN_JZ + c]
                dx = b[LEVER_X + c]
                dy = b[LEVER_Y + c]
                dz = b[LEVER_Z + c]
                own = material_of(b, MATERIAL, c)
                contact = Contact(
                    overlap, area, ri * rj / both, meff, inertia,
                    dx * inv, dy * inv, dz * inv, dx, dy, dz,
                    b[SPEED_X + c], b[SPEED_Y + c], b[SPEED_Z + c],
                    (ci * wix + cj * wjx) * inv, (ci * wiy + cj * wjy) * inv,
                    (ci * wiz + cj * wjz) * inv, wix - wjx, wiy - wjy, wiz - wjz,
                )  # fmt: skip
                memory = memory_of(b, SHIFT_X, c)
                did, kept = contact_law(model, own, contact, memory, update, dt)
                b[PUSH_X + c] = did.fx
                b[PUSH_Y + c] = did.fy
                b[PUSH_Z + c] = did.fz
                b[TWIST_IX + c] = -ci * did.tx - did.rx
                b[TWIST_IY + c] = -ci * did.ty - did.ry
                b[TWIST_IZ + c] = -ci * did.tz - did.rz
                b[TWIST_JX + c] = -cj * did.tx + did.rx
                b[TWIST_JY + c] = -cj * did.ty + did.ry
                b[TWIST_JZ + c] = -cj * did.tz + did.rz
                store_memory(b, SHIFT_X, c, kept)
            for c in range(found):
                p = left[c]
                q = right[c]
                h = entry[c]
                touch[h] = 1
                force[p, FX] += b[PUSH_X + c]
                force[p, FY] += b[PUSH_Y + c]
                force[p, FZ] += b[PUSH_Z + c]
                force[p, TX] += b[TWIST_IX + c]
                force[p, TY] += b[TWIST_IY + c]
                force[p, TZ] += b[TWIST_IZ + c]
                target = force
                if apart == 1 and np.int64(q) >= hi:
                    target = spill
                    far = max(far, np.int64(q) + 1)
                target[q, FX] -= b[PUSH_X + c]
                target[q, FY] -= b[PUSH_Y + c]
                target[q, FZ] -= b[PUSH_Z + c]
                target[q, TX] += b[TWIST_JX + c]
                target[q, TY] += b[TWIST_JY + c]
                target[q, TZ] += b[TWIST_JZ + c]
                hist[h, SX] = b[SHIFT_X + c]
                hist[h, SY] = b[SHIFT_Y + c]
                hist[h, SZ] = b[SHIFT_Z + c]
                if wide == WITH_ROLLING:
                    hist[h, MX] = b[SPRING_X + c]
                    hist[h, MY] = b[SPRING_Y + c]
                    hist[h, MZ] = b[SPRING_Z + c]
        if fill:
            count = np.int64(top) - start[lo]
            pairs.found[lo] = count if count <= WORTH * (last - start[lo]) else -1
        if apart == 1:
            spill[HEAD, REACHED] = far

    made: Callable[..., None] = pair_forces
    return made
