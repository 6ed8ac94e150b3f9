"""Many time steps in one call: velocity Verlet in the order of operations of LIGGGHTS.

`advance_for` makes the run loop for one choice of contact models. The choice is a compile-time
constant, so that the pair loop holds only the branches of its model; the machine code of every
choice is kept on disk. Everything that a step needs is in one function because a call from
Python costs as much as a step of some hundred particles.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import sqrt
from typing import Any

import numpy as np

from minidem.kernels.extended import pair_forces_extended
from minidem.kernels.flow import count_through
from minidem.kernels.jit import kernel
from minidem.kernels.law import contact_law, pair_area
from minidem.kernels.motion import move_meshes, nodes_moved
from minidem.kernels.post import apply_posts, fly, kick, lead, second
from minidem.kernels.rebuild import rebuild_inside
from minidem.kernels.walls import wall_forces

__all__ = ["advance_for"]

BLOCK = 32
"""Contacts worked on together; their data then fit into the nearest cache."""

FIELDS = 10
# unsigned, so that the compiler need not provide for negative indices
ONE, TWO, THREE = np.uint64(BLOCK), np.uint64(2 * BLOCK), np.uint64(3 * BLOCK)


@cache
def advance_for(
    switches: tuple[int, ...], *, periodic: bool, extended: bool = False
) -> Callable[..., None]:
    """Return the run loop compiled for nine model switches.

    Parameters
    ----------
    switches : tuple of int
        The first nine of `minidem.kernels.law.SWITCHES`.
    periodic : bool
        True if a direction of the box is periodic.
    extended : bool
        True if the pairs have a law that only minidem has; their switches are then read from
        ``control``, and one loop serves all models.

    Returns
    -------
    callable
        ``advance(control, parts, more, pairs, spare_pairs, walls, spare_walls, mesh, motions,
        flows, posts, coef)``; it works in place and returns when ``stop`` or ``middle`` is
        reached, new lists need Python, the event buffer is half full, or a post needs Python.
    """
    m0, m1, m2, m3, m4, m5, m6, m7, m8 = switches
    wide = 6 if m2 >= 2 else 3
    wrap = 1 if periodic else 0
    extra = 1 if extended else 0

    @kernel
    def advance(
        control: Any, parts: Any, more: Any, pairs_a: Any, pairs_b: Any, walls_a: Any,
        walls_b: Any, mesh: Any, motions: Any, flows: Any, posts: Any, coef: Any,
    ) -> None:  # fmt: skip
        whole = control.whole
        real = control.real
        row = parts.row
        spin = parts.spin
        force = parts.force
        kind = parts.kind
        n = whole[10]
        nve = whole[11]
        types = whole[15]
        dt = real[0]
        reach2 = real[2]
        clear = whole[9] == 1
        frozen = whole[14]
        turned = whole[21]
        pairs = pairs_b if turned == 1 else pairs_a
        walls = walls_b if turned == 1 else walls_a
        start = pairs.start
        other = pairs.other
        touch = pairs.touch
        hist = pairs.hist
        # one more column: a pair that does not touch is written there before it is dropped
        who = np.zeros((BLOCK + 1, 3), np.uint64)
        slot = np.full(BLOCK, -1, np.int64)
        b = np.zeros(34 * BLOCK + 1)
        while True:
            entry = whole[3]
            fresh = entry == 1
            must = False
            if entry == 0:
                if whole[0] >= whole[1]:
                    whole[4] = 0
                    return
                whole[0] += 1
                moved2 = kick(n, parts, posts, whole[19], nve, dt)
                real[9] = moved2
                if whole[16] > 0:
                    move_meshes(mesh, motions, whole[16], whole[0], dt)
                if whole[17] > 0:
                    count_through(parts, mesh, flows, whole[17], whole[0])
                must = whole[0] == whole[2] or whole[0] == whole[12]
                if not must:
                    whole[5] += 1
                    if whole[5] >= whole[6] and whole[5] % whole[7] == 0:
                        must = whole[8] == 0 or not moved2 <= real[1]
                if must:
                    whole[3] = 1
                    whole[4] = 1
                    if whole[0] == whole[2] or not moved2 <= real[10] * real[10]:
                        return
                    if whole[17] > 0 and flows.found[0] > 0:
                        return
                elif whole[16] > 0 and nodes_moved(mesh, motions, whole[16], real[1]):
                    whole[12] = whole[0] + 1
            if must or entry >= 5:
                spare_pairs = pairs_a if turned == 1 else pairs_b
                spare_walls = walls_a if turned == 1 else walls_b
                state = rebuild_inside(
                    0 if must else entry - 4, n, n if must else whole[24], dt, real[10], real[11],
                    parts, more, pairs, spare_pairs, walls, spare_walls, mesh,
                    1 if whole[16] > 0 else 0, flows, 1 if whole[13] >= whole[0] else 0,
                )  # fmt: skip
                whole[22] = state
                if state == 0:
                    whole[5] = 0
                    whole[23] += 1
                    turned = 1 - turned
                    whole[21] = turned
                if state != 0 or entry >= 5:
                    return
                pairs = spare_pairs
                walls = spare_walls
                start = pairs.start
                other = pairs.other
                touch = pairs.touch
                hist = pairs.hist
                fresh = True
            if whole[0] == whole[26] and entry == 0:
                whole[3] = 1
                whole[4] = 4
                return
            update = 0 if entry == 2 or entry == 4 or entry == -2 else 1
            if entry != 3 and entry != 4:
                if entry == 2 or fresh:
                    lead(n, parts, posts, whole[19])
                i = 0
                k = 0
                last = start[n] if entry >= 0 else 0
                if extra == 1 and entry >= 0:
                    pair_forces_extended(n, parts, pairs, whole, real, coef, update)
                    last = 0
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
                            who[m, 0] = i
                            who[m, 1] = j
                            who[m, 2] = kk
                            b[m] = dx
                            b[ONE + m] = dy
                            b[TWO + m] = dz
                            b[THREE + m] = square
                            m += np.uint64(hit)
                            if (
                                touch[kk] > np.uint8(hit)
                                and clear
                                and square < reach2 * both * both
                            ):
                                touch[kk] = 0
                                for c in range(wide):
                                    hist[kk, c] = 0.0
                        k = stop
                    # gather what the law needs, field after field
                    found = np.int64(m)
                    for c in range(found):
                        p = who[c, 0]
                        q = who[c, 1]
                        h = who[c, 2]
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
                        pick = kind[p] * types + kind[q]
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
                        p = who[c, 0]
                        q = who[c, 1]
                        h = who[c, 2]
                        touch[h] = 1
                        force[p, 0] += b[c]
                        force[p, 1] += b[BLOCK + c]
                        force[p, 2] += b[2 * BLOCK + c]
                        force[p, 3] += b[3 * BLOCK + c]
                        force[p, 4] += b[4 * BLOCK + c]
                        force[p, 5] += b[5 * BLOCK + c]
                        force[q, 0] -= b[c]
                        force[q, 1] -= b[BLOCK + c]
                        force[q, 2] -= b[2 * BLOCK + c]
                        force[q, 3] += b[6 * BLOCK + c]
                        force[q, 4] += b[7 * BLOCK + c]
                        force[q, 5] += b[8 * BLOCK + c]
                        hist[h, 0] = b[17 * BLOCK + c]
                        hist[h, 1] = b[18 * BLOCK + c]
                        hist[h, 2] = b[19 * BLOCK + c]
                        if wide == 6:
                            hist[h, 3] = b[20 * BLOCK + c]
                            hist[h, 4] = b[21 * BLOCK + c]
                            hist[h, 5] = b[22 * BLOCK + c]
                if whole[25] > whole[19] and entry >= 0:
                    if whole[20] != 0:
                        whole[3] = -2 if update == 0 else -1
                        whole[4] = 3
                        return
                    apply_posts(n, parts, posts, whole[19], whole[25])
                wall_forces(n, parts, walls, mesh, coef, types, update, dt)
                if whole[20] != 0:
                    whole[3] = 4 if update == 0 else 3
                    whole[4] = 3
                    return
            if update == 0:
                # setup: forces only
                apply_posts(n, parts, posts, whole[25], whole[18])
                whole[3] = 0
                whole[4] = 0
                return
            if whole[18] > whole[25]:
                apply_posts(n, parts, posts, whole[25], whole[18])
            second(n, parts, nve)
            if whole[13] >= whole[0]:
                fly(n, parts, whole[0], dt)
            whole[3] = 0
            if whole[17] > 0 and 2 * flows.found[0] > flows.event.shape[0]:
                whole[4] = 2
                return

    made: Callable[..., None] = advance
    return made
