"""The loops of a step as the run loop calls them when one thread does all of them.

`minidem.kernels.step.team` has the same functions for several threads.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

from minidem.kernels.columns import BASIC_SWITCHES, NEED_COUNT, PARTICLES, WET
from minidem.kernels.contact.general import pair_forces_general
from minidem.kernels.contact.laws.liquid import begin_flux, settle
from minidem.kernels.contact.mesh_loads import wear_down
from minidem.kernels.contact.pairs import pair_forces_for
from minidem.kernels.contact.walls import wall_forces_for
from minidem.kernels.lists.neighbor import pair_list
from minidem.kernels.machine.jit import inner
from minidem.kernels.motion.integrate import kick, second
from minidem.kernels.near import looked
from minidem.kernels.scene import Bodies

__all__ = [
    "ADVANCE",
    "GENERAL",
    "ONLY_PAIRS",
    "ONLY_WALLS",
    "SETUP",
    "Model",
    "Phases",
    "alone",
    "pairs_of",
]

SETUP, ADVANCE = 0, 1
"""The flag of ``collide``: at setup histories are used, in a step they advance."""
ONLY_PAIRS, ONLY_WALLS = 2, 4
"""May be added to the flag."""


class Model(NamedTuple):
    """What a run loop is compiled for.

    Attributes
    ----------
    switches : tuple of int
        The first nine of `minidem.kernels.contact.records.Switches`.
    periodic : bool
        True if a direction of the box is periodic.
    general : bool
        True for the loop that serves all models, those with extensions too: it reads the switches
        from ``control`` and from the tables of the walls, wraps in all directions, and takes one
        contact after the other. Trajectories are the same to the last bit; it takes up to half as
        long again.
    """

    switches: tuple[int, ...]
    periodic: bool
    general: bool = False


GENERAL = Model((0,) * BASIC_SWITCHES, periodic=True, general=True)


class Phases(NamedTuple):
    """The parts of a step that threads may share.

    All but the last take ``(scene, lists, flag)``, a `Scene` and the `Lists` in use; the flag is
    for `move` that of `minidem.kernels.motion.integrate.kick`, for `collide` 1 if histories
    advance.

    Attributes
    ----------
    divide : callable
        Prepares for new lists.
    move : callable
        First half kick, move, reset of forces; returns what `kick` does.
    collide : callable
        Adds the forces of pairs and walls.
    end : callable
        Second half kick.
    list_pairs : callable
        ``list_pairs(before, tables, lists, spare)`` fills the pair list of `spare` for particles
        in cell order, of which `before` had rows in `lists`, and returns how many entries it
        needs; if that is more than there are, the list is of no use.
    """

    divide: Callable[..., None]
    move: Callable[..., tuple[float, float]]
    collide: Callable[..., None]
    end: Callable[..., None]
    list_pairs: Callable[..., Any]


def pairs_of(model: Model, *, shared: bool) -> Callable[..., None]:
    """Return the pair loop of a model, see `minidem.kernels.contact.pairs.pair_forces_for`."""
    if model.general:
        return pair_forces_general
    return pair_forces_for(model.switches, periodic=model.periodic, shared=shared)


@cache
def alone(model: Model) -> Phases:
    """Return the phases for one thread."""
    pair_forces = pairs_of(model, shared=False)
    wall_forces = wall_forces_for(model.switches, general=model.general)

    @inner
    def divide(scene: Any, lists: Any, flag: int) -> None:
        return

    @inner
    def move(scene: Any, lists: Any, flag: int) -> Any:
        n = scene.control.whole[PARTICLES]
        return kick(0, n, scene.control, scene.parts, scene.posts, flag)

    @inner
    def collide(scene: Any, lists: Any, flag: int) -> None:
        n = scene.control.whole[PARTICLES]
        bodies = Bodies(scene.control, scene.parts, scene.coef)
        update = flag & ADVANCE
        wet = update != 0 and scene.control.whole[WET] == 1
        if not flag & ONLY_WALLS:
            if wet:
                begin_flux(n, scene.parts)
            pair_forces(0, n, bodies, lists.pairs, update, scene.parts.force)
            looked(n, scene.parts.row, scene.control.real)
        if not flag & ONLY_PAIRS:
            wall_forces(0, n, bodies, lists.walls, scene.mesh, update, lists.walls.load)
            if update != 0:
                wear_down(lists.walls.load, lists.walls.mesh.shape[0])
            if wet:
                settle(n, scene.control, scene.parts)

    @inner
    def end(scene: Any, lists: Any, flag: int) -> None:
        second(0, scene.control.whole[PARTICLES], scene.control, scene.parts)

    @inner
    def list_pairs(before: int, tables: Any, lists: Any, spare: Any) -> Any:
        n = tables.more.needs[NEED_COUNT]
        room = spare.pairs.other.shape[0]
        found = pair_list(0, n, 0, room, before, tables, lists.pairs, spare.pairs)
        spare.pairs.start[n] = found
        return found

    return Phases(divide, move, collide, end, list_pairs)
