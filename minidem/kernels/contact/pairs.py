"""Forces between particles: the contacts of a range of rows of the half neighbour list.

Contacts are worked on in blocks: a scan of the list collects touching pairs, their rows are turned
into fields, the law runs over the block, several contacts at a time where the machine can, and
the results are turned back and added in the order of the list.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import sqrt
from typing import Any

import numpy as np

from minidem.kernels.columns import (  # isort: skip
    X, Y, Z, RADIUS, VX, MASS, ROW, WX, SPIN, FX, TY, FORCE, HEAD, REACHED, SX, SY, SZ,
    SLIDING_ONLY, WITH_ROLLING, CLEAR_HISTORY, FROZEN, TYPES, DT, REACH2, LENGTH, INVERSE,
    PARTICLES,
)  # fmt: skip
from minidem.kernels.contact.pair_block import (  # isort: skip
    X_I, Y_I, Z_I, RADIUS_I, VX_I, VY_I, VZ_I, MASS_I, X_J, Y_J, Z_J, RADIUS_J, VX_J, VY_J, VZ_J,
    MASS_J, SPIN_IX, SPIN_IY, SPIN_IZ, SPIN_JX, SPIN_JY, SPIN_JZ, SHIFT_X, SHIFT_Y, SHIFT_Z,
    EFFECTIVE, MATERIAL, NUMBERS, PUSH_X, PUSH_Y, PUSH_Z, TWIST_IX, TWIST_IY, TWIST_IZ, TWIST_JX,
    TWIST_JY, TWIST_JZ, PULL_X, PULL_Y, PULL_Z, ON_I, BOTH, ON_J, KEPT, KEPT_LATE, LINES,
)  # fmt: skip
from minidem.kernels.machine.space import (  # isort: skip
    add_four, add_two, collect, columns, fetch, indices, put_four, spread, vector,
)  # fmt: skip
from minidem.kernels.contact.block import BLOCK, FOUR, LANES, material_of, memory_of, store_memory
from minidem.kernels.contact.law import contact_law, pair_area
from minidem.kernels.contact.records import Contact, Switches
from minidem.kernels.machine.jit import inner
from minidem.kernels.models import BASIC
from minidem.kernels.near import MANY, WORTH, is_time, within

__all__ = ["pair_forces_for"]

PLACES = BLOCK + 1  # a pair that does not touch is written to the last before it is dropped
FRESH = np.uint64(2**63)
STRETCH = 8  # entries of the list between two looks at the room in the block
FULL = np.uint64(BLOCK - STRETCH)
AHEAD = np.uint64(24)  # entries of the list between asking for a position and using it


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
        many = whole[PARTICLES] >= MANY  # what is not in the nearest cache is asked for ahead
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
        lines = vector(LINES)
        b = vector(NUMBERS)
        for c in range(NUMBERS):
            b[c] = 0.0
        k = start[lo]
        for c in range(BLOCK):
            slot[c] = FRESH
            left[c] = np.uint64(lo)
            right[c] = np.uint64(lo)
            entry[c] = np.uint64(k)
        far: Any = hi
        soon = pairs.soon
        close = within(real)
        fill = is_time(real)
        alone = pairs.found[lo] >= 0 and not fill
        last = k + pairs.found[lo] if alone else start[hi]
        top = np.uint64(k)
        m = np.uint64(0)
        while k < last or m > np.uint64(0):
            # find touching pairs, as long as the block has room for another stretch of the list
            while k < last and m <= FULL:
                stop = min(last, k + STRETCH)
                for place in range(np.uint64(k), np.uint64(stop)):
                    kk: Any = place
                    if alone:
                        kk = np.uint64(soon[place])
                    i = owner[kk]
                    j = other[kk]
                    if many:
                        later: Any = min(place + AHEAD, np.uint64(last - 1))
                        if alone:
                            later = np.uint64(soon[later])
                        fetch(row, other[later])
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
                    m += np.uint64(hit)
                    if many:
                        fetch(spin, j)
                        fetch(force, j)
                        known = kk * np.uint64(touch[kk])  # only what touches has a history
                        fetch(hist, known)
                        fetch(hist, known + np.uint64(1))
                    if touch[kk] > np.uint8(hit) and clear and square < reach2 * both * both:
                        touch[kk] = 0
                        for c in range(wide):
                            hist[kk, c] = 0.0
                    if fill:
                        soon[top] = kk
                        near = both + close
                        top += np.uint64(square < near * near or touch[kk] != 0)
                k = stop
            # whole groups of lanes now; the rest with what comes next, if anything does
            found: Any = np.int64(m)
            if k < last:
                found -= found % LANES
            # gather what the law needs, field after field
            for c in range(0, found, FOUR):
                spread(row, X, left, c, b, X_I, BLOCK)
                spread(row, VX, left, c, b, VX_I, BLOCK)
                spread(row, X, right, c, b, X_J, BLOCK)
                spread(row, VX, right, c, b, VX_J, BLOCK)
                spread(spin, WX, left, c, b, SPIN_IX, BLOCK)
                spread(spin, WX, right, c, b, SPIN_JX, BLOCK)
                if wide == WITH_ROLLING:
                    spread(hist, SX, entry, c, b, SHIFT_X, BLOCK)
                    spread(hist, SZ, entry, c, b, SHIFT_Z, BLOCK)
            for c in range(found):
                p = left[c]
                q = right[c]
                if wide != WITH_ROLLING:
                    h = entry[c]
                    b[SHIFT_X + c] = hist[h, SX]
                    b[SHIFT_Y + c] = hist[h, SY]
                    b[SHIFT_Z + c] = hist[h, SZ]
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
            # the law, several contacts at a time where the machine can
            for c in range(-(-found // LANES) * LANES):
                dx = b[X_I + c] - b[X_J + c]
                dy = b[Y_I + c] - b[Y_J + c]
                dz = b[Z_I + c] - b[Z_J + c]
                if wrap == 1:
                    dx -= real[LENGTH + X] * np.rint(dx * real[INVERSE + X])
                    dy -= real[LENGTH + Y] * np.rint(dy * real[INVERSE + Y])
                    dz -= real[LENGTH + Z] * np.rint(dz * real[INVERSE + Z])
                r = sqrt(dx * dx + dy * dy + dz * dz)
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
                own = material_of(b, MATERIAL, c)
                contact = Contact(
                    overlap, area, ri * rj / both, meff, inertia,
                    dx * inv, dy * inv, dz * inv, dx, dy, dz,
                    b[VX_I + c] - b[VX_J + c], b[VY_I + c] - b[VY_J + c],
                    b[VZ_I + c] - b[VZ_J + c],
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
                b[PULL_X + c] = -did.fx
                b[PULL_Y + c] = -did.fy
                b[PULL_Z + c] = -did.fz
                b[TWIST_JX + c] = -cj * did.tx + did.rx
                b[TWIST_JY + c] = -cj * did.ty + did.ry
                b[TWIST_JZ + c] = -cj * did.tz + did.rz
                store_memory(b, SHIFT_X, c, kept)
            for first in range(0, found, FOUR):
                collect(b, PUSH_X, BLOCK, first, lines, ON_I)
                collect(b, TWIST_IY, BLOCK, first, lines, BOTH)
                collect(b, PULL_X, BLOCK, first, lines, ON_J)
                if wide == WITH_ROLLING:
                    collect(b, SHIFT_X, BLOCK, first, lines, KEPT)
                    collect(b, SHIFT_Z, BLOCK, first, lines, KEPT_LATE)
                at = 0
                for c in range(first, min(first + FOUR, found)):
                    p = left[c]
                    q = right[c]
                    h = entry[c]
                    touch[h] = 1
                    add_four(force, p, FX, lines, ON_I + at)
                    add_two(force, p, TY, lines, BOTH + at)
                    target = force
                    if apart == 1 and np.int64(q) >= hi:
                        target = spill
                        far = max(far, np.int64(q) + 1)
                    add_four(target, q, FX, lines, ON_J + at)
                    add_two(target, q, TY, lines, BOTH + at + 2)
                    if wide == WITH_ROLLING:
                        put_four(hist, h, SX, lines, KEPT + at)
                        put_four(hist, h, SZ, lines, KEPT_LATE + at)
                    else:
                        hist[h, SX] = b[SHIFT_X + c]
                        hist[h, SY] = b[SHIFT_Y + c]
                        hist[h, SZ] = b[SHIFT_Z + c]
                    at += FOUR
            for c in range(found, np.int64(m)):
                left[c - found] = left[c]
                right[c - found] = right[c]
                entry[c - found] = entry[c]
            m -= np.uint64(found)
        if fill:
            count = np.int64(top) - start[lo]
            pairs.found[lo] = count if count <= WORTH * (last - start[lo]) else -1
        if apart == 1:
            spill[HEAD, REACHED] = far

    made: Callable[..., None] = pair_forces
    return made
