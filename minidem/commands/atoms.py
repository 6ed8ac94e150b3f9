"""Commands that change and delete particles one by one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from minidem.commands.command import COMMANDS
from minidem.errors import InputError, UnknownWordError
from minidem.kernels.columns import MASS, OMEGA, POSITION, RADIUS, VX, VY, VZ, WX, WY, WZ, X, Y, Z
from minidem.run.engine import Engine
from minidem.words import Words, integer, number
from minidem.world.fix import all_fixes
from minidem.world.momentum import group_mass, remove_drift, remove_turning
from minidem.world.state import Floats
from minidem.world.world import World

_COLUMNS = {"x": X, "y": Y, "z": Z, "vx": VX, "vy": VY, "vz": VZ}
_SPINS = {"omegax": WX, "omegay": WY, "omegaz": WZ}
_SPEEDS = ("vx", "vy", "vz")
_SET = ("density", "diameter", "type", "mass", "property/atom", *_COLUMNS, *_SPINS)


@COMMANDS.register("set")
def _set(engine: Engine, words: Words) -> None:
    words.need(4, "set atom ID KEYWORD VALUE ...")
    world = engine.world
    style = words.choice(("atom", "type", "group", "region"), "style")
    who = _selection(world, style, words.take("an ID"))
    engine.report.screen("Setting atom values ...")
    while not words.done():
        key = words.choice(_SET)
        if key == "property/atom":
            _assign(world, who, words)
            continue
        _apply(world, who, key, words.take(f"a value of '{key}'"))
        world.log(f"  {len(who)} settings made for {key}")


def _selection(world: World, style: str, word: str) -> NDArray[np.int64]:
    """Return the particles that ``set`` or ``delete_atoms`` means."""
    state = world.state
    if style == "group":
        return np.flatnonzero(world.member(world.bit(word)))
    if style == "region":
        if word not in world.regions:
            msg = f"Set region ID '{word}' does not exist"
            raise InputError(msg)
        return np.flatnonzero(world.regions[word].match(state.row[: state.n, POSITION]))
    lo, hi = _bounds(word)
    values = state.ids[: state.n] if style == "atom" else state.kind[: state.n] + 1
    return np.flatnonzero((values >= lo) & (values <= hi))


def _bounds(word: str) -> tuple[int, int]:
    """Read ``5``, ``*``, ``3*``, ``*7`` or ``3*7``."""
    if "*" not in word:
        value = integer(word, "set")
        return value, value
    low, high = word.split("*", 1)
    return (integer(low, "set") if low else 1), (integer(high, "set") if high else 2**62)


def _assign(world: World, who: NDArray[np.int64], words: Words) -> None:
    """Read name and values of a ``fix property/atom`` and give them to some particles."""
    name = words.take("a property")
    if not any(fix.assign(world, name, who, words) for fix in all_fixes(world)):
        msg = f"set property/atom: no fix property/atom has '{name[:40]}'"
        raise InputError(msg)
    world.log(f"  {len(who)} settings made for property/atom")


def _apply(world: World, who: NDArray[np.int64], key: str, word: str) -> None:
    """Change one property of some particles."""
    state = world.state
    values = _values(world, word)
    value = values[who] if isinstance(values, np.ndarray) else np.full(len(who), values)
    if key in _COLUMNS:
        state.row[who, _COLUMNS[key]] = value
    elif key in _SPINS:
        state.spin[who, _SPINS[key]] = value
    elif key == "type":
        kinds = value.astype(np.int64)
        if ((kinds < 1) | (kinds > world.types)).any():
            msg = f"set type: {word} is not between 1 and {world.types}"
            raise InputError(msg)
        state.kind[who] = kinds - 1
    elif key == "mass":
        if (value < 0.0).any():
            msg = f"Invalid mass in set command: {word} is negative"
            raise InputError(msg)
        state.row[who, MASS] = value
    else:
        if key == "diameter":
            state.row[who, RADIUS] = 0.5 * value
        else:
            state.density[who] = value
        radius = state.row[who, RADIUS]
        # left to right, as LIGGGHTS multiplies
        state.row[who, MASS] = 4.0 * np.pi / 3.0 * radius * radius * radius * state.density[who]


def _values(world: World, word: str) -> float | Floats:
    """Return a number, an equal-style or an atom-style variable ``v_NAME``."""
    if not word.startswith("v_"):
        return number(word, "set")
    if world.interpreter.variable_style(word[2:]) == "atom":
        values: Floats = world.interpreter.atom_values(word[2:])
        return values
    return float(world.interpreter.value(word[2:]))


@COMMANDS.register("delete_atoms")
def _delete_atoms(engine: Engine, words: Words) -> None:
    words.need(2, "delete_atoms group ID | region ID")
    world = engine.world
    if words.peek() in ("overlap", "porosity"):
        msg = (
            f"delete_atoms {words.peek()} exists in LIGGGHTS but not in minidem; "
            "use 'group' with a group or 'region' with a region"
        )
        raise UnknownWordError(msg)
    who = _selection(world, words.choice(("group", "region"), "style"), words.take("an ID"))
    before = world.state.n
    _delete(world, who, compress=words.rest()[1:2] != ["no"])
    world.log(f"Deleted {before - world.state.n} atoms, new total = {world.state.n}")


def _delete(world: World, who: NDArray[np.int64], *, compress: bool) -> None:
    """Delete particles; ids become 1..n again unless `compress` is False."""
    state = world.state
    keep = np.ones(state.n, bool)
    keep[who] = False
    order = np.flatnonzero(keep)
    if len(who):
        world.lists.keep_only(keep)
        state.drop_in_passes([~keep])
    state.take(order)
    if compress:
        place = np.argsort(state.rank[: state.n])
        new = dict(zip(state.ids[place].tolist(), range(1, state.n + 1), strict=True))
        state.ids[place] = 1 + np.arange(state.n)
        for one in (*all_fixes(world), *world.computes.values()):
            one.ids_changed(new)
        state.top_id = state.n


@COMMANDS.register("velocity")
def _velocity(engine: Engine, words: Words) -> None:
    words.need(3, "velocity GROUP set VX VY VZ | ramp vx LO HI x LO HI | zero linear")
    world = engine.world
    bit = world.bit(words.take("a group"))
    who = np.flatnonzero(world.member(bit))
    style = words.choice(("set", "ramp", "zero"), "style")
    if style == "zero":
        _zero(world, bit, words.choice(("linear", "angular", "angularIndividual"), "zero"))
    elif style == "set":
        words.need(3, "velocity GROUP set VX VY VZ")
        components = [words.take("a component") for _ in range(3)]
        adds, scale = _read_adding(world, words)
        for c, (key, word) in enumerate(zip(_SPEEDS, components, strict=True)):
            if word != "NULL":
                column = _COLUMNS[key]
                before = world.state.row[who, column] if adds else 0.0
                _apply(world, who, key, word)
                if not word.startswith("v_"):
                    world.state.row[who, column] *= scale[c]
                world.state.row[who, column] += before
    else:
        _ramp(world, who, words)


def _ramp(world: World, who: NDArray[np.int64], words: Words) -> None:
    """Let a component of the velocity change linearly with a coordinate."""
    words.need(6, "velocity GROUP ramp vx LO HI x LO HI")
    component = _SPEEDS.index(words.choice(_SPEEDS, "component"))
    slow, fast = words.numbers(2)
    axis = "xyz".index(words.choice(("x", "y", "z"), "coordinate"))
    low, high = words.numbers(2)
    if low == high:
        msg = f"velocity ramp: the coordinates {low:g} and {high:g} are the same"
        raise InputError(msg)
    adds, scale = _read_adding(world, words)
    row, column = world.state.row, _COLUMNS[_SPEEDS[component]]
    slow, fast = scale[component] * slow, scale[component] * fast
    low, high = scale[axis] * low, scale[axis] * high
    part = np.clip((row[who, X + axis] - low) / (high - low), 0.0, 1.0)
    found = slow + part * (fast - slow)
    row[who, column] = row[who, column] + found if adds else found


def _zero(world: World, bit: int, what: str) -> None:
    """Take the motion of a group as a whole away, or the spin of each of its particles."""
    if what == "angularIndividual":
        world.state.spin[: world.state.n][world.member(bit), OMEGA] = 0.0
        return
    if not world.member(bit).any():
        msg = "Cannot zero momentum of no atoms"
        raise InputError(msg)
    mass = group_mass(world, bit)
    if what == "linear":
        remove_drift(world, bit, mass, np.ones(3))
    else:
        remove_turning(world, bit, mass)


def _read_adding(world: World, words: Words) -> tuple[bool, Floats]:
    """Read options; return whether velocities are added to those there are, and their units."""
    adds, scale = False, np.ones(3)
    while not words.done():
        key = words.choice(("units", "sum", "mom", "rot", "dist", "loop", "rigid"))
        if key == "units":
            if words.choice(("box", "lattice"), key) == "lattice":
                scale = world.lattice.spacing
        elif key == "sum":
            adds = words.yes_no()
        else:
            words.take("a value")  # of styles that draw velocities
    return adds, scale
