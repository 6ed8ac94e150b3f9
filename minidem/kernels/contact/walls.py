"""Forces of walls on particles: primitive planes and cylinders, and triangle meshes.

As for pairs, contacts are collected in blocks and the law runs over a block. That serves walls of
the same model as the pair style, the usual case; contacts with others are worked on one by one.
The order of additions is that of the list in any case.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from minidem.kernels.contact.law import contact_law, wall_area
from minidem.kernels.contact.triangle import closest
from minidem.kernels.contact.wall_contact import (
    EARLIER,
    HANDLED,
    WIDE,
    inherit,
    lone,
    primitive,
    push,
)
from minidem.kernels.machine.jit import columns, indices, inner, vector

__all__ = ["wall_forces_for"]

BLOCK = 32
"""Contacts worked on together."""

NUMBERS = 29 * BLOCK
USUAL = 16  # column of the tables that is 1 for walls with the model of this loop
FIELDS = 10
NONE = np.uint64(2**63)
TWO, THREE, FOUR, FIVE, SIX = (np.uint64(k * BLOCK) for k in range(2, 7))
ONE = np.uint64(BLOCK)


@cache
def wall_forces_for(switches: tuple[int, ...]) -> Callable[..., None]:
    """Return the wall loop for the nine model switches that walls usually have.

    Parameters
    ----------
    switches : tuple of int
        The first nine of `minidem.kernels.contact.law.SWITCHES`.

    Returns
    -------
    callable
        ``wall_forces(first, last, parts, walls, mesh, load, coef, types, update, dt)`` for
        kernels: adds the forces of all walls to the particles ``first`` to ``last``, keeps the
        wall histories, and fills ``load`` with the forces on meshes.
    """
    m0, m1, m2, m3, m4, m5, m6, m7, m8 = switches
    wide = 6 if m2 >= 2 else 3

    @inner
    def wall_forces(
        first: int, last: int, parts: Any, walls: Any, mesh: Any, load: Any, coef: Any,
        types: int, update: int, dt: float,
    ) -> None:  # fmt: skip
        row = columns(parts.row, 8)
        spin = columns(parts.spin, 4)
        force = columns(parts.force, 8)
        kind = parts.kind
        mask = parts.mask
        hist = columns(walls.hist, WIDE)
        touch = walls.touch
        code = walls.code
        start = walls.start
        prim = columns(walls.prim, 17)
        value = columns(walls.value, 8)
        table = columns(walls.mesh, 17)
        curve = walls.curve
        node = mesh.node
        edge = mesh.edge
        length = mesh.length
        normal = mesh.normal
        flags = mesh.flags
        bound = mesh.bound
        vel = mesh.vel
        owner = mesh.owner
        base = mesh.base
        origin = mesh.origin
        who = indices(BLOCK)
        entry = indices(BLOCK)
        mesh_of = indices(BLOCK)
        pick = indices(BLOCK)
        slot = indices(BLOCK)
        b = vector(NUMBERS)
        for c in range(BLOCK):
            slot[c] = NONE
        for c in range(15 * BLOCK, 18 * BLOCK):
            b[c] = 0.0  # stays so in models without stored torques
        for m in range(load.shape[0]):
            for c in range(6):
                load[m, c] = 0.0
        i: Any = first
        k = start[first]
        while i < last:
            # find up to BLOCK contacts
            n: Any = np.uint64(0)
            while i < last and n < ONE:
                stop = start[i + 1]
                x = row[i, 0]
                y = row[i, 1]
                z = row[i, 2]
                radius = row[i, 3]
                while k < stop and n < ONE:
                    w: Any = np.int64(code[k])
                    k += 1
                    if w < 0:
                        at = -1 - w
                        if not mask[i] & prim[at, 3]:
                            continue
                        r, dx, dy, dz, ux, uy, uz = primitive(prim, value, at, x, y, z)
                        if not r <= radius or r == 0.0:
                            if touch[k - 1] != 0:
                                touch[k - 1] = 0
                                for c in range(WIDE):
                                    hist[k - 1, c] = 0.0
                            continue
                        touch[k - 1] = EARLIER
                        usual = prim[at, USUAL]
                        which = prim[at, 2]
                        m = -1
                    else:
                        r, dx, dy, dz, w0, w1, w2, face = closest(
                            node, edge, length, normal, flags, bound, w, x, y, z
                        )
                        if not r <= radius or r == 0.0:
                            continue
                        if touch[k - 1] == 0 and not inherit(
                            hist, touch, code, owner, node, normal, curve, base, k - 1, start[i],
                            stop, face,
                        ):  # fmt: skip
                            continue
                        touch[k - 1] = EARLIER | HANDLED
                        m = owner[w]
                        ux = 0.0
                        uy = 0.0
                        uz = 0.0
                        if table[m, 4] == 1:
                            ux = w0 * vel[w, 0, 0] + w1 * vel[w, 1, 0] + w2 * vel[w, 2, 0]
                            uy = w0 * vel[w, 0, 1] + w1 * vel[w, 1, 1] + w2 * vel[w, 2, 1]
                            uz = w0 * vel[w, 0, 2] + w1 * vel[w, 1, 2] + w2 * vel[w, 2, 2]
                        usual = table[m, USUAL]
                        which = table[m, 2]
                        at = m
                    if usual == 1:
                        who[n] = np.uint64(i)
                        entry[n] = np.uint64(k - 1)
                        mesh_of[n] = NONE if m < 0 else np.uint64(m)
                        pick[n] = np.uint64(kind[i] * types + which)
                        b[n] = dx
                        b[ONE + n] = dy
                        b[TWO + n] = dz
                        b[THREE + n] = r
                        b[FOUR + n] = ux
                        b[FIVE + n] = uy
                        b[SIX + n] = uz
                        n += np.uint64(1)
                        continue
                    if n > np.uint64(0):
                        k -= 1  # come back to it when those before are done
                        break
                    if m < 0:
                        lone(i, k - 1, prim, at, r, dx, dy, dz, ux, uy, uz, parts, hist, coef,
                             types, update, dt)  # fmt: skip
                    else:
                        fx, fy, fz = lone(
                            i, k - 1, table, at, r, dx, dy, dz, ux, uy, uz, parts, hist, coef,
                            types, update, dt,
                        )  # fmt: skip
                        push(m, origin, load, x - dx, y - dy, z - dz, fx, fy, fz)
                if k < stop:
                    break
                for at in range(start[i], stop):
                    if code[at] < 0:
                        continue
                    if touch[at] & HANDLED:
                        touch[at] = EARLIER
                    elif touch[at] != 0:
                        touch[at] = 0
                        for c in range(WIDE):
                            hist[at, c] = 0.0
                i += 1
            # gather what the law needs, field after field
            found = np.int64(n)
            for c in range(found):
                p = who[c]
                h = entry[c]
                b[4 * BLOCK + c] = row[p, 4] - b[4 * BLOCK + c]
                b[5 * BLOCK + c] = row[p, 5] - b[5 * BLOCK + c]
                b[6 * BLOCK + c] = row[p, 6] - b[6 * BLOCK + c]
                b[7 * BLOCK + c] = row[p, 3]
                b[8 * BLOCK + c] = row[p, 7]
                b[9 * BLOCK + c] = spin[p, 0]
                b[10 * BLOCK + c] = spin[p, 1]
                b[11 * BLOCK + c] = spin[p, 2]
                b[12 * BLOCK + c] = hist[h, 0]
                b[13 * BLOCK + c] = hist[h, 1]
                b[14 * BLOCK + c] = hist[h, 2]
                if wide == 6:
                    b[15 * BLOCK + c] = hist[h, 3]
                    b[16 * BLOCK + c] = hist[h, 4]
                    b[17 * BLOCK + c] = hist[h, 5]
                if pick[c] != slot[c]:
                    slot[c] = pick[c]
                    for f in range(FIELDS):
                        b[(19 + f) * BLOCK + c] = coef[pick[c], f]
            for c in range(found):
                dx = b[c]
                dy = b[BLOCK + c]
                dz = b[2 * BLOCK + c]
                r = b[3 * BLOCK + c]
                radius = b[7 * BLOCK + c]
                mass = b[8 * BLOCK + c]
                overlap = radius - r
                inv = 1.0 / r
                area = 0.0
                if m3 != 0:
                    area = wall_area(m3, r, radius, overlap)
                arm = radius - 0.5 * overlap
                wx = arm * b[9 * BLOCK + c] * inv
                wy = arm * b[10 * BLOCK + c] * inv
                wz = arm * b[11 * BLOCK + c] * inv
                (fx, fy, fz, tx, ty, tz, rx, ry, rz, h0, h1, h2, h3, h4, h5) = contact_law(
                    m0, m1, m2, m3, m4, m5, m6, m7, m8,
                    b[19 * BLOCK + c], b[20 * BLOCK + c], b[21 * BLOCK + c],
                    b[23 * BLOCK + c], b[24 * BLOCK + c], b[25 * BLOCK + c],
                    b[26 * BLOCK + c], b[27 * BLOCK + c], b[28 * BLOCK + c],
                    update, dt, overlap, area, radius, mass, 1.4 * mass * radius * radius,
                    dx * inv, dy * inv, dz * inv, dx, dy, dz,
                    b[4 * BLOCK + c], b[5 * BLOCK + c], b[6 * BLOCK + c], wx, wy, wz, wx, wy, wz,
                    b[12 * BLOCK + c], b[13 * BLOCK + c], b[14 * BLOCK + c],
                    b[15 * BLOCK + c], b[16 * BLOCK + c], b[17 * BLOCK + c],
                )  # fmt: skip
                b[4 * BLOCK + c] = fx
                b[5 * BLOCK + c] = fy
                b[6 * BLOCK + c] = fz
                b[9 * BLOCK + c] = -arm * tx - rx
                b[10 * BLOCK + c] = -arm * ty - ry
                b[11 * BLOCK + c] = -arm * tz - rz
                b[12 * BLOCK + c] = h0
                b[13 * BLOCK + c] = h1
                b[14 * BLOCK + c] = h2
                b[15 * BLOCK + c] = h3
                b[16 * BLOCK + c] = h4
                b[17 * BLOCK + c] = h5
            for c in range(found):
                p = who[c]
                h = entry[c]
                force[p, 0] += b[4 * BLOCK + c]
                force[p, 1] += b[5 * BLOCK + c]
                force[p, 2] += b[6 * BLOCK + c]
                force[p, 3] += b[9 * BLOCK + c]
                force[p, 4] += b[10 * BLOCK + c]
                force[p, 5] += b[11 * BLOCK + c]
                hist[h, 0] = b[12 * BLOCK + c]
                hist[h, 1] = b[13 * BLOCK + c]
                hist[h, 2] = b[14 * BLOCK + c]
                if wide == 6:
                    hist[h, 3] = b[15 * BLOCK + c]
                    hist[h, 4] = b[16 * BLOCK + c]
                    hist[h, 5] = b[17 * BLOCK + c]
                if mesh_of[c] != NONE:
                    push(
                        int(mesh_of[c]), origin, load, row[p, 0] - b[c],
                        row[p, 1] - b[BLOCK + c], row[p, 2] - b[2 * BLOCK + c],
                        b[4 * BLOCK + c], b[5 * BLOCK + c], b[6 * BLOCK + c],
                    )  # fmt: skip

    made: Callable[..., None] = wall_forces
    return made
