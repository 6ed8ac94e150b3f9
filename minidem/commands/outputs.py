"""``dump``, ``thermo`` and their modifiers."""

from __future__ import annotations

from collections.abc import Sequence

from minidem.output.dumps import Dump, DumpCustom, DumpStl, DumpVtk
from minidem.output.text import vtk_fields
from minidem.registry import DUMPS, command, dump, integer, need, one_of, yes_no
from minidem.run.engine import Engine

_LOST = ("error", "warn", "ignore")


@command("dump")
def _dump(engine: Engine, words: Sequence[str]) -> None:
    need(words, 5, "dump ID GROUP STYLE N FILE ...")
    name, group, style = words[:3]
    one_of(style, tuple(DUMPS), "dump style")
    if name in engine.world.dumps:
        msg = f"dump ID '{name}' is in use already; 'undump {name}' first"
        raise ValueError(msg)
    engine.world.dumps[name] = DUMPS[style](engine, name, style, group, words[3:])


def _every(name: str, words: Sequence[str]) -> int:
    """Return the interval of a dump, the first word after its style."""
    need(words, 2, "dump ID GROUP STYLE N FILE ...")
    every = integer(words[0], f"dump {name}")
    if every < 1:
        msg = f"dump {name}: the interval {every} is not positive"
        raise ValueError(msg)
    return every


@dump("custom", "custom/vtk")
def _custom(engine: Engine, name: str, style: str, group: str, words: Sequence[str]) -> Dump:
    every = _every(name, words)
    need(words, 3, f"dump ID GROUP {style} N FILE COLUMN ...")
    columns = engine.columns(words[2:])
    if style == "custom":
        return DumpCustom(name, engine.world.bit(group), every, words[1], columns=columns)
    if not words[1].endswith(".vtk"):
        msg = f"dump {name}: file name '{words[1]}' must end in .vtk (XML files are not written)"
        raise ValueError(msg)
    vtk_fields(columns)
    return DumpVtk(name, engine.world.bit(group), every, words[1], columns=columns)


@dump("mesh/stl")
def _stl(engine: Engine, name: str, style: str, group: str, words: Sequence[str]) -> Dump:
    del style
    every = _every(name, words)
    for mesh in words[2:]:
        one_of(mesh, tuple(engine.world.meshes.names), "mesh")
    return DumpStl(name, engine.world.bit(group), every, words[1], meshes=tuple(words[2:]))


@command("dump_modify")
def _dump_modify(engine: Engine, words: Sequence[str]) -> None:
    need(words, 2, "dump_modify ID KEYWORD VALUE")
    found: Dump = engine.world.dumps[one_of(words[0], tuple(engine.world.dumps), "dump")]
    rest = list(words[1:])
    while rest:
        need(rest, 2, f"dump_modify {words[0]} {rest[0]} VALUE")
        rest = rest[1 + found.modify(rest[0], rest[1:]) :]


@command("undump")
def _undump(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "undump ID")
    del engine.world.dumps[one_of(words[0], tuple(engine.world.dumps), "dump")]


@command("thermo")
def _thermo(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "thermo N")
    engine.world.thermo.every = max(0, integer(words[0], "thermo"))


@command("thermo_style")
def _thermo_style(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "thermo_style custom step atoms ke")
    one_of(words[0], ("custom", "one", "multi"), "thermo style")
    thermo = engine.world.thermo
    if words[0] == "custom":
        need(words, 2, "thermo_style custom step atoms ke")
        thermo.columns = engine.thermo_columns(words[1:])
    thermo.lost, thermo.norm = "error", False
    if thermo.modified:
        engine.report.warning(
            "New thermo_style command, previous thermo_modify settings will be lost"
        )
    thermo.modified = False
    engine.report.reset_formats()


@command("thermo_modify")
def _thermo_modify(engine: Engine, words: Sequence[str]) -> None:
    thermo = engine.world.thermo
    known = ("lost", "norm", "flush", "line", "format", "temp", "press", "every")
    thermo.modified = True
    rest = list(words)
    while rest:
        key = one_of(rest[0], known, "thermo_modify keyword")
        need(rest, 2, f"thermo_modify {key} VALUE")
        if key == "lost":
            thermo.lost = one_of(rest[1], _LOST, "thermo_modify lost")
        elif key == "norm":
            thermo.norm = yes_no(rest[1], "thermo_modify norm")
        elif key == "flush":
            thermo.flush = yes_no(rest[1], "thermo_modify flush")
        elif key == "format":
            need(rest, 3, "thermo_modify format WHICH FORMAT")
            engine.report.thermo_format(thermo.columns, rest[1], rest[2])
            rest = rest[1:]
        rest = rest[2:]
