"""When LIGGGHTS makes its neighbour lists anew between two runs, and what it forgets then."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from minidem.kernels.tables import Pairs, Walls
from minidem.run.loop import history_width
from minidem.world.state import Bools
from minidem.world.world import World

__all__ = ["Asked", "forget_contacts", "lists_asked"]


class Asked(NamedTuple):
    """What LIGGGHTS compares before a run with what was there before the run before.

    Attributes
    ----------
    model : int
        How often a ``pair_style`` was given.
    memory : tuple of int
        ``page`` and ``one`` of ``neigh_modify``.
    computes : tuple of (str, str)
        Id and style of those with lists of their own.
    """

    model: int
    memory: tuple[int, int]
    computes: tuple[tuple[str, str], ...]


def lists_asked(world: World) -> Asked:
    """Return what lists are asked for now."""
    computes = tuple((one.name, one.style) for one in world.computes.values() if one.own_lists)
    return Asked(world.pair.given, (world.neighbor.page, world.neighbor.one), computes)


def forget_contacts(world: World, before: Asked, now: Asked) -> None:
    """Let contacts begin anew where LIGGGHTS makes lists anew, and say so.

    These are contacts of particles with each other; with another memory those with meshes, too.
    LIGGGHTS notes the memory that there was before only when it is told another one, so that it
    makes lists anew before every run from then on.
    """
    neighbor, lists = world.neighbor, world.lists
    always = [key for key, value in neighbor.before.items() if value != getattr(neighbor, key)]
    if before == now and not always:
        return
    lost = _forget(lists.pairs, lists.before, np.array(True))
    if before.memory != now.memory:
        lost = _forget(lists.walls, lists.before, lists.walls.code >= 0) or lost
    if not (history_width(world) and lost):
        return
    if always:
        key = always[0]
        world.warn_once(
            "contacts of particles with each other begin anew in every run, as in LIGGGHTS 3.8.0 "
            f"behind 'neigh_modify {key} {getattr(neighbor, key)}'; give that line twice to keep "
            "them"
        )
    else:
        world.warn(
            "contacts of particles with each other begin anew in this run, as in LIGGGHTS 3.8.0: a "
            "pair_style, or a compute with lists of its own (contact/atom, coord/atom, "
            "cluster/atom, rdf) came or went since the run before; give them before the first run"
        )


def _forget(table: Pairs | Walls, rows: int, which: Bools) -> bool:
    """Forget contacts of a table; return whether there were any."""
    used = int(table.start[rows]) if rows else 0
    chosen = np.broadcast_to(which, table.touch.shape)[:used]
    lost = bool(table.hist[:used][chosen].any())
    table.hist[:used][chosen] = 0.0
    table.touch[:used][chosen] = 0
    return lost
