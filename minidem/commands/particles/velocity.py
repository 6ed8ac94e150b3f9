"""``velocity GROUP STYLE ...``: velocities and spins of particles that are there."""

from __future__ import annotations

import numpy as np

from minidem.commands.atoms import assign
from minidem.commands.command import COMMANDS
from minidem.errors import InputError, NoParticlesError, UnknownWordError
from minidem.kernels.columns import OMEGA, VX
from minidem.run.engine import Engine
from minidem.words import Words
from minidem.world.momentum import group_mass, remove_drift, remove_turning
from minidem.world.state import Floats, Ints
from minidem.world.world import World

_AXES = ("x", "y", "z")
_SPEEDS = ("vx", "vy", "vz")


@COMMANDS.register("velocity")
def _velocity(engine: Engine, words: Words) -> None:
    words.need(3, "velocity GROUP set VX VY VZ | ramp ... | zero linear")
    world = engine.world
    bit = world.bit(words.take("a group"))
    who = np.flatnonzero(world.member(bit))
    style = words.choice(("set", "setAngular", "ramp", "zero"), "style")
    if style == "zero":
        _zero(world, bit, words.choice(("linear", "angular", "angularIndividual"), "zero"))
    elif style == "ramp":
        _ramp(world, who, words)
    else:
        if style == "setAngular":
            msg = "velocity setAngular: spheres have a spin; use 'set group ID omegax W' and so on"
            raise UnknownWordError(msg)
        _set(world, who, words)


def _set(world: World, who: Ints, words: Words) -> None:
    """Read three components and give them to particles."""
    words.need(3, "velocity GROUP set VX VY VZ")
    components = [words.take("a component") for _ in range(3)]
    scale, add = _options(world, words)
    row = world.state.row
    for axis, (key, word) in enumerate(zip(_SPEEDS, components, strict=True)):
        if word == "NULL":
            continue
        before = row[who, VX + axis].copy()
        assign(world, who, key, word)
        if not word.startswith("v_"):
            row[who, VX + axis] *= scale[axis]
        if add:
            row[who, VX + axis] += before


def _ramp(world: World, who: Ints, words: Words) -> None:
    """Read and set velocities that grow along a direction."""
    words.need(6, "velocity GROUP ramp vx LOW HIGH x LOW HIGH")
    column = _SPEEDS.index(words.choice(_SPEEDS, "component"))
    low, high = words.numbers(2)
    axis = _AXES.index(words.choice(_AXES, "axis"))
    start, end = words.numbers(2)
    scale, add = _options(world, words)
    start, end = float(scale[axis]) * start, float(scale[axis]) * end
    if start == end:
        msg = f"velocity ramp: both coordinates are {start:g}"
        raise InputError(msg)
    row = world.state.row
    part = np.clip((row[who, axis] - start) / (end - start), 0.0, 1.0)
    low, high = float(scale[column]) * low, float(scale[column]) * high
    wanted = low + part * (high - low)
    row[who, VX + column] = wanted + (row[who, VX + column] if add else 0.0)


def _zero(world: World, bit: int, what: str) -> None:
    """Take the motion of a group as a whole away, or the spin of each of its particles."""
    if what == "angularIndividual":
        world.state.spin[: world.state.n][world.member(bit), OMEGA] = 0.0
        return
    if not world.member(bit).any():
        msg = "Cannot zero momentum of no atoms"
        raise NoParticlesError(msg)
    mass = group_mass(world, bit)
    if what == "linear":
        remove_drift(world, bit, mass, np.ones(3))
    else:
        remove_turning(world, bit, mass)


def _options(world: World, words: Words) -> tuple[Floats, bool]:
    """Read options; return box units per unit of the numbers, and whether to add to what is."""
    scale, add = np.ones(3), False
    while not words.done():
        key = words.choice(("units", "sum", "dist", "mom", "rot", "loop"))
        if key == "units":
            if words.choice(("box", "lattice"), key) == "lattice":
                scale = world.lattice.spacing
        elif key == "sum":
            add = words.yes_no()
        else:
            words.take("a value")  # of styles that spheres do not have
    return scale, add
