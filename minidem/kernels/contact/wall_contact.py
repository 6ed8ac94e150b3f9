"""One contact of a particle with a wall: where it is, what it remembers, and its force."""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np

from minidem.kernels.columns import (  # isort: skip
    X, Y, Z, RADIUS, VX, VY, VZ, MASS, WX, WY, WZ, FX, FY, FZ, TX, TY, TZ, REMEMBERED,
    WALL_SHAPE, WALL_AXIS, WALL_TYPE, WALL_TURNS, WALL_MODEL, WALL, PLANE, WALL_PLACE,
    WALL_CENTRE, WALL_CENTRE_NEXT, WALL_VELOCITY, WALL_SPIN, WALL_VALUE, EARLIER, HANDLED,
    PLACE_BIT, PLACES, TYPES, A, B, C,
)  # fmt: skip
from minidem.kernels.contact.law import wall_area
from minidem.kernels.contact.laws.bridges import lasts, stretched
from minidem.kernels.contact.laws.liquid import drops_of
from minidem.kernels.contact.normal import act
from minidem.kernels.contact.records import Contact, Gap, switches
from minidem.kernels.contact.triangle import coplanar
from minidem.kernels.machine.jit import inlined, inner
from minidem.kernels.machine.space import columns
from minidem.kernels.models import EASO

__all__ = ["close_ranks", "gap_to", "inherit", "lone", "primitive"]


@inlined
def _first_free(taken: Any) -> int:
    """Return the first place whose bit is not set; the last one may be shared."""
    free = 0
    while free < PLACES - 1 and (taken >> np.uint64(free)) & np.uint64(1):
        free += 1
    return free


@inner
def inherit(walls: Any, mesh: Any, k: int, lo: int, hi: int, face: int) -> bool:
    """Prepare the history of a new contact; return False if a coplanar neighbour has it already.

    A contact takes the first place that is free among those of its particle and mesh, and of
    several coplanar neighbours the history of the one in the last place counts, as in LIGGGHTS.

    Parameters
    ----------
    walls, mesh : tables
        See `minidem.kernels.tables`.
    k, lo, hi : int
        Entry of the contact, and the range of the entries of its particle.
    face : int
        1 if the particle is over the face of the triangle.
    """
    hist = walls.hist
    code = walls.code
    owner = mesh.owner
    base = mesh.base
    t = code[k]
    m = owner[t]
    for c in range(REMEMBERED):
        hist[k, c] = 0.0
    limit = walls.curve[m]
    source = k
    last = -1
    taken = np.uint64(0)
    for other in range(lo, hi):
        u = code[other]
        if other == k or u < 0 or walls.touch[other] == 0 or owner[u] != m:
            continue
        place = walls.touch[other] >> PLACE_BIT
        taken |= np.uint64(1) << np.uint64(place)
        if face == 0:
            continue
        near = coplanar(mesh, t, u, limit)
        if not near and (base[t] != t or base[u] != u):
            # images count as neighbours where their triangles are, as in LIGGGHTS
            near = coplanar(mesh, t, base[u], limit) or coplanar(mesh, base[t], base[u], limit)
        if near:
            if walls.touch[other] & HANDLED:
                return False
            if place > last:
                last = place
                source = other
    walls.touch[k] = _first_free(taken) << PLACE_BIT
    if source != k:
        for c in range(REMEMBERED):
            hist[k, c] = hist[source, c]
    return True


@inner
def close_ranks(walls: Any, owner: Any, lo: int, hi: int) -> None:
    """Let the contacts of a particle, in entries lo to hi, move up to the first places.

    Contacts in the last places of a mesh fill the gaps, as in LIGGGHTS at a rebuild of the lists.
    """
    touch = walls.touch
    code = walls.code
    for k in range(lo, hi):
        while code[k] >= 0 and touch[k] != 0:
            taken = np.uint64(0)
            last = -1
            mover = k
            for other in range(lo, hi):
                if code[other] < 0 or touch[other] == 0 or owner[code[other]] != owner[code[k]]:
                    continue
                place = touch[other] >> PLACE_BIT
                taken |= np.uint64(1) << np.uint64(place)
                if place > last:
                    last = place
                    mover = other
            free = _first_free(taken)
            if free >= last:  # equal where the last place is shared
                break
            touch[mover] = (touch[mover] & (EARLIER | HANDLED)) | (free << PLACE_BIT)


@inlined
def primitive(walls: Any, w: int, x: float, y: float, z: float) -> Any:
    """Return the `Gap` between primitive wall w and a point."""
    prim = columns(walls.prim, WALL)
    value = columns(walls.value, WALL_VALUE)
    axis = prim[w, WALL_AXIS]
    ux = value[w, WALL_VELOCITY + X]
    uy = value[w, WALL_VELOCITY + Y]
    uz = value[w, WALL_VELOCITY + Z]
    place = value[w, WALL_PLACE]
    if prim[w, WALL_SHAPE] == PLANE:
        d = (x if axis == X else (y if axis == Y else z)) - place
        dx = d if axis == X else 0.0
        dy = d if axis == Y else 0.0
        dz = d if axis == Z else 0.0
        return Gap(abs(d), dx, dy, dz, ux, uy, uz)
    first = value[w, WALL_CENTRE]
    second = value[w, WALL_CENTRE_NEXT]
    px = 0.0 if axis == X else x - (first if axis == Z else second)
    py = 0.0 if axis == Y else y - (first if axis == X else second)
    pz = 0.0 if axis == Z else z - (first if axis == Y else second)
    far = sqrt(px * px + py * py + pz * pz)
    if far == 0.0:
        return Gap(0.0, 0.0, 0.0, 0.0, ux, uy, uz)
    scale = (far - place) / far
    # turning about its own axis: spin x radius; for the y axis LIGGGHTS exchanges x and z
    if prim[w, WALL_TURNS] == 1:
        spin = value[w, WALL_SPIN]
        ux = spin * (px if axis == Y else -py) if axis != X else 0.0
        uy = spin * (px if axis == Z else -pz) if axis != Y else 0.0
        uz = spin * (py if axis == X else -pz) if axis != Z else 0.0
    return Gap(abs(far - place), px * scale, py * scale, pz * scale, ux, uy, uz)


@inlined
def facing(i: Any, gap: Any, area: float, bodies: Any) -> Any:
    """Return the `Contact` of a particle with a wall that it touches or not, and its lever arm, m.

    Parameters
    ----------
    i : int
        Particle.
    gap : Gap
        Where the wall is.
    area : float
        That the cohesion acts on, m2.
    bodies : Bodies
        See `minidem.kernels.tables`.
    """
    row = bodies.parts.row
    spin = bodies.parts.spin
    radius = row[i, RADIUS]
    mass = row[i, MASS]
    overlap = radius - gap.distance
    inv = 1.0 / gap.distance
    arm = radius - 0.5 * max(overlap, 0.0)
    wx = arm * spin[i, WX] * inv
    wy = arm * spin[i, WY] * inv
    wz = arm * spin[i, WZ] * inv
    contact = Contact(
        overlap, area, radius, mass, 1.4 * mass * radius * radius,
        gap.dx * inv, gap.dy * inv, gap.dz * inv, gap.dx, gap.dy, gap.dz,
        row[i, VX] - gap.ux, row[i, VY] - gap.uy, row[i, VZ] - gap.uz, wx, wy, wz, wx, wy, wz,
    )  # fmt: skip
    return contact, arm


@inlined
def gap_to(near: Any, mesh: Any, t: Any, moves: Any) -> Any:
    """Return the `Gap` to the nearest point of triangle t, whose mesh moves or does not."""
    ux = 0.0
    uy = 0.0
    uz = 0.0
    if moves == 1:
        vel = mesh.vel
        wa, wb, wc = near.wa, near.wb, near.wc
        ux = wa * vel[t, A, X] + wb * vel[t, B, X] + wc * vel[t, C, X]
        uy = wa * vel[t, A, Y] + wb * vel[t, B, Y] + wc * vel[t, C, Y]
        uz = wa * vel[t, A, Z] + wb * vel[t, B, Z] + wc * vel[t, C, Z]
    return Gap(near.distance, near.dx, near.dy, near.dz, ux, uy, uz)


@inner
def _apart(i: int, k: int, words: Any, gap: Any, bodies: Any, walls: Any) -> Any:
    """Do what `lone` does for a particle that does not touch the wall, as a liquid bridge may."""
    for c in range(REMEMBERED):
        walls.hist[k, c] = 0.0
    model = switches(words, WALL_MODEL)
    if model.cohesion < EASO:
        return 0.0, 0.0, 0.0
    parts = bodies.parts
    radius = parts.row[i, RADIUS]
    q = parts.kind[i] * bodies.control.whole[TYPES] + words[WALL_TYPE]
    drops = drops_of(model, bodies, q, (i, np.int64(-1)))
    mine, other = drops
    if not lasts(bodies.coef[q], gap.distance - radius, 2.0 * radius, mine + other):
        return 0.0, 0.0, 0.0
    contact, arm = facing(i, gap, 0.0, bodies)
    did = stretched(model.cohesion, bodies.coef[q], (radius, radius), contact, drops)
    return _pull(parts.force, i, arm, did)


@inlined
def _pull(force: Any, i: Any, arm: float, did: Any) -> Any:
    """Add what a wall does to the force and torque of particle i; return the force."""
    force[i, FX] += did.fx
    force[i, FY] += did.fy
    force[i, FZ] += did.fz
    force[i, TX] += -arm * did.tx - did.rx
    force[i, TY] += -arm * did.ty - did.ry
    force[i, TZ] += -arm * did.tz - did.rz
    return did.fx, did.fy, did.fz


@inner
def lone(i: int, k: int, words: Any, gap: Any, bodies: Any, walls: Any, update: int) -> Any:
    """Add the force of one contact with a wall of any model to its particle, and return it.

    Across a gap only a liquid bridge acts.

    Parameters
    ----------
    i, k : int
        Particle, and entry of the contact.
    words : int64 (25,)
        Row of the wall in its table.
    gap : Gap
        Where the wall is.
    bodies : Bodies
        See `minidem.kernels.tables`.
    walls : Walls
        The list in use.
    update : int
        1 in a time step, 0 at setup.
    """
    parts = bodies.parts
    model = switches(words, WALL_MODEL)
    r = gap.distance
    radius = parts.row[i, RADIUS]
    if r > radius:
        return _apart(i, k, words, gap, bodies, walls)
    area = 0.0
    if model.cohesion != 0:
        area = wall_area(model.cohesion, r, radius, radius - r)
    contact, arm = facing(i, gap, area, bodies)
    q = parts.kind[i] * bodies.control.whole[TYPES] + words[WALL_TYPE]
    did = act(model, bodies, q, contact, (i, np.int64(-1)), walls.hist, k, update)
    return _pull(parts.force, i, arm, did)
