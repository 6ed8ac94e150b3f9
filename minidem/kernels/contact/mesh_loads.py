"""What particles do to meshes: force and torque on each, force and wear on single triangles.

A triangle wears at the rate of Finnie, as LIGGGHTS has it: ``2 k |v| |F| E / A``, v the velocity of
the particle relative to the wall, F the force, A the area, and with g the angle between v and the
wall E = sin 2g - 3 sin2 g for tan g < 1/3, else cos2 g / 3.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np

from minidem.kernels.columns import (  # isort: skip
    X, Y, Z, VX, VY, VZ, FX, FY, FZ, TX, TY, TZ, A, B, C, ROW, WALL, MESH_FACETS, MESH_MOVES,
    MESH_ROW, WALL_TYPE, WEAR_NOW, WORN, TYPES, DT,
)  # fmt: skip
from minidem.kernels.models import (  # isort: skip
    FINNIE,
)  # fmt: skip
from minidem.kernels.contact.triangle import closest

from minidem.kernels.contact.wall_block import (  # isort: skip
    LEVER_X, LEVER_Y, LEVER_Z, PUSH_X, PUSH_Y, PUSH_Z,
)  # fmt: skip
from minidem.kernels.machine.jit import inlined, inner
from minidem.kernels.machine.space import columns

__all__ = ["NO_MESH", "load_meshes", "mark", "push", "wear_down"]

NO_MESH = np.uint64(2**63)
"""Stands for the mesh of a contact with a primitive wall."""

SLOWEST = 1.0e-7  # m/s
STEEP = 1.0e-4  # cosine of an impact that is normal to the wall
THIRD = 0.33333  # as LIGGGHTS has it


@inlined
def push(load: Any, origin: Any, m: int, point: Any, force: Any) -> None:
    """Add the reaction to a force at a point of mesh m to the load of that mesh."""
    x, y, z = point
    fx, fy, fz = force
    load[m, FX] -= fx
    load[m, FY] -= fy
    load[m, FZ] -= fz
    px = x - origin[m, X]
    py = y - origin[m, Y]
    pz = z - origin[m, Z]
    load[m, TX] -= py * fz - pz * fy
    load[m, TY] -= pz * fx - px * fz
    load[m, TZ] -= px * fy - py * fx


@inlined
def load_meshes(found: Any, blocked: Any, bodies: Any, walls: Any, mesh: Any, load: Any) -> None:
    """Add the reactions to the forces of a block of contacts.

    Parameters
    ----------
    found : int
        Contacts.
    blocked : (vector, vector, vector, vector)
        Their particles, entries in the list and meshes, `NO_MESH` for primitive walls; the fields
        of the block.
    bodies, walls, mesh, load
        As in `minidem.kernels.contact.walls.wall_forces_for`.
    """
    who, entry, mesh_of, b = blocked
    row = columns(bodies.parts.row, ROW)
    table = columns(walls.mesh, WALL)
    origin = mesh.origin
    # sums of one mesh after the other stay in registers
    at = NO_MESH
    fx = fy = fz = tx = ty = tz = 0.0
    ox = oy = oz = 0.0
    for c in range(found):
        m = mesh_of[c]
        if m == NO_MESH:
            continue
        if m != at:
            if at != NO_MESH:
                load[at, FX], load[at, FY], load[at, FZ] = fx, fy, fz
                load[at, TX], load[at, TY], load[at, TZ] = tx, ty, tz
            at = m
            fx, fy, fz = load[at, FX], load[at, FY], load[at, FZ]
            tx, ty, tz = load[at, TX], load[at, TY], load[at, TZ]
            ox, oy, oz = origin[at, X], origin[at, Y], origin[at, Z]
        i = who[c]
        px = row[i, X] - b[LEVER_X + c] - ox
        py = row[i, Y] - b[LEVER_Y + c] - oy
        pz = row[i, Z] - b[LEVER_Z + c] - oz
        qx, qy, qz = b[PUSH_X + c], b[PUSH_Y + c], b[PUSH_Z + c]
        fx -= qx
        fy -= qy
        fz -= qz
        tx -= py * qz - pz * qy
        ty -= pz * qx - px * qz
        tz -= px * qy - py * qx
        if table[at, MESH_FACETS] == 1:
            w = np.int64(walls.code[entry[c]])
            mark(load, w, np.int64(i), bodies, table[at], mesh, (qx, qy, qz))
    if at != NO_MESH:
        load[at, FX], load[at, FY], load[at, FZ] = fx, fy, fz
        load[at, TX], load[at, TY], load[at, TZ] = tx, ty, tz


@inner
def mark(load: Any, w: Any, i: Any, bodies: Any, words: Any, mesh: Any, force: Any) -> None:
    """Add the force of particle i on triangle w, and the wear it makes in this step.

    Parameters
    ----------
    load : float64 (rows, 8)
        See `minidem.kernels.tables.Walls`.
    w, i : int
        Triangle and particle.
    bodies : Bodies
        See `minidem.kernels.tables`.
    words : int64 (23,)
        Row of the mesh in ``Walls.mesh``.
    mesh : Mesh
        Triangles.
    force : (float, float, float)
        On the particle, N.
    """
    at = words[MESH_ROW] + mesh.base[w]
    fx, fy, fz = force
    load[at, FX] -= fx
    load[at, FY] -= fy
    load[at, FZ] -= fz
    parts = bodies.parts
    row = parts.row
    k = bodies.coef[parts.kind[i] * bodies.control.whole[TYPES] + words[WALL_TYPE], FINNIE]
    if k == 0.0:
        return
    near = closest(mesh, w, row[i, X], row[i, Y], row[i, Z])
    vx = row[i, VX]
    vy = row[i, VY]
    vz = row[i, VZ]
    if words[MESH_MOVES] == 1:
        vel = mesh.vel
        wa, wb, wc = near.wa, near.wb, near.wc
        vx -= wa * vel[w, A, X] + wb * vel[w, B, X] + wc * vel[w, C, X]
        vy -= wa * vel[w, A, Y] + wb * vel[w, B, Y] + wc * vel[w, C, Y]
        vz -= wa * vel[w, A, Z] + wb * vel[w, B, Z] + wc * vel[w, C, Z]
    if near.dx * vx + near.dy * vy + near.dz * vz > 0.0:
        return  # on its way off
    speed = sqrt(vx * vx + vy * vy + vz * vz)
    if speed < SLOWEST:
        return
    nx = mesh.normal[w, X]
    ny = mesh.normal[w, Y]
    nz = mesh.normal[w, Z]
    cx = vy * nz - vz * ny
    cy = vz * nx - vx * nz
    cz = vx * ny - vy * nx
    sine = min(abs(vx * nx + vy * ny + vz * nz) / speed, 1.0)
    cosine = min(sqrt(cx * cx + cy * cy + cz * cz) / speed, 1.0)
    if cosine < STEEP or 3.0 * sine > cosine:
        part = THIRD * cosine * cosine
    else:
        part = 2.0 * sine * cosine - 3.0 * sine * sine
    size = sqrt(fx * fx + fy * fy + fz * fz)
    load[at, WEAR_NOW] += part * (2.0 * k * speed * size) * bodies.control.real[DT]


@inner
def wear_down(load: Any, meshes: int) -> None:
    """Add the wear of a step to that of all steps, in the rows of triangles."""
    for at in range(meshes, load.shape[0]):
        load[at, WORN] += load[at, WEAR_NOW]
