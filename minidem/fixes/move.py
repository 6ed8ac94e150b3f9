"""Mesh motions that follow script variables: their velocities are worked out ahead of the steps."""

from __future__ import annotations

import numpy as np

from minidem.fixes.wall import MeshSurface, MoveMesh, WallGran
from minidem.kernels.tables import Motions
from minidem.world.world import World

__all__ = ["fill_table", "rest_meshes", "store_clocks"]

_WINDOW = 256  # steps worked out at once
_AHEAD = ("step", "dt", "time", "PI")


def fill_table(world: World, motions: Motions, stop: int) -> tuple[Motions, int]:
    """Work out the velocities of table motions for the coming steps.

    Parameters
    ----------
    world : World
        Its interpreter evaluates the variables.
    motions : Motions
        Tables.
    stop : int
        Last step wanted.

    Returns
    -------
    Motions
        With a filled table.
    int
        Last step that it covers.
    """
    moves = world.of_kind(MoveMesh)
    if not any(move.variables for move in moves):
        return motions, stop
    stop = min(stop, world.step + _WINDOW)
    table = np.zeros((stop - world.step, len(moves), 3))
    now = world.step
    try:
        for row in range(len(table)):
            world.step = now + 1 + row
            for m, move in enumerate(moves):
                for c, name in enumerate(move.variables):
                    table[row, m, c] = world.interpreter.value(name)
    finally:
        world.step = now
    scale = np.array([2.0 * np.pi if move.kind == 7 else 1.0 for move in moves])
    del scale
    return motions._replace(table=table, base=np.array([now + 1], np.int64)), stop


def rest_meshes(world: World) -> None:
    """Zero the velocity of meshes whose motion was defined before their wall."""
    order = {name: i for i, name in enumerate(world.fixes)}
    for move in world.of_kind(MoveMesh):
        for wall in world.of_kind(WallGran):
            if move.mesh in wall.meshes and order[move.name] < order[wall.name]:
                table = world.meshes.table
                table.vel[table.owner == world.meshes.names.index(move.mesh)] = 0.0


def store_clocks(world: World, motions: Motions | None) -> None:
    """Keep the clocks of motions and the loads of meshes in their fixes."""
    if motions is not None:
        for i, move in enumerate(world.of_kind(MoveMesh)):
            move.clock = float(motions.clock[i])
            move.value[:3] = motions.value[i, :3]
    for i, name in enumerate(world.meshes.names):
        fix = world.fixes.get(name)
        if isinstance(fix, MeshSurface) and fix.stress:
            fix.load = world.lists.walls.load[i, :6].copy()
