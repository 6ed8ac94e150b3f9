"""``replicate NX NY NZ offset OX OY OZ shift SX SY SZ``: a bed several times side by side."""

from __future__ import annotations

from math import prod

import numpy as np

from minidem.commands.command import COMMANDS
from minidem.errors import InputError
from minidem.kernels.columns import POSITION
from minidem.memory import check_room
from minidem.run.engine import Engine
from minidem.words import Words
from minidem.world.fix import all_fixes
from minidem.world.periodic import box_text
from minidem.world.state import Ints
from minidem.world.world import World

_USAGE = "replicate NX NY NZ offset OX OY OZ shift SX SY SZ"
_MOST_ID = 2**31 - 1


@COMMANDS.register("replicate")
def _replicate(engine: Engine, words: Words) -> None:
    """Copy all particles; as in LIGGGHTS 3.8.0 ``shift`` is not optional.

    The box grows by whole lengths of itself, whatever the offset; contacts of copies begin anew.
    """
    words.need(11, _USAGE)
    world = engine.world
    box = world.need_box()
    times = [words.interval() for _ in range(3)]
    words.expect("offset")
    offset = np.array(words.numbers(3))
    words.expect("shift")
    shift = np.array(words.numbers(3))
    engine.report.screen("Replicating atoms ...")
    if any(n > 1 and face != "pp" for n, face in zip(times, box.boundary, strict=True)):
        world.warn("Replicating in a non-periodic dimension")
    state, count = world.state, world.state.n
    check_room(count * (prod(times) - 1), count, "replicate")
    if count:
        _copy(world, prod(times))
        cells = np.indices(times).reshape(3, -1).T
        state.row[: state.n, POSITION] += shift  # before the offset, as its sum is rounded
        state.row[: state.n, POSITION] += np.repeat(cells * offset, count, axis=0)
        state.held[: state.n] = state.row[: state.n, POSITION]
    length = box.hi - box.lo
    world.log(f"  old: {box_text(box)}")
    box.lo += shift
    box.hi[:] = box.lo + np.array(times) * length
    box.least_lo[:], box.least_hi[:] = box.lo, box.hi
    for what in ("new", "fin"):
        world.log(f"  {what}: {box_text(box)}")


def _copy(world: World, times: int) -> None:
    """Copy the particles, all of them one after the other; ids and places go on."""
    state, count = world.state, world.state.n
    ids: Ints = state.ids[:count].copy()
    steps = count * np.arange(times)
    new = (ids + steps[:, None]).ravel()
    if int(new.max()) > _MOST_ID or (np.diff(np.sort(new)) == 0).any():
        msg = (
            "replicate: the ids of copies, which are those of the particles and their number on "
            "top, would not all be different; reset them with 'delete_atoms ... compress yes'"
        )
        raise InputError(msg)
    place = np.empty(count, np.int64)
    place[state.output_order()] = np.arange(count)
    state.reserve(count * times)
    state.take(np.tile(np.arange(count), times))
    state.ids[: state.n] = new
    state.rank[: state.n] = (place + steps[:, None]).ravel()
    state.force[count : state.n] = 0.0
    for fix in all_fixes(world):
        fix.particles_copied(steps[1:].tolist())
