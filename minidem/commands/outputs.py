"""``dump``, ``thermo`` and their modifiers."""

from __future__ import annotations

from collections.abc import Sequence

from minidem.commands.command import COMMANDS
from minidem.output.dump import DUMPS, Dump
from minidem.output.quantities import check_keywords
from minidem.registry import Head
from minidem.run.engine import Engine
from minidem.words import Words, integer, need, one_of, yes_no

_LOST = ("error", "warn", "ignore")


@COMMANDS.register("dump")
def _dump(engine: Engine, words: Sequence[str]) -> None:
    need(words, 5, "dump ID GROUP STYLE N FILE ...")
    name, group, style = words[:3]
    world = engine.world
    made = DUMPS.find(style)
    if name in world.dumps:
        msg = f"dump ID '{name}' is in use already; 'undump {name}' first"
        raise ValueError(msg)
    head = Head(name, style, world.bit(group))
    world.dumps[name] = made.read(world, head, Words(words[3:], f"dump {name}"))


@COMMANDS.register("dump_modify")
def _dump_modify(engine: Engine, words: Sequence[str]) -> None:
    need(words, 2, "dump_modify ID KEYWORD VALUE")
    found: Dump = engine.world.dumps[one_of(words[0], tuple(engine.world.dumps), "dump")]
    rest = list(words[1:])
    while rest:
        need(rest, 2, f"dump_modify {words[0]} {rest[0]} VALUE")
        rest = rest[1 + found.modify(rest[0], rest[1:]) :]


@COMMANDS.register("undump")
def _undump(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "undump ID")
    del engine.world.dumps[one_of(words[0], tuple(engine.world.dumps), "dump")]


@COMMANDS.register("thermo")
def _thermo(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "thermo N")
    engine.world.thermo.every = max(0, integer(words[0], "thermo"))


@COMMANDS.register("thermo_style")
def _thermo_style(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "thermo_style custom step atoms ke")
    one_of(words[0], ("custom", "one", "multi"), "thermo style")
    thermo = engine.world.thermo
    if words[0] == "custom":
        need(words, 2, "thermo_style custom step atoms ke")
        thermo.columns = check_keywords(words[1:])
    thermo.lost, thermo.norm = "error", False
    if thermo.modified:
        engine.report.warning(
            "New thermo_style command, previous thermo_modify settings will be lost"
        )
    thermo.modified = False
    engine.report.reset_formats()


@COMMANDS.register("thermo_modify")
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
