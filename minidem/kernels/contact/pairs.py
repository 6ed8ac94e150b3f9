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

from minidem.kernels.contact.law import contact_law, pair_area
from minidem.kernels.machine.jit import columns, fetch, indices, inner, vector

__all__ = ["pair_forces_for"]

BLOCK = 32
"""Contacts worked on together; their data then fit into the nearest cache."""

PLACES = BLOCK + 1  # a pair that does not touch is written to the last before it is dropped
NUMBERS = 34 * BLOCK + 1
FIELDS = 10
FRESH = np.uint64(2**63)
# unsigned, so that the compiler need not provide for negative indices
ONE, TWO, THREE = np.uint64(BLOCK), np.uint64(2 * BLOCK), np.uint64(3 * BLOCK)


@cache
def pair_forces_for(
    switches: tuple[int, ...], *, periodic: bool, shared: bool
) -> Callable[..., None]:
    """Return the pair loop for nine model switches.

    Parameters
    ----------
    switches : tuple of int
        See `minidem.kernels.contact.law.SWITCHES`.
    periodic : bool
        True if a direction of the box is periodic.
    shared : bool
        True if other threads work on other rows: then what is done to rows from ``hi`` on goes
        to ``overflow``, and ``overflow[0, 6]`` says up to which row.

    Returns
    -------
    callable
        ``pair_forces(lo, hi, parts, pairs, coef, whole, real, update, overflow)`` for kernels: adds
        the forces of the pairs that rows ``lo`` to ``hi`` own.
    """
    m0, m1, m2, m3, m4, m5, m6, m7, m8 = switches
    wide = 6 if m2 >= 2 else 3
    wrap = 1 if periodic else 0
    apart = 1 if shared else 0

    @inner
    def pair_forces(
        lo: int, hi: int, parts: Any, pairs: Any, coef: Any, whole: Any, real: Any, update: int,
        overflow: Any,
    ) -> None:  # fmt: skip
        row = columns(parts.row, 8)
        spin = columns(parts.spin, 4)
        force = columns(parts.force, 8)
        kind = parts.kind
        types = whole[15]
        dt = real[0]
        reach2 = real[2]
        clear = whole[9] == 1
        frozen = whole[14]
        start = pairs.start
        other = pairs.other
        touch = pairs.touch
        hist = columns(pairs.hist, wide)
        spill = columns(overflow, 8)
        left = indices(PLACES)
        right = indices(PLACES)
        entry = indices(PLACES)
        slot = indices(BLOCK)
        for c in range(BLOCK):
            slot[c] = FRESH
        b = vector(NUMBERS)
        for c in range(20 * BLOCK, 24 * BLOCK):
            b[c] = 0.0  # stays so without stored torques, without frozen particles
        far: Any = hi
        i = lo
        k = start[lo]
        last = start[hi]
        while k < last:
            # find up to BLOCK touching pairs
            m = np.uint64(0)
            while k < last and m < ONE:
                while k >= start[i + 1]:
                    i += 1
                x = row[i, 0]
                y = row[i, 1]
                z = row[i, 2]
                ri = row[i, 3]
                stop = min(start[i + 1], k + BLOCK - np.int64(m))
                for kk in range(np.uint64(k), np.uint64(stop)):
                    j = other[kk]
                    dx = x - row[j, 0]
                    dy = y - row[j, 1]
                    dz = z - row[j, 2]
                    if wrap == 1:
                        dx -= real[3] * np.rint(dx * real[6])
                        dy -= real[4] * np.rint(dy * real[7])
                        dz -= real[5] * np.rint(dz * real[8])
                    both = ri + row[j, 3]
                    square = dx * dx + dy * dy + dz * dz
                    hit = square < both * both
                    left[m] = i
                    right[m] = j
                    entry[m] = kk
                    b[m] = dx
                    b[ONE + m] = dy
                    b[TWO + m] = dz
                    b[THREE + m] = square
                    m += np.uint64(hit)
                    fetch(spin, j)
                    fetch(force, j)
                    if touch[kk] > np.uint8(hit) and clear and square < reach2 * both * both:
                        touch[kk] = 0
                        for c in range(wide):
                            hist[kk, c] = 0.0
                k = stop
            # gather what the law needs, field after field
            found = np.int64(m)
            for c in range(found):
                p = left[c]
                q = right[c]
                h = entry[c]
                b[4 * BLOCK + c] = row[p, 3]
                b[5 * BLOCK + c] = row[q, 3]
                b[6 * BLOCK + c] = row[p, 7]
                b[7 * BLOCK + c] = row[q, 7]
                b[8 * BLOCK + c] = row[p, 4] - row[q, 4]
                b[9 * BLOCK + c] = row[p, 5] - row[q, 5]
                b[10 * BLOCK + c] = row[p, 6] - row[q, 6]
                b[11 * BLOCK + c] = spin[p, 0]
                b[12 * BLOCK + c] = spin[p, 1]
                b[13 * BLOCK + c] = spin[p, 2]
                b[14 * BLOCK + c] = spin[q, 0]
                b[15 * BLOCK + c] = spin[q, 1]
                b[16 * BLOCK + c] = spin[q, 2]
                b[17 * BLOCK + c] = hist[h, 0]
                b[18 * BLOCK + c] = hist[h, 1]
                b[19 * BLOCK + c] = hist[h, 2]
                if wide == 6:
                    b[20 * BLOCK + c] = hist[h, 3]
                    b[21 * BLOCK + c] = hist[h, 4]
                    b[22 * BLOCK + c] = hist[h, 5]
                if frozen != 0:
                    b[23 * BLOCK + c] = 0.0
                    if parts.mask[p] & frozen:
                        b[23 * BLOCK + c] = row[q, 7]
                    if parts.mask[q] & frozen:
                        b[23 * BLOCK + c] = row[p, 7]
                pick = np.uint64(kind[p] * types + kind[q])
                if pick != slot[c]:
                    slot[c] = pick
                    for f in range(FIELDS):
                        b[(24 + f) * BLOCK + c] = coef[pick, f]
            # the law, four contacts at a time where the machine can
            for c in range(found):
                r = sqrt(b[3 * BLOCK + c])
                inv = 1.0 / r
                ri = b[4 * BLOCK + c]
                rj = b[5 * BLOCK + c]
                mi = b[6 * BLOCK + c]
                mj = b[7 * BLOCK + c]
                both = ri + rj
                overlap = both - r
                meff = mi * mj / (mi + mj)
                if b[23 * BLOCK + c] > 0.0:
                    meff = b[23 * BLOCK + c]
                area = 0.0
                if m3 != 0:
                    area = pair_area(m3, r, ri, rj, overlap)
                inertia = 0.0
                if m2 == 2:
                    ii = mi * ri * ri
                    ij = mj * rj * rj
                    inertia = 1.4 * (ii * ij / (ii + ij))
                ci = ri - 0.5 * overlap
                cj = rj - 0.5 * overlap
                wi0 = b[11 * BLOCK + c]
                wi1 = b[12 * BLOCK + c]
                wi2 = b[13 * BLOCK + c]
                wj0 = b[14 * BLOCK + c]
                wj1 = b[15 * BLOCK + c]
                wj2 = b[16 * BLOCK + c]
                dx = b[c]
                dy = b[BLOCK + c]
                dz = b[2 * BLOCK + c]
                (a0, a1, a2, b0, b1, b2, c0, c1, c2,
                 h0, h1, h2, h3, h4, h5) = contact_law(
                    m0, m1, m2, m3, m4, m5, m6, m7, m8,
                    b[24 * BLOCK + c], b[25 * BLOCK + c], b[26 * BLOCK + c],
                    b[28 * BLOCK + c], b[29 * BLOCK + c], b[30 * BLOCK + c],
                    b[31 * BLOCK + c], b[32 * BLOCK + c], b[33 * BLOCK + c],
                    update, dt, overlap, area, ri * rj / both, meff, inertia,
                    dx * inv, dy * inv, dz * inv, dx, dy, dz,
                    b[8 * BLOCK + c], b[9 * BLOCK + c], b[10 * BLOCK + c],
                    (ci * wi0 + cj * wj0) * inv, (ci * wi1 + cj * wj1) * inv,
                    (ci * wi2 + cj * wj2) * inv, wi0 - wj0, wi1 - wj1, wi2 - wj2,
                    b[17 * BLOCK + c], b[18 * BLOCK + c], b[19 * BLOCK + c],
                    b[20 * BLOCK + c], b[21 * BLOCK + c], b[22 * BLOCK + c],
                )  # fmt: skip
                b[c] = a0
                b[BLOCK + c] = a1
                b[2 * BLOCK + c] = a2
                b[3 * BLOCK + c] = -ci * b0 - c0
                b[4 * BLOCK + c] = -ci * b1 - c1
                b[5 * BLOCK + c] = -ci * b2 - c2
                b[6 * BLOCK + c] = -cj * b0 + c0
                b[7 * BLOCK + c] = -cj * b1 + c1
                b[8 * BLOCK + c] = -cj * b2 + c2
                b[17 * BLOCK + c] = h0
                b[18 * BLOCK + c] = h1
                b[19 * BLOCK + c] = h2
                b[20 * BLOCK + c] = h3
                b[21 * BLOCK + c] = h4
                b[22 * BLOCK + c] = h5
            for c in range(found):
                p = left[c]
                q = right[c]
                h = entry[c]
                touch[h] = 1
                force[p, 0] += b[c]
                force[p, 1] += b[BLOCK + c]
                force[p, 2] += b[2 * BLOCK + c]
                force[p, 3] += b[3 * BLOCK + c]
                force[p, 4] += b[4 * BLOCK + c]
                force[p, 5] += b[5 * BLOCK + c]
                target = force
                if apart == 1 and np.int64(q) >= hi:
                    target = spill
                    far = max(far, np.int64(q) + 1)
                target[q, 0] -= b[c]
                target[q, 1] -= b[BLOCK + c]
                target[q, 2] -= b[2 * BLOCK + c]
                target[q, 3] += b[6 * BLOCK + c]
                target[q, 4] += b[7 * BLOCK + c]
                target[q, 5] += b[8 * BLOCK + c]
                hist[h, 0] = b[17 * BLOCK + c]
                hist[h, 1] = b[18 * BLOCK + c]
                hist[h, 2] = b[19 * BLOCK + c]
                if wide == 6:
                    hist[h, 3] = b[20 * BLOCK + c]
                    hist[h, 4] = b[21 * BLOCK + c]
                    hist[h, 5] = b[22 * BLOCK + c]
        if apart == 1:
            spill[0, 6] = far

    made: Callable[..., None] = pair_forces
    return made
