"""Mesh motions that follow script variables: their velocities are worked out ahead of the steps."""

from __future__ import annotations

import numpy as np

from minidem.fixes.walls import MoveMesh
from minidem.kernels.tables import Motions
from minidem.world import World

__all__ = ["fill_table"]

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
