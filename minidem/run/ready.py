"""What LIGGGHTS refuses at the start of a run, in its words where there are some."""

from __future__ import annotations

import numpy as np

from minidem.contact.coefficients import coefficient_table
from minidem.errors import InputError, MissingValueError, suggest
from minidem.fixes.facets import wear_coefficients
from minidem.fixes.property_global import check_counts
from minidem.fixes.wall import used_models
from minidem.kernels.columns import RADIUS
from minidem.record import replace
from minidem.words import variables_in
from minidem.world.fix import all_fixes
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["check_ready", "check_settings", "check_values", "contact_table"]

_MOST_TYPES = 100  # atom types for which values are made up
_USUAL = {"youngsModulus": 5e6, "poissonsRatio": 0.3}  # values within limits; 1 is for all others
_NO_STYLE = "no pair style is defined; give 'pair_style gran model hertz tangential history'"
_ENTRIES_PER_PAGE = 10  # LIGGGHTS wants room for so many of the longest lists in a page


def check_ready(world: World) -> None:
    """Refuse a run that LIGGGHTS would refuse.

    Raises
    ------
    InputError
        With what is wrong and what to change.
    """
    check_settings(world)
    _check_pairs(world)
    _check_types(world)
    for fix in all_fixes(world):
        fix.check(world)


def check_settings(world: World) -> None:
    """Refuse settings with which no run starts, whatever particles there are.

    Raises
    ------
    InputError
        With what is wrong and what to change.
    """
    world.need_box()
    if not world.granular:
        msg = "Pair granular requires atom attributes radius, rmass; use 'atom_style granular'"
        raise InputError(msg)
    if world.pair.switches is not None and world.newton:
        msg = "Pair granular with shear history requires newton pair off; use 'newton off'"
        raise InputError(msg)
    if not world.ghost_velocity:
        msg = "Pair granular requires ghost atoms store velocity; use 'communicate single vel yes'"
        raise InputError(msg)
    _check_neighbor(world)
    _check_variables(world)


def contact_table(world: World) -> Floats:
    """Return the coefficients of all contact models in use, shape (types**2, columns).

    Raises
    ------
    InputError
        Without pair style, or if a value of the material is missing or out of its limits.
    """
    if world.pair.switches is None:
        raise InputError(_NO_STYLE)
    coefficients = coefficient_table(world.materials, world.types, used_models(world))
    wear_coefficients(world, coefficients)
    return coefficients


def check_values(world: World) -> None:
    """Refuse contact models whose values are not there, all of them at once.

    Raises
    ------
    MissingValueError
        With a line for each value that is missing.
    InputError
        As `contact_table`, if none is missing.
    """
    given, found = world.materials, list[MissingValueError]()
    world.materials = replace(given, values=dict(given.values))
    try:
        _check_pairs(world)
    except MissingValueError as err:
        found.append(err)
    try:
        check_counts(world)
        while world.types <= _MOST_TYPES:
            try:
                contact_table(world)
            except MissingValueError as err:
                found.append(err)
                count = world.types if err.name in _USUAL else world.types**2
                world.materials.values[err.name] = np.full(count, _USUAL.get(err.name, 1.0))
                continue
            except InputError:
                if not found:
                    raise
            break
    finally:
        world.materials = given
    if found:
        first, *_ = found
        raise MissingValueError("\n".join(map(str, found)), first.name)


def _check_pairs(world: World) -> None:
    """Check that there is a pair style, and a ``pair_coeff`` behind it."""
    if world.pair.switches is None:
        raise MissingValueError(_NO_STYLE, "pair_style")
    if not world.pair.covers(world.types):
        msg = "All pair coeffs are not set; give 'pair_coeff * *' behind pair_style"
        raise MissingValueError(msg, "pair_coeff")


def _check_variables(world: World) -> None:
    """Refuse words ``v_NAME`` without such a variable, which a run would ask in some step."""
    asked = [
        (f"{kind} {one.name}", one.variables_asked())
        for kind, known in (
            ("fix", world.fixes), ("compute", world.computes), ("dump", world.dumps),
        )
        for one in known.values()
    ]  # fmt: skip
    asked.append(("thermo_style", variables_in(world.thermo.columns)))
    asked.append(("thermo", world.thermo.schedule.asked()))
    for written in (world.restarts, world.restart_turns):
        if written is not None:
            asked.append(("restart", written[0].asked()))
    for what, names in asked:
        for name in names:
            if world.interpreter.variable_style(name) is None:
                near = suggest(name, world.interpreter.variable_styles())
                msg = f"{what}: there is no variable '{name[:40]}'{near}; define it before the run"
                raise InputError(msg)


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
