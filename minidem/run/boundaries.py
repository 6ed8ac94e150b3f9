"""What happens to particles at the faces of the box when lists are made anew."""

from __future__ import annotations

import numpy as np

from minidem.kernels.columns import (
    BOX_LOWER,
    BOX_MOVES,
    BOX_PERIODIC,
    BOX_UPPER,
    INVERSE,
    LENGTH,
    POSITION,
    RADIUS,
    three,
)
from minidem.world.fix import largest_inserted
from minidem.world.state import Bools, Box, Floats, State
from minidem.world.world import World

__all__ = ["SMALL", "apply_boundaries", "follow_particles", "place_box", "reach_beyond"]

SMALL = 1.0e-4
"""Part of the first box that shrink-wrapped faces keep as clearance."""


def apply_boundaries(world: World) -> None:
    """Wrap and shrink-wrap; particles beyond a fixed face are no longer alive.

    As in LIGGGHTS they go without a word; `minidem.run.losses` looks after that.
    """
    box = world.need_box()
    state = world.state
    n = state.n
    follow_particles(world)
    position = state.row[:n, POSITION]
    out = (position < box.lo) | (position >= box.hi)
    if out.any():
        closed = np.array([kind != "pp" for kind in box.boundary])
        out &= closed & (state.more.alive[:n] != 0)[:, None]
    if out.any():
        # direction by direction, as particles would change processors
        state.drop_in_passes(list(out.T))
        gone = out.any(axis=1)
        state.more.alive[:n][gone] = 0
        world.lose(np.flatnonzero(gone))


def follow_particles(world: World) -> None:
    """Wrap particles in periodic directions, and move shrink-wrapped faces to them."""
    box, state = world.need_box(), world.state
    _wrap(state, box)
    if any(kind not in ("pp", "ff") for kind in box.boundary):
        _shrink(world, box, state.more.alive[: state.n] != 0)


def _wrap(state: State, box: Box) -> None:
    """Bring particles back into periodic directions and count the crossings."""
    n = state.n
    for c in range(3):
        if box.boundary[c] != "pp":
            continue
        length = box.hi[c] - box.lo[c]
        x = state.row[:n, c]
        low = x < box.lo[c]
        high = x >= box.hi[c]
        if not (low.any() or high.any()):
            continue
        x[low] = np.maximum(x[low] + length, box.lo[c])
        state.image[:n, c] -= low
        x[high] = np.maximum(x[high] - length, box.lo[c])
        state.image[:n, c] += high


def _shrink(world: World, box: Box, alive: Bools) -> None:
    """Move shrink-wrapped faces to the particles and mesh nodes."""
    state = world.state
    nodes = world.meshes.table.node.reshape(-1, 3)
    for c in range(3):
        kind = box.boundary[c]
        if kind in ("pp", "ff"):
            continue
        small = SMALL * (box.least_hi[c] - box.least_lo[c])
        values = np.concatenate([state.row[: state.n, c][alive], nodes[:, c]])
        if not len(values):
            continue
        low = float(values.min()) - small
        high = float(values.max()) + small
        if kind[0] in "sm":
            box.lo[c] = low if kind[0] == "s" else min(low, box.least_lo[c])
        if kind[1] in "sm":
            box.hi[c] = high if kind[1] == "s" else max(high, box.least_hi[c])


def place_box(world: World, real: Floats, *, alone: bool = True) -> None:
    """Tell the kernels where the box is now.

    Parameters
    ----------
    world : World
        Its box.
    real : ndarray
        Of ``Control.real``, see `minidem.kernels.columns`.
    alone : bool
        Whether kernels may make lists anew without Python, if the box stays as it is.
    """
    box = world.need_box()
    period = box.period()
    real[three(LENGTH)] = period
    real[three(INVERSE)] = [1.0 / length if length > 0.0 else 0.0 for length in period]
    moves = not alone or any(kind not in ("pp", "ff") for kind in box.boundary)
    more = world.state.more
    more.box[three(BOX_LOWER)] = box.lo
    more.box[three(BOX_UPPER)] = box.hi
    more.box[three(BOX_PERIODIC)] = period > 0.0
    more.box[BOX_MOVES] = moves


def reach_beyond(world: World) -> float:
    """Return how far beyond the box a mesh may matter, m."""
    state = world.state
    largest = max(float(state.row[: state.n, RADIUS].max(initial=0.0)), largest_inserted(world))
    return float(max(2.0, world.neighbor.reach) * largest + world.neighbor.skin)
