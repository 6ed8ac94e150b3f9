"""Force and wear of single triangles.

A triangle wears at the rate of Finnie, as LIGGGHTS has it: ``2 k |v| |F| E / A``, v the velocity of
the particle relative to the wall, F the force, A the area, and with g the angle between v and the
wall E = sin 2g - 3 sin2 g for tan g < 1/3, else cos2 g / 3.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from minidem.kernels.columns import (  # isort: skip
    X, Y, Z, VX, VY, VZ, FX, FY, FZ, A, B, C, MESH_MOVES, MESH_ROW, WALL_TYPE, WEAR_NOW, WORN,
    TYPES, DT,
)  # fmt: skip
from minidem.kernels.models import (  # isort: skip
    FINNIE,
)  # fmt: skip
from minidem.kernels.contact.triangle import closest
from minidem.kernels.machine.jit import inner

__all__ = ["mark", "wear_down"]

SLOWEST = 1.0e-7  # m/s
STEEP = 1.0e-4  # cosine of an impact that is normal to the wall
THIRD = 0.33333  # as LIGGGHTS has it


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
