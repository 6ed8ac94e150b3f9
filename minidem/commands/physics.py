"""Contact models, material values, integrator and body forces."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from minidem.commands.registry import command, fix, integer, need, number, one_of
from minidem.engine import Engine
from minidem.fixes.simple import CheckTimestep, Integrate, Post, PropertyGlobal
from minidem.models import parse_model, parse_settings


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
    need(words, 5, "fix ID all gravity 9.81 vector 0 0 -1")
    strength = number(words[0], "gravity")
    one_of(words[1], ("vector",), "gravity style")
    way = np.array([number(word, "gravity") for word in words[2:5]])
    length = float(np.sqrt(way @ way))
    if length == 0.0:
        msg = "gravity: the vector has no direction"
        raise ValueError(msg)
    value = np.zeros(4)
    value[:3] = strength * way / length
    return Post(name, style, engine.world.bit(group), 0, value)


@fix("viscous")
def _viscous(engine: Engine, name: str, style: str, group: str, words: Sequence[str]) -> object:
    need(words, 1, "fix ID GROUP viscous GAMMA")
    value = np.array([number(words[0], "viscous"), 0.0, 0.0, 0.0])
    return Post(name, style, engine.world.bit(group), 1, value)


@fix("setforce", "addforce")
def _force(engine: Engine, name: str, style: str, group: str, words: Sequence[str]) -> object:
    need(words, 3, f"fix ID GROUP {style} FX FY FZ")
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
    return Post(name, style, engine.world.bit(group), kind, value, flags, variables)


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
