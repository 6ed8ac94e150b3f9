"""``atom_style``, ``atom_modify``, and ``set``: properties of particles that are there."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from minidem.commands.bookkeeping import before_box
from minidem.commands.command import COMMANDS
from minidem.errors import InputError
from minidem.insertion.seeds import drawn_at
from minidem.kernels.columns import MASS, POSITION, RADIUS, VX, VY, VZ, WX, WY, WZ, X, Y, Z
from minidem.run.engine import Engine
from minidem.words import Words, integer, number
from minidem.world.fix import all_fixes
from minidem.world.state import Floats
from minidem.world.world import World

_COLUMNS = {"x": X, "y": Y, "z": Z, "vx": VX, "vy": VY, "vz": VZ}
_SPINS = {"omegax": WX, "omegay": WY, "omegaz": WZ}
_SET = (
    "density", "diameter", "type", "type/fraction", "mass", "image", "property/atom", *_COLUMNS,
    *_SPINS,
)  # fmt: skip

__all__ = ["assign", "selection"]

_SPHERES = ("sphere", "granular")
"""Styles of atoms with radius and density: two names for one thing."""


@COMMANDS.register("atom_style")
def _atom_style(engine: Engine, words: Words) -> None:
    before_box(engine, "atom_style")
    words.need(1, "atom_style granular")
    style = words.choice((*_SPHERES, "hybrid"), "value")
    engine.world.granular = True
    engine.world.hybrid = _read_hybrid(words) if style == "hybrid" else 0


def _read_hybrid(words: Words) -> int:
    """Read the styles of ``atom_style hybrid``; return how many of them are those of spheres."""
    styles: list[str] = []
    while not words.done():
        if words.peek() not in (*_SPHERES, "atomic"):
            msg = (
                f"atom_style hybrid: '{words.peek()[:40]}' is not in minidem (known: sphere, "
                "granular, atomic): spheres have no bonds, charges or other shapes; leave it out"
            )
            raise InputError(msg)
        styles.append(words.take("a style"))
    if len(set(styles)) < len(styles):
        msg = "Atom style hybrid cannot use same atom style twice"
        raise InputError(msg)
    found = sum(style in _SPHERES for style in styles)
    if not found:
        msg = "atom_style hybrid: neither sphere nor granular; write 'atom_style granular'"
        raise InputError(msg)
    return found


@COMMANDS.register("atom_modify")
def _atom_modify(engine: Engine, words: Words) -> None:
    world = engine.world
    while not words.done():
        key = words.choice(("map", "sort", "first"))
        if key == "map":
            world.atom_map = words.choice(("array", "hash"), key)
            before_box(engine, "atom_modify map")
        elif key == "sort":
            words.need(2, "atom_modify sort N SIZE")
            world.sorting.every = words.interval(least=0)
            world.sorting.size = words.number()
            if world.sorting.size < 0.0:
                msg = f"atom_modify sort: SIZE {world.sorting.size:g} is negative; 0 chooses one"
                raise InputError(msg)
        else:
            words.take("a group")
            world.sorting.every = 0


@COMMANDS.register("set")
def _set(engine: Engine, words: Words) -> None:
    words.need(4, "set atom ID KEYWORD VALUE ...")
    world = engine.world
    style = words.choice(("atom", "type", "group", "region"), "style")
    who = selection(world, style, words.take("an ID"))
    engine.report.screen("Setting atom values ...")
    while not words.done():
        key = words.choice(_SET)
        if key == "property/atom":
            _assign(world, who, words)
            continue
        if key in ("image", "type/fraction"):
            count = _turn(world, who, words) if key == "image" else _mix(world, who, words)
            world.log(f"  {count} settings made for {key}")
            continue
        assign(world, who, key, words.take(f"a value of '{key}'"))
        world.log(f"  {len(who)} settings made for {key}")


def selection(world: World, style: str, word: str) -> NDArray[np.int64]:
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


def _turn(world: World, who: NDArray[np.int64], words: Words) -> int:
    """Read how often particles have crossed periodic faces; return how many were set."""
    box = world.need_box()
    for axis in range(3):
        if words.peek() == "NULL":
            words.take("NULL")
            continue
        turns = words.integer()
        if turns and box.boundary[axis] != "pp":
            msg = f"set image: direction {'xyz'[axis]} is not periodic, so that only 0 is possible"
            raise InputError(msg)
        world.state.image[who, axis] = turns
    return len(who)


def _mix(world: World, who: NDArray[np.int64], words: Words) -> int:
    """Give a part of the particles another type; return how many."""
    kind, part, seed = words.integer(), words.number(), words.integer()
    if not (1 <= kind <= world.types and 0.0 <= part <= 1.0 and seed > 0):
        msg = (
            f"set type/fraction: type {kind} must be from 1 to {world.types}, the fraction "
            f"{part:g} from 0 to 1 and the seed {seed} above 0"
        )
        raise InputError(msg)
    row = world.state.row
    chosen = [i for i in who.tolist() if not drawn_at(seed, row[i, POSITION], 1)[0] > part]
    world.state.kind[chosen] = kind - 1
    return len(chosen)


def assign(world: World, who: NDArray[np.int64], key: str, word: str) -> None:
    """Change one property of some particles, given as a number or variable."""
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
