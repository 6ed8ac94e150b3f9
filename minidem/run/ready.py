"""What LIGGGHTS refuses at the start of a run, in its words where there are some."""

from __future__ import annotations

from minidem.errors import InputError
from minidem.kernels.columns import RADIUS
from minidem.world.fix import all_fixes
from minidem.world.world import World

__all__ = ["check_ready"]

_ENTRIES_PER_PAGE = 10  # LIGGGHTS wants room for so many of the longest lists in a page


def check_ready(world: World) -> None:
    """Refuse a run that LIGGGHTS would refuse.

    Raises
    ------
    InputError
        With what is wrong and what to change.
    """
    world.need_box()
    if world.pair.switches is not None and world.newton:
        msg = "Pair granular with shear history requires newton pair off; use 'newton off'"
        raise InputError(msg)
    if not world.ghost_velocity:
        msg = "Pair granular requires ghost atoms store velocity; use 'communicate single vel yes'"
        raise InputError(msg)
    _check_neighbor(world)
    _check_types(world)
    for fix in all_fixes(world):
        fix.check(world)


def _check_neighbor(world: World) -> None:
    """Check the settings of ``neigh_modify`` against each other."""
    near = world.neighbor
    if near.delay % near.every:
        msg = (
            f"Neighbor delay must be 0 or multiple of every setting, found delay {near.delay} "
            f"every {near.every}; change one with neigh_modify"
        )
        raise InputError(msg)
    if near.page < _ENTRIES_PER_PAGE * near.one:
        msg = (
            f"Neighbor page size must be >= {_ENTRIES_PER_PAGE}x the one atom setting, found page "
            f"{near.page} one {near.one}; minidem needs neither, take them out"
        )
        raise InputError(msg)


def _check_types(world: World) -> None:
    """Check the atom types in use, and that there is no particle without a size."""
    state = world.state
    used = [int(kind) + 1 for kind in set(state.kind[: state.n].tolist())]
    for fix in all_fixes(world):
        used += fix.material_types()
    if not used or min(used) != 1:
        msg = (
            "Atom types must start from 1 for granular simulations; no particle, wall or template "
            "has type 1"
        )
        raise InputError(msg)
    if max(used) > world.types:
        msg = (
            "Please increase the number of atom types in the 'create_box' command to match the "
            f"number of atom types you use in the simulation: {max(used)}, not {world.types}"
        )
        raise InputError(msg)
    if not (state.row[: state.n, RADIUS] > 0.0).all():
        msg = "Atom radius must be bigger than zero for granular simulations"
        raise InputError(msg)
