"""The tables of moving meshes for the kernels.

Motions that follow script variables have their velocities worked out ahead of the steps.
"""

from __future__ import annotations

import numpy as np

from minidem.fixes.move import MoveMesh, Mover
from minidem.kernels.columns import (
    MOTION,
    MOTION_CARRIES,
    MOTION_END,
    MOTION_FIRST,
    MOTION_KIND,
    MOTION_LEADS,
    MOTION_VALUE,
    MOTION_WAVES,
    ORIGIN,
    three,
)
from minidem.kernels.tables import Motions
from minidem.world.world import World

__all__ = ["fill_table", "motion_tables", "moving_meshes", "store_clocks"]

_WINDOW = 256  # steps worked out at once


def _moves(world: World) -> list[MoveMesh]:
    """Return all motions in the order of their fixes."""
    return [move for mover in world.of_kind(Mover) if (move := mover.motion())]


def moving_meshes(world: World) -> list[str]:
    """Return the ids of the meshes that move, each once."""
    return list(dict.fromkeys(move.mesh for move in _moves(world)))


def motion_tables(world: World) -> Motions:
    """Return the motions in the order of their fixes; clocks are copies."""
    moves = _moves(world)
    spec = np.zeros((len(moves), MOTION), np.int64)
    value = np.zeros((len(moves), MOTION_VALUE))
    clock = np.zeros(len(moves))
    seen: set[str] = set()
    for i, move in enumerate(moves):
        spec[i, MOTION_KIND] = move.kind
        spec[i, MOTION_FIRST], spec[i, MOTION_END] = world.meshes.span(move.mesh)
        spec[i, MOTION_LEADS] = move.mesh not in seen
        spec[i, MOTION_WAVES] = move.order
        spec[i, MOTION_CARRIES] = move.given is None  # a servo says where its own is
        value[i] = move.numbers
        clock[i] = move.clock
        seen.add(move.mesh)
    return Motions(spec, value, clock, np.zeros((1, len(moves), 3)), np.zeros(1, np.int64))


def fill_table(world: World, motions: Motions, stop: int) -> tuple[Motions, int]:
    """Work out the velocities of motions by variables for the coming steps.

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
    moves = _moves(world)
    if not any(move.variables or move.given is not None for move in moves):
        return motions, stop
    stop = min(stop, world.step + _WINDOW)
    table = np.zeros((stop - world.step, len(moves), 3))
    now = world.step
    try:
        for row in range(len(table)):
            world.step = now + 1 + row
            for m, move in enumerate(moves):
                if move.given is not None:
                    table[row, m] = move.given
                for c, name in enumerate(move.variables):
                    table[row, m, c] = world.interpreter.value(name)
    finally:
        world.step = now
    return motions._replace(table=table, base=np.array([now + 1], np.int64)), stop


def store_clocks(world: World, motions: Motions) -> None:
    """Keep the clocks of motions, and origins that were carried along, in their fixes."""
    for i, move in enumerate(_moves(world)):
        move.clock = float(motions.clock[i])
        move.numbers[three(ORIGIN)] = motions.value[i, three(ORIGIN)]
