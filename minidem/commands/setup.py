"""Commands that set up the simulation: box, units, neighbour lists, groups, regions."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from minidem.commands.command import COMMANDS
from minidem.insertion import make_region
from minidem.run.engine import Engine
from minidem.run.restart import apply_restart
from minidem.words import integer, need, number, one_of, yes_no
from minidem.world.fix import all_fixes
from minidem.world.groups import set_group
from minidem.world.state import Box

_SETTINGS = {
    "atom_style": ("sphere", "granular"),
    "units": ("si", "cgs", "lj"),
    "newton": ("off", "on"),
}


@COMMANDS.register("clear")
def _clear(engine: Engine, words: Sequence[str]) -> None:
    if words:
        msg = f"clear takes no words, found '{words[0]}'"
        raise ValueError(msg)
    engine.clear()


@COMMANDS.register("atom_style")
def _atom_style(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "atom_style granular")
    one_of(words[0], _SETTINGS["atom_style"], "atom style")


@COMMANDS.register("atom_modify")
def _atom_modify(engine: Engine, words: Sequence[str]) -> None:
    i = 0
    while i < len(words):
        word = one_of(words[i], ("map", "sort", "first"), "atom_modify keyword")
        i += 3 if word == "sort" else 2


@COMMANDS.register("boundary")
def _boundary(engine: Engine, words: Sequence[str]) -> None:
    need(words, 3, "boundary f f f")
    found = []
    for word in words[:3]:
        if len(word) > 2 or not set(word) <= set("pfsm"):
            msg = f"boundary: expected p, f, s or m, found '{word}'"
            raise ValueError(msg)
        both = word * 2 if len(word) == 1 else word
        if "p" in both and both != "pp":
            msg = f"boundary '{word}': both faces must be periodic"
            raise ValueError(msg)
        found.append(both)
    engine.world.boundary = tuple(found)


@COMMANDS.register("newton")
def _newton(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "newton off")
    engine.world.newton = one_of(words[0], _SETTINGS["newton"], "newton setting") == "on"


@COMMANDS.register("communicate")
def _communicate(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "communicate single vel yes")
    one_of(words[0], ("single", "multi"), "communicate style")
    for key, value in zip(words[1::2], words[2::2], strict=False):
        if one_of(key, ("vel", "cutoff", "group"), "communicate keyword") == "vel":
            engine.world.ghost_velocity = yes_no(value, "communicate vel")


@COMMANDS.register("units")
def _units(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "units si")
    engine.world.materials.units = one_of(words[0], _SETTINGS["units"], "units")
    if words[0] != "si":
        engine.world.dt = 1e-6 if words[0] == "cgs" else 5e-3


@COMMANDS.register("soft_particles", "hard_particles")
def _softness(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "soft_particles yes")
    flag = yes_no(words[0], engine.current)
    if engine.current == "soft_particles":
        engine.world.materials.soft = flag
    else:
        engine.world.materials.hard = flag


@COMMANDS.register("processors", "modify_timing")
def _ignored(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, f"{engine.current} ...")


@COMMANDS.register("dimension")
def _dimension(engine: Engine, words: Sequence[str]) -> None:
    del engine
    need(words, 1, "dimension 3")
    if words[0] != "3":
        msg = f"dimension {words[0]} is not supported; use 3 and a thin box with planes"
        raise ValueError(msg)


@COMMANDS.register("region")
def _region(engine: Engine, words: Sequence[str]) -> None:
    need(words, 2, "region ID block xlo xhi ylo yhi zlo zhi units box")
    box = engine.world.box
    bounds = None if box is None else np.array([box.lo, box.hi])
    engine.world.regions[words[0]] = make_region(words[1:], engine.world.regions, bounds)


@COMMANDS.register("create_box")
def _create_box(engine: Engine, words: Sequence[str]) -> None:
    need(words, 2, "create_box TYPES REGION")
    world = engine.world
    if world.box is not None:
        msg = "the simulation box exists already"
        raise ValueError(msg)
    region = world.regions.get(words[1])
    if region is None:
        msg = f"Create_box region ID '{words[1]}' does not exist"
        raise ValueError(msg)
    extent = np.asarray(region.extent, float)
    world.types = integer(words[0], "create_box")
    if world.types < 1:
        msg = "create_box: at least one atom type is needed"
        raise ValueError(msg)
    world.box = Box(
        extent[0].copy(), extent[1].copy(), world.boundary, extent[0].copy(), extent[1].copy()
    )


@COMMANDS.register("neighbor")
def _neighbor(engine: Engine, words: Sequence[str]) -> None:
    need(words, 2, "neighbor SKIN bin")
    skin = number(words[0], "neighbor")
    if skin < 0.0:
        msg = f"neighbor: skin {skin} is negative"
        raise ValueError(msg)
    one_of(words[1], ("bin", "multi", "nsq"), "neighbor style")
    engine.world.neighbor.skin = skin


@COMMANDS.register("neigh_modify")
def _neigh_modify(engine: Engine, words: Sequence[str]) -> None:
    near = engine.world.neighbor
    known = (
        "delay", "every", "check", "contact_distance_factor", "page", "one", "binsize", "once",
        "cluster", "include", "exclude",
    )  # fmt: skip
    i = 0
    while i < len(words):
        key = one_of(words[i], known, "neigh_modify keyword")
        need(words[i:], 2, f"neigh_modify {key} VALUE")
        value = words[i + 1]
        if key == "delay":
            near.delay = integer(value, key)
        elif key == "every":
            near.every = max(1, integer(value, key))
        elif key == "check":
            near.check = yes_no(value, key)
        elif key == "contact_distance_factor":
            near.reach = number(value, key)
            if near.reach < 1.0:
                msg = "contact_distance_factor must be at least 1"
                raise ValueError(msg)
        elif key in ("exclude", "include"):
            msg = f"neigh_modify {key} is not supported"
            raise ValueError(msg)
        i += 2


@COMMANDS.register("group")
def _group(engine: Engine, words: Sequence[str]) -> None:
    need(words, 2, "group ID region REGION")
    set_group(engine.world, words[0], words[1], words[2:])


@COMMANDS.register("timestep")
def _timestep(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "timestep DT")
    engine.world.dt = number(words[0], "timestep")


@COMMANDS.register("reset_timestep")
def _reset_timestep(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "reset_timestep STEP")
    world = engine.world
    shift = integer(words[0], "reset_timestep") - world.step
    apply_restart(world, last=False)
    for fix in all_fixes(world):
        fix.steps_shifted(world, shift)
    world.state.shift_flights(shift)
    world.step += shift
