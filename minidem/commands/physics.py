"""Contact models, material values, integrator and body forces."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from minidem.contact.model import parse_model, parse_settings
from minidem.fixes.body import Adapt, CheckTimestep, Integrate, Post, PropertyGlobal
from minidem.fixes.gravity_field import STYLES, GravityField
from minidem.registry import command, fix, integer, need, number, one_of, yes_no
from minidem.run.engine import Engine


@command("pair_style")
def _pair_style(engine: Engine, words: Sequence[str]) -> None:
    need(words, 2, "pair_style gran model hertz tangential history")
    one_of(words[0], ("gran",), "pair style")
    switches, rest = parse_model(words[1:])
    parse_settings(rest, switches)
    engine.world.pair.switches = switches


@command("pair_coeff")
def _pair_coeff(engine: Engine, words: Sequence[str]) -> None:
    if tuple(words[:2]) != ("*", "*"):
        msg = "pair_coeff: only 'pair_coeff * *' makes sense for granular pairs"
        raise ValueError(msg)


@fix("property/global")
def _property(engine: Engine, name: str, style: str, group: str, words: Sequence[str]) -> object:
    need(words, 3, "fix ID all property/global NAME peratomtype VALUES")
    key, kind = words[0], words[1]
    one_of(kind, ("scalar", "vector", "peratomtype", "matrix", "peratomtypepair"), "property style")
    types = max(engine.world.types, 1)
    if kind in ("matrix", "peratomtypepair"):
        columns = integer(words[2], key)
        values = np.array([number(word, key) for word in words[3:]])
        if columns < 1 or len(values) % columns:
            msg = (
                f"property/global {key}: the number of default values must be a multiple of nCols."
            )
            raise ValueError(msg)
        table = values.reshape(-1, columns)
        if kind == "peratomtypepair":
            if columns != types or len(table) != types:
                msg = (
                    f"property/global {key}: {len(values)} values for {columns} columns, but "
                    f"{types} atom types need {types}x{types}"
                )
                raise ValueError(msg)
            if not (table == table.T).all():
                msg = f"property/global {key}: per-atomtype property matrix must be symmetric"
                raise ValueError(msg)
        engine.world.materials.values[key] = table
    else:
        engine.world.materials.values[key] = np.array([number(word, key) for word in words[2:]])
    return PropertyGlobal(name, style, engine.world.bit(group), key)


@fix("nve/sphere")
def _nve(engine: Engine, name: str, style: str, group: str, words: Sequence[str]) -> object:
    del words
    return Integrate(name, style, engine.world.bit(group))


@fix("gravity")
def _gravity(engine: Engine, name: str, style: str, group: str, words: Sequence[str]) -> object:
    need(words, 3, "fix ID all gravity 9.81 vector 0 0 -1")
    way = one_of(words[1], tuple(STYLES), "gravity style")
    count = STYLES[way]
    need(words, 2 + count, f"fix ID all gravity STRENGTH {way} " + "VALUE " * count)
    if len(words) > 2 + count:
        msg = f"gravity {way}: unexpected word '{words[2 + count]}'"
        raise ValueError(msg)
    values = tuple(
        word[2:] if word.startswith("v_") else number(word, "gravity")
        for word in (words[0], *words[2:])
    )
    made = Post(name, style, engine.world.bit(group), 0)
    made.pull = GravityField(way, values)
    if not made.pull.varies:
        made.value[:3] = made.pull.acceleration(engine.world.interpreter.value)
    return made


@fix("viscous")
def _viscous(engine: Engine, name: str, style: str, group: str, words: Sequence[str]) -> object:
    need(words, 1, "fix ID GROUP viscous GAMMA [scale TYPE RATIO]")
    value = np.array([number(words[0], "viscous"), 0.0, 0.0, 0.0])
    made = Post(name, style, engine.world.bit(group), 1, value)
    for at in range(1, len(words), 3):
        one_of(words[at], ("scale",), "fix viscous keyword")
        need(words[at:], 3, "scale TYPE RATIO")
        kind = integer(words[at + 1], "viscous scale")
        if not 1 <= kind <= engine.world.types:
            msg = f"viscous scale: type {kind} is not between 1 and {engine.world.types}"
            raise ValueError(msg)
        if made.per_type is None:
            made.per_type = np.full(engine.world.types, value[0])
        made.per_type[kind - 1] = value[0] * number(words[at + 2], "viscous scale")
    return made


@fix("setforce", "addforce")
def _force(engine: Engine, name: str, style: str, group: str, words: Sequence[str]) -> object:
    need(words, 3, f"fix ID GROUP {style} FX FY FZ [region REGION]")
    value = np.zeros(4)
    variables: list[str | None] = [None, None, None]
    flags = 0
    for c, word in enumerate(words[:3]):
        if word == "NULL" and style == "setforce":
            continue
        flags |= 1 << c
        if word.startswith("v_"):
            variables[c] = word[2:]
        else:
            value[c] = number(word, style)
    kind = 2 if style == "setforce" else 3
    made = Post(name, style, engine.world.bit(group), kind, value, flags, variables)
    _force_options(engine, made, words[3:])
    return made


def _force_options(engine: Engine, made: Post, words: Sequence[str]) -> None:
    """Read ``region ID`` and, for addforce, ``energy v_NAME``."""
    known = ("region", "energy") if made.style == "addforce" else ("region",)
    for at in range(0, len(words), 2):
        key = one_of(words[at], known, f"fix {made.style} keyword")
        need(words[at:], 2, f"{key} {'REGION' if key == 'region' else 'v_NAME'}")
        word = words[at + 1]
        if key == "region":
            made.region = one_of(word, tuple(engine.world.regions), f"region of fix {made.style}")
            continue
        if not word.startswith("v_"):
            msg = f"fix addforce energy: expected a variable v_NAME, found '{word}'"
            raise ValueError(msg)
        if not any(made.variables):
            msg = "Cannot use variable energy with constant force in fix addforce"
            raise ValueError(msg)
        made.energy = word[2:]


@fix("freeze")
def _freeze(engine: Engine, name: str, style: str, group: str, words: Sequence[str]) -> object:
    del words
    return Post(name, style, engine.world.bit(group), 4)


_DRAG = {"factor": 1, "density": 1, "viscosity": 1, "velocity": 3}


@fix("drag/sphere")
def _drag(engine: Engine, name: str, style: str, group: str, words: Sequence[str]) -> object:
    value = np.zeros(8)
    value[0] = 1.0
    rest = list(words)
    seen = set()
    while rest:
        key = one_of(rest[0], tuple(_DRAG), "drag/sphere keyword")
        count = _DRAG[key]
        need(rest, 1 + count, f"drag/sphere ... {key} " + "VALUE " * count)
        at = list(_DRAG).index(key)
        value[at : at + count] = [number(word, key) for word in rest[1 : 1 + count]]
        seen.add(key)
        rest = rest[1 + count :]
    for key in ("density", "viscosity"):
        if key not in seen or not value[list(_DRAG).index(key)] > 0.0:
            msg = f"drag/sphere needs '{key} VALUE' with a value above zero"
            raise ValueError(msg)
    if value[0] < 0.0:
        msg = f"drag/sphere: factor {value[0]:g} is negative; drag may only slow down"
        raise ValueError(msg)
    return Post(name, style, engine.world.bit(group), 5, value)


@fix("check/timestep/gran")
def _check(engine: Engine, name: str, style: str, group: str, words: Sequence[str]) -> object:
    need(words, 3, "fix ID all check/timestep/gran NEVERY FRACTION_R FRACTION_H")
    return CheckTimestep(
        name, style, engine.world.bit(group), max(1, integer(words[0], style)),
        number(words[1], style), number(words[2], style),
    )  # fmt: skip


@fix("adapt")
def _adapt(engine: Engine, name: str, style: str, group: str, words: Sequence[str]) -> object:
    need(words, 4, "fix ID GROUP adapt N atom diameter v_NAME")
    every = integer(words[0], "fix adapt")
    if every < 0:
        msg = f"fix adapt: the interval {every} is negative"
        raise ValueError(msg)
    one_of(words[1], ("atom",), "fix adapt target")
    one_of(words[2], ("diameter",), "fix adapt quantity")
    if not words[3].startswith("v_"):
        msg = f"fix adapt: expected a variable v_NAME, found '{words[3]}'"
        raise ValueError(msg)
    for at in range(4, len(words), 2):
        one_of(words[at], ("reset", "scale"), "fix adapt keyword")
        need(words[at:], 2, f"{words[at]} yes|no")
        yes_no(words[at + 1], f"fix adapt {words[at]}")  # they concern pair coefficients only
    return Adapt(name, style, engine.world.bit(group), every, words[3][2:])
