"""Commands that set up the simulation: box, units, neighbour lists, groups, regions."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from minidem.commands.bookkeeping import before_box
from minidem.commands.command import COMMANDS
from minidem.errors import InputError, UnknownWordError
from minidem.insertion.region import Site, make_region
from minidem.run.engine import Engine
from minidem.script.names import foreign
from minidem.script.paths import inside
from minidem.words import Words, one_of
from minidem.world.groups import set_group
from minidem.world.periodic import box_text
from minidem.world.settings import UNITS
from minidem.world.state import Box

__all__ = ["read_faces"]


@COMMANDS.register("clear")
def _clear(engine: Engine, words: Words) -> None:
    if not words.done():
        msg = f"clear takes no words, found '{words.peek()}'"
        raise InputError(msg)
    engine.clear()


@COMMANDS.register("boundary")
def _boundary(engine: Engine, words: Words) -> None:
    before_box(engine, "boundary")
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
    if not words.done():
        words.choice(("off", "on"), "setting for bonds")


@COMMANDS.register("communicate")
def _communicate(engine: Engine, words: Words) -> None:
    words.need(1, "communicate single vel yes")
    _refuse_foreign("communicate", words.peek())
    words.choice(("single", "multi"), "style")
    while not words.done():
        if words.choice(("vel", "cutoff", "group")) == "vel":
            engine.world.ghost_velocity = words.yes_no()
        else:
            words.take("a value")


@COMMANDS.register("units")
def _units(engine: Engine, words: Words) -> None:
    before_box(engine, "units")
    words.need(1, "units si")
    engine.world.set_units(words.choice(tuple(UNITS), "value"))


@COMMANDS.register("soft_particles")
def _soft(engine: Engine, words: Words) -> None:
    words.need(1, "soft_particles yes")
    engine.world.materials.soft = words.yes_no()


@COMMANDS.register("hard_particles")
def _hard(engine: Engine, words: Words) -> None:
    words.need(1, "hard_particles yes")
    engine.world.materials.hard = words.yes_no()


@COMMANDS.register("dimension")
def _dimension(engine: Engine, words: Words) -> None:
    before_box(engine, "dimension")
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
        world.regions, bounds, world.lattice.spacing, script.value, lambda: world.step,
        script.variable_style, partial(inside, world.root),
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
    world.log(f"Created {box_text(world.box)}")


@COMMANDS.register("neighbor")
def _neighbor(engine: Engine, words: Words) -> None:
    words.need(2, "neighbor SKIN bin")
    skin = words.number()
    if skin < 0.0:
        msg = f"neighbor: skin {skin} is negative"
        raise InputError(msg)
    if words.choice(("bin", "multi", "nsq"), "style") == "multi":
        engine.world.warn_once(
            "neighbor ... multi: in LIGGGHTS-PUBLIC this finds no neighbours, so that particles "
            "pass through each other; minidem lets them touch, as with 'bin': use 'bin' for both"
        )
    engine.world.neighbor.skin = skin


@COMMANDS.register("neigh_modify")
def _neigh_modify(engine: Engine, words: Words) -> None:
    while not words.done():
        key = words.choice(tuple(_NEIGHBOR))
        words.need(1, f"neigh_modify {key} VALUE")
        _NEIGHBOR[key](engine, words)


def _set_every(engine: Engine, words: Words) -> None:
    engine.world.neighbor.every = words.interval()


def _set_delay(engine: Engine, words: Words) -> None:
    engine.world.neighbor.delay = words.interval(least=0)


def _set_check(engine: Engine, words: Words) -> None:
    engine.world.neighbor.check = words.yes_no()


def _set_page(engine: Engine, words: Words) -> None:
    neighbor = engine.world.neighbor
    neighbor.before["page"], neighbor.page = neighbor.page, words.integer()


def _set_one(engine: Engine, words: Words) -> None:
    neighbor = engine.world.neighbor
    neighbor.before["one"], neighbor.one = neighbor.one, words.integer()


def _set_reach(engine: Engine, words: Words) -> None:
    engine.world.neighbor.reach = words.number()
    if engine.world.neighbor.reach < 1.0:
        msg = "contact_distance_factor must be at least 1"
        raise InputError(msg)


def _pass_over(engine: Engine, words: Words) -> None:
    """Read a number of LIGGGHTS' search."""
    del engine
    words.number()


def _once(engine: Engine, words: Words) -> None:
    del engine
    if words.yes_no():
        msg = (
            "neigh_modify once yes is not supported: in LIGGGHTS grains that meet later pass "
            "through each other, and none is inserted; take it out"
        )
        raise UnknownWordError(msg)


def _include(engine: Engine, words: Words) -> None:
    del engine
    if words.take("a group") != "all":
        msg = "neigh_modify include GROUP is not supported; use neigh_modify exclude group"
        raise UnknownWordError(msg)


def _refuse_cluster(engine: Engine, words: Words) -> None:
    del engine, words
    msg = "neigh_modify cluster is deprecated, in LIGGGHTS as well; take it out"
    raise InputError(msg)


def _exclude(engine: Engine, words: Words) -> None:
    """Read what follows ``neigh_modify exclude``."""
    near = engine.world.neighbor
    key = words.choice(("type", "group", "molecule", "none"), "exclude")
    if key == "none":
        near.no_types, near.no_groups = [], []
    elif key == "type":
        first, second = words.integer(), words.integer()
        if not (1 <= first <= engine.world.types and 1 <= second <= engine.world.types):
            msg = f"exclude type {first} {second}: types go from 1 to {engine.world.types}"
            raise InputError(msg)
        near.no_types.append((first, second))
    elif key == "group":
        bits = [engine.world.bit(words.take("a group")) for _ in range(2)]
        near.no_groups.append((bits[0], bits[1]))
    else:
        msg = "Neigh_modify exclude molecule requires atom attribute molecule, spheres have none"
        raise InputError(msg)


_NEIGHBOR: dict[str, Callable[[Engine, Words], None]] = {
    "delay": _set_delay,
    "every": _set_every,
    "check": _set_check,
    "contact_distance_factor": _set_reach,
    "page": _set_page,
    "one": _set_one,
    "binsize": _pass_over,
    "once": _once,
    "cluster": _refuse_cluster,
    "include": _include,
    "exclude": _exclude,
}


@COMMANDS.register("group")
def _group(engine: Engine, words: Words) -> None:
    words.need(2, "group ID region REGION")
    name = words.take("an ID")
    _refuse_foreign("group", words.peek())
    set_group(engine.world, name, words.take("a style"), words.rest())


def _refuse_foreign(kind: str, word: str) -> None:
    """Refuse a word of LAMMPS with what to write instead."""
    if told := foreign(kind, word):
        raise UnknownWordError(told)
