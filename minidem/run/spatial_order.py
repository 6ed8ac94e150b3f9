"""The order in which LIGGGHTS holds its particles: it sorts them in space now and then.

Particles here lie in memory as kernels like it; their place in the order of LIGGGHTS is a number
that each of them has (`minidem.world.state.State.rank`).
"""

from __future__ import annotations

import math

import numpy as np

from minidem.errors import InputError
from minidem.fixes.forces.freeze import frozen_bit
from minidem.fixes.templates import largest_radii
from minidem.kernels.columns import GONE, POSITION, RADIUS
from minidem.world.event import NEVER
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["neighbor_cutoff", "place_bins", "sorted_in_space"]


_MOST_BINS = 2**31 - 1  # as in LIGGGHTS


def place_bins(world: World) -> None:
    """Choose the size of bins for a run, as `Atom::setup_sort_bins` of LIGGGHTS does.

    Raises
    ------
    InputError
        Where it stops, too: bins without a size, and too many.
    """
    sorting = world.sorting
    if not sorting.every:
        return
    sorting.bin = sorting.size or 0.5 * neighbor_cutoff(world)
    sorting.due = world.step
    if sorting.bin == 0.0:
        msg = (
            "Atom sorting has bin size = 0.0: there are no particles, and no distribution from "
            "which some could come; define them before the run, or give 'atom_modify sort 0 0'"
        )
        raise InputError(msg)
    if (bins := math.prod(_counts(world).tolist())) > _MOST_BINS:
        msg = (
            f"Too many atom sorting bins: {bins:.3g}, of {sorting.bin:g} m; give a larger SIZE, or "
            "'atom_modify sort 0 0'"
        )
        raise InputError(msg)


def _counts(world: World) -> Floats:
    """Return the number of bins along x, y and z, (3,), of which there may be too many."""
    box = world.need_box()
    found: Floats = np.maximum(np.trunc((box.hi - box.lo) * (1.0 / world.sorting.bin)), 1.0)
    return found


def neighbor_cutoff(world: World) -> float:
    """Return how far LIGGGHTS looks for neighbours, m; 0 without particles that may touch.

    Radii of all distributions count, whether they are inserted or not; two frozen particles do not.
    """
    state = world.state
    free, frozen = largest_radii(world), np.zeros(world.types)
    held = (state.mask[: state.n] & frozen_bit(world)) != 0
    for largest, which in ((free, ~held), (frozen, held)):
        np.maximum.at(largest, state.kind[: state.n][which], state.row[: state.n, RADIUS][which])
    both = np.maximum(np.add.outer(free, free), np.add.outer(frozen, free))
    reach = float(both.max(initial=0.0)) * world.neighbor.reach
    # LIGGGHTS keeps the square
    return float(np.sqrt(reach * reach)) + world.neighbor.skin if reach > 0.0 else 0.0


def sorted_in_space(world: World) -> int:
    """Sort particles if it is time; return the step from which on it is time again."""
    sorting = world.sorting
    if not (sorting.every and sorting.bin):  # without bins where it was off at the run's set-up
        return NEVER
    if world.step >= sorting.due:
        _sort(world)
    return sorting.due


def _sort(world: World) -> None:
    """Put particles in the order of bins along x, then y, then z; those of a bin keep theirs."""
    sorting, state, box = world.sorting, world.state, world.need_box()
    sorting.due = (world.step // sorting.every) * sorting.every + sorting.every
    counts = _counts(world)
    if counts.prod() == 1.0:
        return
    order = state.output_order()
    order = order[state.rank[order] != GONE]
    with np.errstate(invalid="ignore"):  # a particle that is nowhere is in some bin
        at = ((state.row[order, POSITION] - box.lo) * (counts / (box.hi - box.lo))).astype(np.int64)
    along_x, along_y, _ = most = counts.astype(np.int64)
    x, y, z = np.clip(at, 0, most - 1).T
    place = (z * along_y + y) * along_x + x
    state.rank[order[np.argsort(place, kind="stable")]] = np.arange(len(order))
