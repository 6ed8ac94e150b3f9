"""Commands that set up the simulation: box, units, neighbour lists, groups, regions."""

from __future__ import annotations

from functools import partial

import numpy as np

from minidem.commands.command import COMMANDS
from minidem.errors import InputError, UnknownWordError
from minidem.insertion import Site, make_region
from minidem.run.engine import Engine
from minidem.run.restart import apply_restart
from minidem.script.paths import inside
from minidem.words import Words, one_of
from minidem.world.fix import all_fixes
from minidem.world.groups import set_group
from minidem.world.state import Box

__all__ = ["read_faces"]

_DT = {"si": None, "cgs": 1e-6, "lj": 5e-3}  # time step that ``units`` sets, s


@COMMANDS.register("clear")
def _clear(engine: Engine, words: Words) -> None:
    if not words.done():
        msg = f"clear takes no words, found '{words.peek()}'"
        raise InputError(msg)
    engine.clear()


def _before_box(engine: Engine, command: str) -> None:
    """Refuse a command that stands behind ``create_box``."""
    if engine.world.box is not None:
        msg = f"{command} command after simulation box is defined; move it before create_box"
        raise InputError(msg)


@COMMANDS.register("atom_style")
def _atom_style(engine: Engine, words: Words) -> None:
    _before_box(engine, "atom_style")
    words.need(1, "atom_style granular")
    words.choice(("sphere", "granular"), "value")


@COMMANDS.register("atom_modify")
def _atom_modify(engine: Engine, words: Words) -> None:
    del engine
    while not words.done():
        key = words.choice(("map", "sort", "first"))
        for _ in range(2 if key == "sort" else 1):
            words.take("a value")


@COMMANDS.register("boundary")
def _boundary(engine: Engine, words: Words) -> None:
    _before_box(engine, "boundary")
    engine.world.boundary = read_faces(words)


def read_faces(words: Words) -> tuple[str, ...]:
    """Read the boundaries of three directions, two letters each."""
    words.need(3, "boundary f f f")
    found = []
    for _ in range(3):
        word = words.take("a boundary")
        if not 1 <= len(word) <= 2 or not set(word) <= set("pfsm"):
            msg = f"boundary: expected p, f, s or m, found '{word}'"
            raise InputError(msg)
        both = word * 2 if len(word) == 1 else word
        if "p" in both and both != "pp":
            msg = f"boundary '{word}': both faces must be periodic"
            raise InputError(msg)
        found.append(both)
    return tuple(found)


@COMMANDS.register("newton")
def _newton(engine: Engine, words: Words) -> None:
    words.need(1, "newton off")
    engine.world.newton = words.choice(("off", "on"), "setting") == "on"


@COMMANDS.register("communicate")
def _communicate(engine: Engine, words: Words) -> None:
    words.need(1, "communicate single vel yes")
    words.choice(("single", "multi"), "style")
    while not words.done():
        if words.choice(("vel", "cutoff", "group")) == "vel":
            engine.world.ghost_velocity = words.yes_no()
        else:
            words.take("a value")


@COMMANDS.register("units")
def _units(engine: Engine, words: Words) -> None:
    _before_box(engine, "units")
    words.need(1, "units si")
    units = words.choice(tuple(_DT), "value")
    engine.world.materials.units = units
    engine.world.dt = _DT[units] or engine.world.dt


@COMMANDS.register("soft_particles")
def _soft(engine: Engine, words: Words) -> None:
    words.need(1, "soft_particles yes")
    engine.world.materials.soft = words.yes_no()


@COMMANDS.register("hard_particles")
def _hard(engine: Engine, words: Words) -> None:
    words.need(1, "hard_particles yes")
    engine.world.materials.hard = words.yes_no()


@COMMANDS.register("processors")
def _processors(engine: Engine, words: Words) -> None:
    _before_box(engine, "processors")
    words.take("a value")
    words.rest()


@COMMANDS.register("modify_timing")
def _modify_timing(engine: Engine, words: Words) -> None:
    del engine
    words.take("a value")
    words.rest()


@COMMANDS.register("dimension")
def _dimension(engine: Engine, words: Words) -> None:
    _before_box(engine, "dimension")
    words.need(1, "dimension 3")
    word = words.take("3")
    if word != "3":
        msg = f"dimension {word} is not supported; use 3 and a thin box with planes"
        raise UnknownWordError(msg)


@COMMANDS.register("region")
def _region(engine: Engine, words: Words) -> None:
    words.need(2, "region ID block xlo xhi ylo yhi zlo zhi units box")
    name, world = words.take("an ID"), engine.world
    if words.peek() == "delete":
        words.take("delete")
        del world.regions[one_of(name, tuple(world.regions), "region ID")]
        return
    if name in world.regions:
        msg = f"Reuse of region ID '{name}'; choose another ID"
        raise InputError(msg)
    bounds = None if world.box is None else np.array([world.box.lo, world.box.hi])
    script = world.interpreter
    site = Site(
        world.regions, bounds, world.lattice.spacing, script.value, script.variable_style,
        partial(inside, world.root),
    )  # fmt: skip
    world.regions[name] = make_region(words.rest(), site)


@COMMANDS.register("create_box")
def _create_box(engine: Engine, words: Words) -> None:
    words.need(2, "create_box TYPES REGION")
    world = engine.world
    if world.box is not None:
        msg = "the simulation box exists already"
        raise InputError(msg)
    types, name = words.integer(), words.take("a region")
    region = world.regions.get(name)
    if region is None:
        msg = f"Create_box region ID '{name}' does not exist"
        raise InputError(msg)
    if types < 1:
        msg = "create_box: at least one atom type is needed"
        raise InputError(msg)
    world.types = types
    if region.extent is None or region.is_prism():
        msg = (
            "create_box: the region must be a block or have a bounding box that is one; prisms, "
            "planes and regions with side out do not"
        )
        raise InputError(msg)
    lo, hi = np.asarray(region.extent, float)
    world.box = Box(lo.copy(), hi.copy(), world.boundary, lo.copy(), hi.copy())


@COMMANDS.register("neighbor")
def _neighbor(engine: Engine, words: Words) -> None:
    words.need(2, "neighbor SKIN bin")
    skin = words.number()
    if skin < 0.0:
        msg = f"neighbor: skin {skin} is negative"
        raise InputError(msg)
    words.choice(("bin", "multi", "nsq"), "style")
    engine.world.neighbor.skin = skin


_NEIGHBOR_KEYWORDS = (
    "delay", "every", "check", "contact_distance_factor", "page", "one", "binsize", "once",
    "cluster", "include", "exclude",
)  # fmt: skip


@COMMANDS.register("neigh_modify")
def _neigh_modify(engine: Engine, words: Words) -> None:
    near = engine.world.neighbor
    while not words.done():
        key = words.choice(_NEIGHBOR_KEYWORDS)
        words.need(1, f"neigh_modify {key} VALUE")
        if key == "delay":
            near.delay = words.interval(least=0)
        elif key == "every":
            near.every = words.interval()
        elif key == "check":
            near.check = words.yes_no()
        elif key == "contact_distance_factor":
            near.reach = words.number()
            if near.reach < 1.0:
                msg = "contact_distance_factor must be at least 1"
                raise InputError(msg)
        elif key == "page":
            near.page = words.integer()
        elif key == "one":
            near.one = words.integer()
        elif key in ("exclude", "include", "cluster"):
            msg = f"neigh_modify {key} is not supported"
            raise InputError(msg)
        else:
            words.take("a value")


@COMMANDS.register("group")
def _group(engine: Engine, words: Words) -> None:
    words.need(2, "group ID region REGION")
    set_group(engine.world, words.take("an ID"), words.take("a style"), words.rest())


@COMMANDS.register("timestep")
def _timestep(engine: Engine, words: Words) -> None:
    words.need(1, "timestep DT")
    # LIGGGHTS takes any number; with zero nothing moves, below it energy comes from nowhere
    engine.world.dt = words.positive()


@COMMANDS.register("reset_timestep")
def _reset_timestep(engine: Engine, words: Words) -> None:
    words.need(1, "reset_timestep STEP")
    world = engine.world
    shift = words.interval(least=0) - world.step
    apply_restart(world, last=False)
    for fix in all_fixes(world):
        fix.steps_shifted(world, shift)
    world.state.shift_flights(shift)
    world.step += shift
