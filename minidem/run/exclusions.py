"""``neigh_modify exclude``: pairs of particles that do not see each other."""

from __future__ import annotations

import numpy as np

from minidem.world.world import World

__all__ = ["excludes", "leave_out"]


def excludes(world: World) -> bool:
    """Tell whether there are such pairs."""
    return bool(world.neighbor.no_types or world.neighbor.no_groups)


def leave_out(world: World) -> None:
    """Take them from a list that has just been made."""
    near, state, pairs = world.neighbor, world.state, world.lists.pairs
    n = state.n
    used = int(pairs.start[n])
    one = np.repeat(np.arange(n), np.diff(pairs.start[: n + 1]))
    other = pairs.other[:used].astype(np.int64)
    gone = np.zeros(used, bool)
    kind, mask = state.kind[:n] + 1, state.mask[:n]
    for first, second in near.no_types:
        for a, b in ((one, other), (other, one)):
            gone |= (kind[a] == first) & (kind[b] == second)
    for first, second in near.no_groups:
        for a, b in ((one, other), (other, one)):
            gone |= (mask[a] & first != 0) & (mask[b] & second != 0)
    if gone.any():
        world.lists.keep_pairs(~gone)
