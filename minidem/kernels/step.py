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

from minidem.kernels.flow import count_through
from minidem.kernels.jit import kernel
from minidem.kernels.law import contact_law, pair_area
from minidem.kernels.motion import move_meshes, nodes_moved
from minidem.kernels.post import apply_posts, fly, kick, second
from minidem.kernels.walls import wall_forces

__all__ = ["DONE", "DRAIN", "OUTSIDE", "REALS", "REBUILD", "WHOLES", "advance_for"]

WHOLES = (
    "step", "stop", "middle", "entry", "code", "ago", "delay", "every", "check", "clear",
    "n", "nve", "renew", "airborne", "frozen", "types", "motions", "flows", "posts", "spare",
    "outside",
)  # fmt: skip
"""Meaning of ``Control.whole``.

stop: step at which to return; middle: step at which to return for an insertion; entry: where to
go on; code: why it returned; ago, delay, every, check: of the neighbour list; clear: 1 if pair
history is cleared at separation; nve, frozen: group bits; renew: step at which a moving mesh wants
new lists; airborne: last step with particles in flight; outside: posts that need Python first.
"""

REALS = ("dt", "trigger2", "reach2", "lx", "ly", "lz", "ix", "iy", "iz", "moved2")
"""Meaning of ``Control.real``.

trigger2: squared move that asks for new lists; reach2: squared ``contact_distance_factor``;
lx .. lz: periods, ix .. iz: their inverses or 0; moved2: largest squared move found.
"""

START, FORCES, SETUP, POSTS, SETUP_POSTS = 0, 1, 2, 3, 4  # entry
DONE, REBUILD, DRAIN, OUTSIDE = 0, 1, 2, 3  # code


@cache
def advance_for(switches: tuple[int, ...], *, periodic: bool) -> Callable[..., None]:
    """Return the run loop compiled for nine model switches.

    Parameters
    ----------
    switches : tuple of int
        See `minidem.kernels.law.SWITCHES`.
    periodic : bool
        True if a direction of the box is periodic.

    Returns
    -------
    callable
        ``advance(control, parts, pairs, walls, mesh, motions, flows, posts, coef)``; it works in
        place and returns when ``stop`` or ``middle`` is reached, new lists are needed, the event
        buffer is half full, or a post needs Python.
    """
    m0, m1, m2, m3, m4, m5, m6, m7, m8 = switches
    wide = 6 if m2 >= 2 else 3
    wrap = 1 if periodic else 0

    @kernel
    def advance(  # noqa: PLR0915 - one fused loop, see the module text
        control: Any, parts: Any, pairs: Any, walls: Any, mesh: Any, motions: Any, flows: Any,
        posts: Any, coef: Any,
    ) -> None:  # fmt: skip
        whole = control.whole
        real = control.real
        row = parts.row
        spin = parts.spin
        force = parts.force
        kind = parts.kind
        hist = pairs.hist
        n = whole[10]
        nve = whole[11]
        types = whole[15]
        dt = real[0]
        reach2 = real[2]
        while True:
            entry = whole[3]
            if entry == 0:
                if whole[0] >= whole[1]:
                    whole[4] = 0
                    return
                whole[0] += 1
                moved2 = kick(n, parts, nve, dt)
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
                    return
                if whole[16] > 0 and nodes_moved(mesh, motions, whole[16], real[1]):
                    whole[12] = whole[0] + 1
            update = 0 if entry == 2 or entry == 4 else 1
            if entry != 3 and entry != 4:
                for i in range(n):
                    for c in range(6):
                        force[i, c] = 0.0
                for i in range(n):
                    lo = np.uint64(pairs.start[i])
                    hi = np.uint64(pairs.start[i + 1])
                    if lo == hi:
                        continue
                    x = row[i, 0]
                    y = row[i, 1]
                    z = row[i, 2]
                    ri = row[i, 3]
                    f0 = 0.0
                    f1 = 0.0
                    f2 = 0.0
                    t0 = 0.0
                    t1 = 0.0
                    t2 = 0.0
                    for k in range(lo, hi):
                        j = pairs.other[k]
                        dx = x - row[j, 0]
                        dy = y - row[j, 1]
                        dz = z - row[j, 2]
                        if wrap == 1:
                            dx -= real[3] * np.rint(dx * real[6])
                            dy -= real[4] * np.rint(dy * real[7])
                            dz -= real[5] * np.rint(dz * real[8])
                        rj = row[j, 3]
                        both = ri + rj
                        square = dx * dx + dy * dy + dz * dz
                        if square < both * both:
                            pairs.touch[k] = 1
                            r = sqrt(square)
                            inv = 1.0 / r
                            nx = dx * inv
                            ny = dy * inv
                            nz = dz * inv
                            overlap = both - r
                            mi = row[i, 7]
                            mj = row[j, 7]
                            reff = ri * rj / both
                            meff = mi * mj / (mi + mj)
                            if whole[14] != 0:
                                if parts.mask[i] & whole[14]:
                                    meff = mj
                                if parts.mask[j] & whole[14]:
                                    meff = mi
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
                            wi0 = spin[i, 0]
                            wi1 = spin[i, 1]
                            wi2 = spin[i, 2]
                            wj0 = spin[j, 0]
                            wj1 = spin[j, 1]
                            wj2 = spin[j, 2]
                            h3 = 0.0
                            h4 = 0.0
                            h5 = 0.0
                            if wide == 6:
                                h3 = hist[k, 3]
                                h4 = hist[k, 4]
                                h5 = hist[k, 5]
                            (a0, a1, a2, b0, b1, b2, c0, c1, c2,
                             h0, h1, h2, h3, h4, h5) = contact_law(
                                m0, m1, m2, m3, m4, m5, m6, m7, m8,
                                coef, kind[i] * types + kind[j], update, dt, overlap, area,
                                reff, meff, inertia, nx, ny, nz, dx, dy, dz,
                                row[i, 4] - row[j, 4], row[i, 5] - row[j, 5],
                                row[i, 6] - row[j, 6],
                                (ci * wi0 + cj * wj0) * inv, (ci * wi1 + cj * wj1) * inv,
                                (ci * wi2 + cj * wj2) * inv,
                                wi0 - wj0, wi1 - wj1, wi2 - wj2,
                                hist[k, 0], hist[k, 1], hist[k, 2], h3, h4, h5,
                            )  # fmt: skip
                            hist[k, 0] = h0
                            hist[k, 1] = h1
                            hist[k, 2] = h2
                            if wide == 6:
                                hist[k, 3] = h3
                                hist[k, 4] = h4
                                hist[k, 5] = h5
                            f0 += a0
                            f1 += a1
                            f2 += a2
                            t0 -= ci * b0 + c0
                            t1 -= ci * b1 + c1
                            t2 -= ci * b2 + c2
                            force[j, 0] -= a0
                            force[j, 1] -= a1
                            force[j, 2] -= a2
                            force[j, 3] -= cj * b0 - c0
                            force[j, 4] -= cj * b1 - c1
                            force[j, 5] -= cj * b2 - c2
                        elif (
                            whole[9] == 1
                            and pairs.touch[k] != 0
                            and square < reach2 * both * both
                        ):
                            pairs.touch[k] = 0
                            for c in range(wide):
                                hist[k, c] = 0.0
                    force[i, 0] += f0
                    force[i, 1] += f1
                    force[i, 2] += f2
                    force[i, 3] += t0
                    force[i, 4] += t1
                    force[i, 5] += t2
                wall_forces(n, parts, walls, mesh, coef, types, update, dt)
                if whole[20] != 0:
                    whole[4] = 3
                    return
            apply_posts(n, parts, posts, whole[18])
            if update == 0:
                # setup: forces only
                whole[3] = 0
                whole[4] = 0
                return
            second(n, parts, nve, dt)
            if whole[13] >= whole[0]:
                fly(n, parts, whole[0], dt)
            whole[3] = 0
            if whole[17] > 0 and 2 * flows.found[0] > flows.event.shape[0]:
                whole[4] = 2
                return

    made: Callable[..., None] = advance
    return made
