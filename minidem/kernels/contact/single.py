"""Contacts one by one, for output: what each of them does to its particles at this moment."""

from __future__ import annotations

from math import nan
from typing import Any

from minidem.kernels.columns import (  # isort: skip
    X, Y, Z, RADIUS, FX, FY, FZ, TX, TY, TZ, TYPES, PAIR_MODEL, MESH_MOVES, PARTICLE,
    TOUCHED,
)  # fmt: skip
from minidem.kernels.contact.laws.bridges import lasts, stretched
from minidem.kernels.contact.laws.liquid import drops_of
from minidem.kernels.contact.normal import act
from minidem.kernels.contact.pair_contact import apart, meet
from minidem.kernels.contact.records import Reaction, switches
from minidem.kernels.contact.triangle import closest
from minidem.kernels.contact.wall_contact import gap_to, lone
from minidem.kernels.machine.jit import kernel

__all__ = ["ARM", "WALL_SPEED", "pair_actions", "wall_actions"]

ARM = 6
"""First column of the vector from the other to the particle, m."""
WALL_SPEED = 9
"""First column of the velocity of a wall, m/s."""


@kernel
def pair_actions(bodies: Any, who: Any, memory: Any, out: Any) -> None:
    """Work out the forces of pairs in contact or near it; histories do not advance.

    Parameters
    ----------
    bodies : Bodies
        See `minidem.kernels.tables`.
    who : int64 (n, 2)
        Rows of the particles.
    memory : float64 (n, 13)
        Histories; used up.
    out : float64 (n, 9)
        Receives force, N, and torque, N m, on the first, and the vector from the second, m; nan
        for a force across a gap that no liquid bridge spans.
    """
    parts = bodies.parts
    whole = bodies.control.whole
    model = switches(whole, PAIR_MODEL)
    for c in range(who.shape[0]):
        i = who[c, PARTICLE]
        j = who[c, TOUCHED]
        between = apart(bodies, i, j)
        contact, ci, _ = meet(bodies, model, i, j, between)
        q = parts.kind[i] * whole[TYPES] + parts.kind[j]
        if contact.overlap > 0.0:
            did = act(model, bodies, q, contact, (i, j), memory, c, 0)
        else:
            drops = drops_of(model, bodies, q, (i, j))
            sizes = parts.row[i, RADIUS], parts.row[j, RADIUS]
            did = stretched(model.cohesion, bodies.coef[q], sizes, contact, drops)
            mine, other = drops
            ri, rj = sizes
            if not lasts(bodies.coef[q], -contact.overlap, ri + rj, mine + other):
                did = Reaction(nan, nan, nan, nan, nan, nan, nan, nan, nan)
        out[c, FX] = did.fx
        out[c, FY] = did.fy
        out[c, FZ] = did.fz
        out[c, TX] = -ci * did.tx - did.rx
        out[c, TY] = -ci * did.ty - did.ry
        out[c, TZ] = -ci * did.tz - did.rz
        out[c, ARM + X], out[c, ARM + Y], out[c, ARM + Z] = between


@kernel
def wall_actions(bodies: Any, walls: Any, mesh: Any, who: Any, out: Any) -> None:
    """Work out the forces of contacts with meshes; histories do not advance.

    Parameters
    ----------
    bodies : Bodies
        See `minidem.kernels.tables`; the forces of its particles are used up.
    walls : Walls
        Its histories belong to the contacts asked for.
    mesh : Mesh
        Triangles.
    who : int64 (n, 2)
        Row of the particle, and triangle.
    out : float64 (n, 12)
        Receives force, N, and torque, N m, on the particle, the vector from the mesh to its
        centre, m, and the velocity of the mesh there, m/s.
    """
    row = bodies.parts.row
    force = bodies.parts.force
    for c in range(who.shape[0]):
        i = who[c, PARTICLE]
        w = who[c, TOUCHED]
        near = closest(mesh, w, row[i, X], row[i, Y], row[i, Z])
        words = walls.mesh[mesh.owner[w]]
        gap = gap_to(near, mesh, w, words[MESH_MOVES])
        for f in range(FX, TZ + 1):
            force[i, f] = 0.0
        lone(i, c, words, gap, bodies, walls, 0)
        for f in range(FX, TZ + 1):
            out[c, f] = force[i, f]
        out[c, ARM + X] = near.dx
        out[c, ARM + Y] = near.dy
        out[c, ARM + Z] = near.dz
        out[c, WALL_SPEED + X] = gap.ux
        out[c, WALL_SPEED + Y] = gap.uy
        out[c, WALL_SPEED + Z] = gap.uz
