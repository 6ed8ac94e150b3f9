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

from minidem.kernels.columns import (  # isort: skip
    X, Y, Z, RADIUS, VX, ROW, WX, SPIN, FX, TY, FORCE, SX, SZ, SLIDING_ONLY, WITH_ROLLING,
    REMEMBERED, WALL_TYPE, WALL_GROUP, WALL_USUAL, WALL, MESH_MOVES, MESH_FACETS, EARLIER, HANDLED,
    TYPES, DT, REACH, TRAVEL, NEARBY,
)  # fmt: skip
from minidem.kernels.contact.wall_block import (  # isort: skip
    LEVER_X, LEVER_Y, LEVER_Z, DISTANCE, SPEED_X, SPEED_Y, SPEED_Z, PLACE_I, RADIUS_I, VX_I, VY_I,
    VZ_I, MASS_I, SPIN_IX, SPIN_IY, SPIN_IZ, SHIFT_X, SHIFT_Z, MATERIAL, NUMBERS, PUSH_X,
    PUSH_Y, PUSH_Z, TWIST_X, TWIST_Y, TWIST_Z, PUSHED, TWISTED, KEPT, KEPT_LATE, LINES,
)  # fmt: skip
from minidem.kernels.machine.space import (  # isort: skip
    add_four, add_two, collect, columns, indices, put_four, spread, vector,
)  # fmt: skip
from minidem.kernels.contact.block import BLOCK, FOUR, LANES, material_of, memory_of, store_memory
from minidem.kernels.contact.law import contact_law, wall_area
from minidem.kernels.contact.mesh_loads import NO_MESH, load_meshes, mark, push
from minidem.kernels.contact.records import Contact, Switches
from minidem.kernels.contact.triangle import FAR, closest, unchanged
from minidem.kernels.contact.wall_contact import gap_to, inherit, lone, primitive
from minidem.kernels.machine.jit import inner
from minidem.kernels.models import BASIC

__all__ = ["wall_forces_for"]

NONE = np.uint64(2**63)
FULL = np.uint64(BLOCK)
SURE = 0.99  # part of a distance that is not touched before so much has been travelled
ONE = np.uint64(1)
# the fields that the scan of the list fills; unsigned, so that the compiler need not provide for
# negative indices
NEW_LEVER_Y, NEW_LEVER_Z, NEW_DISTANCE, NEW_SPEED_X, NEW_SPEED_Y, NEW_SPEED_Z = (
    np.uint64(field) for field in (LEVER_Y, LEVER_Z, DISTANCE, SPEED_X, SPEED_Y, SPEED_Z)
)


@cache
def wall_forces_for(switches: tuple[int, ...], *, general: bool = False) -> Callable[..., None]:
    """Return the wall loop for the nine model switches that walls usually have.

    Parameters
    ----------
    switches : tuple of int
        The first nine of `minidem.kernels.contact.records.Switches`.
    general : bool
        True for a loop that reads the switches of every wall from its table.

    Returns
    -------
    callable
        ``wall_forces(first, last, bodies, walls, mesh, update, load)`` for kernels: adds the
        forces of all walls to the particles ``first`` to ``last``, keeps the wall histories, and
        fills ``load`` with the forces on meshes.
    """
    model = Switches(*switches)
    wide = WITH_ROLLING if model.rolling >= 2 else SLIDING_ONLY
    blocks = 0 if general else 1

    @inner
    def wall_forces(
        first: int, last: int, bodies: Any, walls: Any, mesh: Any, update: int, load: Any
    ) -> None:
        parts = bodies.parts
        coef = bodies.coef
        types = bodies.control.whole[TYPES]
        dt = bodies.control.real[DT]
        close = bodies.control.real[REACH] - 1.0
        reach = max(bodies.control.real[REACH], 1.0)
        travel = bodies.control.real[TRAVEL]
        nearby = bodies.control.real[NEARBY]
        row = columns(parts.row, ROW)
        spin = columns(parts.spin, SPIN)
        force = columns(parts.force, FORCE)
        kind = parts.kind
        mask = parts.mask
        hist = columns(walls.hist, REMEMBERED)
        touch = walls.touch
        free = walls.free
        code = walls.code
        start = walls.start
        prim = columns(walls.prim, WALL)
        table = columns(walls.mesh, WALL)
        owner = mesh.owner
        origin = mesh.origin
        who = indices(BLOCK)
        entry = indices(BLOCK)
        mesh_of = indices(BLOCK)
        pick = indices(BLOCK)
        slot = indices(BLOCK)
        b = vector(NUMBERS)
        for c in range(BLOCK):
            slot[c] = NONE
            who[c] = np.uint64(first)
            entry[c] = np.uint64(start[first])
        for c in range(NUMBERS):
            b[c] = 0.0  # stored torques stay so in models without them
        lines = vector(LINES)
        for m in range(load.shape[0]):
            for c in range(6):
                load[m, FX + c] = 0.0
        # rows and entries are unsigned, as above
        i: Any = np.uint64(first)
        end: Any = np.uint64(last)
        k: Any = np.uint64(start[first])
        begin: Any = k
        touched: Any = np.uint8(0)
        while i < end:
            # find up to BLOCK contacts
            n: Any = np.uint64(0)
            while i < end and n < FULL:
                stop: Any = np.uint64(start[i + ONE])
                if begin == stop:
                    i += ONE
                    continue
                x = row[i, X]
                y = row[i, Y]
                z = row[i, Z]
                radius = row[i, RADIUS]
                while k < stop and n < FULL:
                    e: Any = k
                    k += ONE
                    if travel < free[e]:
                        continue
                    # what functions take is signed
                    p: Any = np.int64(i)
                    h: Any = np.int64(e)
                    w: Any = np.int64(code[e])
                    if w < 0:
                        at = -1 - w
                        if not mask[i] & prim[at, WALL_GROUP]:
                            continue
                        gap = primitive(walls, at, x, y, z)
                        if not gap.distance <= radius or gap.distance == 0.0:
                            if blocks == 0 and 0.0 < gap.distance - radius < close * radius:
                                lone(p, h, prim[at], gap, bodies, walls, update)
                            if touch[e] != 0:
                                touch[e] = 0
                                for c in range(REMEMBERED):
                                    hist[e, c] = 0.0
                            free[e] = travel + SURE * (gap.distance - reach * radius)
                            continue
                        touch[e] = EARLIER
                        usual = prim[at, WALL_USUAL]
                        which = prim[at, WALL_TYPE]
                        m = -1
                    else:
                        touched |= touch[e]
                        near = closest(mesh, w, x, y, z)
                        apart = near.distance - radius
                        if not (apart <= 0.0 or apart < close * radius) or near.distance == 0.0:
                            if touch[e] == 0:
                                if near.distance == FAR:  # it belongs to another triangle
                                    way = unchanged(mesh, w, x, y, z, nearby)
                                else:
                                    way = near.distance - reach * radius
                                free[e] = travel + SURE * way
                            continue
                        low: Any = np.int64(begin)
                        high: Any = np.int64(stop)
                        if touch[e] == 0 and not inherit(walls, mesh, h, low, high, near.face):
                            continue
                        touch[e] |= EARLIER | HANDLED
                        touched |= touch[e]
                        at = owner[w]
                        if blocks == 1 and not near.distance <= radius:
                            # close without contact: as in LIGGGHTS it keeps coplanar neighbours out
                            for c in range(REMEMBERED):
                                hist[e, c] = 0.0
                            continue
                        m = at
                        usual = table[at, WALL_USUAL]
                        which = table[at, WALL_TYPE]
                        gap = gap_to(near, mesh, w, table[at, MESH_MOVES])
                    if blocks == 1 and usual == 1:
                        who[n] = i
                        entry[n] = e
                        mesh_of[n] = NO_MESH if m < 0 else np.uint64(m)
                        pick[n] = np.uint64(kind[i] * types + which)
                        b[n] = gap.dx
                        b[NEW_LEVER_Y + n] = gap.dy
                        b[NEW_LEVER_Z + n] = gap.dz
                        b[NEW_DISTANCE + n] = gap.distance
                        b[NEW_SPEED_X + n] = gap.ux
                        b[NEW_SPEED_Y + n] = gap.uy
                        b[NEW_SPEED_Z + n] = gap.uz
                        n += ONE
                        continue
                    if n > np.uint64(0):
                        k -= ONE  # come back to it when those before are done
                        break
                    if m < 0:
                        lone(p, h, prim[at], gap, bodies, walls, update)
                    else:
                        given = lone(p, h, table[at], gap, bodies, walls, update)
                        push(load, origin, m, (x - gap.dx, y - gap.dy, z - gap.dz), given)
                        if table[at, MESH_FACETS] == 1:
                            mark(load, w, p, bodies, table[at], mesh, given)
                if k < stop:
                    break
                if touched != 0:
                    for later in range(begin, stop):
                        if code[later] < 0:
                            continue
                        if touch[later] & HANDLED:
                            touch[later] ^= HANDLED
                        elif touch[later] != 0:
                            touch[later] = 0
                            for c in range(REMEMBERED):
                                hist[later, c] = 0.0
                    touched = np.uint8(0)
                begin = stop
                i += ONE
            # gather what the law needs, field after field
            found: Any = np.int64(n)
            for c in range(0, found, FOUR):
                spread(row, X, who, c, b, PLACE_I, BLOCK)
                spread(row, VX, who, c, b, VX_I, BLOCK)
                spread(spin, WX, who, c, b, SPIN_IX, BLOCK)
                spread(hist, SX, entry, c, b, SHIFT_X, BLOCK)
                if wide == WITH_ROLLING:
                    spread(hist, SZ, entry, c, b, SHIFT_Z, BLOCK)
            for c in range(found):
                if pick[c] != slot[c]:
                    slot[c] = pick[c]
                    for f in range(BASIC):
                        b[MATERIAL + f * BLOCK + c] = coef[pick[c], f]
            for c in range(-(-found // LANES) * LANES):
                dx = b[LEVER_X + c]
                dy = b[LEVER_Y + c]
                dz = b[LEVER_Z + c]
                r = b[DISTANCE + c]
                radius = b[RADIUS_I + c]
                mass = b[MASS_I + c]
                overlap = radius - r
                inv = 1.0 / r
                area = 0.0
                if model.cohesion != 0:
                    area = wall_area(model.cohesion, r, radius, overlap)
                arm = radius - 0.5 * overlap
                wx = arm * b[SPIN_IX + c] * inv
                wy = arm * b[SPIN_IY + c] * inv
                wz = arm * b[SPIN_IZ + c] * inv
                own = material_of(b, MATERIAL, c)
                contact = Contact(
                    overlap, area, radius, mass, 1.4 * mass * radius * radius,
                    dx * inv, dy * inv, dz * inv, dx, dy, dz,
                    b[VX_I + c] - b[SPEED_X + c], b[VY_I + c] - b[SPEED_Y + c],
                    b[VZ_I + c] - b[SPEED_Z + c], wx, wy, wz, wx, wy, wz,
                )  # fmt: skip
                memory = memory_of(b, SHIFT_X, c)
                did, kept = contact_law(model, own, contact, memory, update, dt)
                b[PUSH_X + c] = did.fx
                b[PUSH_Y + c] = did.fy
                b[PUSH_Z + c] = did.fz
                b[TWIST_X + c] = -arm * did.tx - did.rx
                b[TWIST_Y + c] = -arm * did.ty - did.ry
                b[TWIST_Z + c] = -arm * did.tz - did.rz
                store_memory(b, SHIFT_X, c, kept)
            for at_once in range(0, found, FOUR):
                collect(b, PUSH_X, BLOCK, at_once, lines, PUSHED)
                collect(b, TWIST_Y, BLOCK, at_once, lines, TWISTED)
                collect(b, SHIFT_X, BLOCK, at_once, lines, KEPT)
                collect(b, SHIFT_Z, BLOCK, at_once, lines, KEPT_LATE)
                place = 0
                for c in range(at_once, min(at_once + FOUR, found)):
                    add_four(force, who[c], FX, lines, PUSHED + place)
                    add_two(force, who[c], TY, lines, TWISTED + place)
                    h = entry[c]
                    put_four(hist, h, SX, lines, KEPT + place)
                    if wide == WITH_ROLLING:
                        put_four(hist, h, SZ, lines, KEPT_LATE + place)
                    place += FOUR
            load_meshes(found, (who, entry, mesh_of, b), bodies, walls, mesh, load)

    made: Callable[..., None] = wall_forces
    return made
