"""New lists that need Python: at the start of a run, after insertions, or in boxes that change."""

from __future__ import annotations

from collections.abc import Sequence

from minidem.fixes.adapt import Adapter
from minidem.fixes.carrier import Carrier
from minidem.fixes.flow.tables import counters_delete, place_counters, take_out
from minidem.fixes.motions import moving_meshes
from minidem.kernels.columns import BOX_MOVES, ENTRY, LISTED, NEED_COUNT, REBUILT, SORT_STEP, STEP
from minidem.kernels.control import REBUILD_NOW, REBUILD_ON, WITH_LISTS
from minidem.kernels.lists.rebuild import INCOMPLETE, MADE
from minidem.run.boundaries import apply_boundaries, place_box, reach_beyond
from minidem.run.exclusions import excludes, leave_out
from minidem.run.loop import Loop
from minidem.run.renumbered import look_up, note_order, order_matters
from minidem.run.spatial_order import sorted_in_space
from minidem.world.images import make_images
from minidem.world.world import World

__all__ = ["kernels_make_lists", "make_lists"]


def kernels_make_lists(world: World, loop: Loop) -> bool:
    """Let the loop make lists by itself after an insertion, where nothing needs Python."""
    whole, box, lists = loop.control.whole, world.state.more.box, world.lists
    if box[BOX_MOVES] or lists.noted or whole[STEP] >= whole[SORT_STEP]:
        return False
    lists.make_room(world.state, loop.width)
    whole[LISTED] = lists.before
    whole[ENTRY] = WITH_LISTS
    return True


def make_lists(world: World, loop: Loop, adapter: Adapter, carriers: Sequence[Carrier]) -> None:
    """Make new lists, with memory as needed, for the particles that stay in the box.

    Parameters
    ----------
    world : World
        Its particles may have moved, come and grown.
    loop : Loop
        The compiled loop, which makes them.
    adapter : Adapter
        Diameters that change.
    carriers : sequence of Carrier
        Fixes that act in every step.
    """
    state, whole = world.state, loop.control.whole
    entry = int(whole[ENTRY])
    mode = REBUILD_ON
    if whole[REBUILT] != INCOMPLETE:
        mode = REBUILD_NOW
        state.reserve(1)
        take_out(world)
        apply_boundaries(world)
        moving = bool(world.meshes.images and moving_meshes(world))
        if moving:
            make_images(world, reach_beyond(world))
            place_counters(world)
        # with changing diameters or box, counters that take out, pairs left out, or contacts
        # that depend on the order, lists are Python's business
        busy = moving or adapter.active or counters_delete(world) or excludes(world)
        alone = not (busy or carriers or order_matters(world))
        place_box(world, loop.control.real, alone=alone)
        whole[SORT_STEP] = sorted_in_space(world)
        look_up(world)
    while True:
        world.lists.make_room(state, loop.width)
        whole[ENTRY] = mode
        whole[LISTED] = world.lists.before
        loop.call()
        if whole[REBUILT] == MADE:
            break
        if whole[REBUILT] == INCOMPLETE:
            mode = REBUILD_ON
    state.n = int(state.more.needs[NEED_COUNT])
    for fix in carriers:
        fix.lists_made(world, loop.control)
    adapter.hold()
    state.more.alive[:] = 1
    world.lists.before = state.n
    note_order(world)
    if excludes(world):
        leave_out(world)
    whole[ENTRY] = entry
