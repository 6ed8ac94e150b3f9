"""``dump``, ``write_dump``, ``write_data``, ``thermo`` and their modifiers.

The dump styles are in `minidem.output`.
"""

from __future__ import annotations

from minidem.commands.command import COMMANDS
from minidem.errors import MistakeError
from minidem.output.dump import DUMPS, Dump
from minidem.output.quantities import check_keywords
from minidem.registry import Head
from minidem.run.engine import Engine
from minidem.script import inside
from minidem.words import Words
from minidem.world.settings import USUAL, Schedule
from minidem.world.values.named import need_names

_LOST = ("error", "warn", "ignore")
_MODIFIED = ("lost", "norm", "flush", "line", "format")


@COMMANDS.register("dump")
def _dump(engine: Engine, words: Words) -> None:
    words.need(5, "dump ID GROUP STYLE N FILE ...")
    world = engine.world
    name, group, style = words.take("an ID"), words.take("a group"), words.take("a style")
    made = DUMPS.find(style)
    if name in world.dumps:
        msg = f"dump ID '{name}' is in use already; 'undump {name}' first"
        raise MistakeError(msg)
    head = Head(name, style, world.bit(group))
    words = Words(words.rest(), f"dump {name}")
    world.dumps[name] = made.read(world, head, words)
    words.finish()


@COMMANDS.register("dump_modify")
def _dump_modify(engine: Engine, words: Words) -> None:
    words.need(2, "dump_modify ID KEYWORD VALUE")
    found: Dump = engine.world.dumps[words.choice(tuple(engine.world.dumps), "ID")]
    while not words.done():
        key = words.choice(found.keywords)
        words.need(1, f"dump_modify {found.name} {key} VALUE")
        found.modify(key, words)


@COMMANDS.register("write_dump")
def _write_dump(engine: Engine, words: Words) -> None:
    words.need(3, "write_dump GROUP STYLE FILE ... [modify KEYWORD VALUE ...]")
    world = engine.world
    group, style = words.take("a group"), words.take("a style")
    rest = words.rest()
    at = rest.index("modify") if "modify" in rest else len(rest)
    given = Words(["1", *rest[:at]], "write_dump")
    made = DUMPS.find(style).read(world, Head("WRITE_DUMP", style, world.bit(group)), given)
    given.finish()
    words = Words(rest[at + 1 :], "write_dump modify")
    while not words.done():
        key = words.choice(made.keywords)
        words.need(1, f"write_dump ... modify {key} VALUE")
        made.modify(key, words)
    inside(world.root, made.path)
    engine.write_dump(made)


@COMMANDS.register("write_data")
def _write_data(engine: Engine, words: Words) -> None:
    from minidem.output.data_file import check_columns_of_file  # few scripts write one

    words.need(1, "write_data FILE [pair ii|ij] [tag_offset N]")
    world = engine.world
    world.need_box()
    check_columns_of_file(world, "write_data")
    name, shift = words.take("a file"), 0
    inside(world.root, name)
    while not words.done():
        if words.choice(("pair", "tag_offset")) == "pair":
            words.choice(("ii", "ij"), "pair")
        else:
            shift = words.interval(least=0)
    engine.write_data(name, shift)


@COMMANDS.register("undump")
def _undump(engine: Engine, words: Words) -> None:
    words.need(1, "undump ID")
    del engine.world.dumps[words.choice(tuple(engine.world.dumps), "ID")]


@COMMANDS.register("thermo")
def _thermo(engine: Engine, words: Words) -> None:
    words.need(1, "thermo N")
    thermo, new = engine.world.thermo, Schedule.read(words, least=0)
    old = thermo.schedule
    if old.variable and not new.variable:
        engine.report.warning(
            f"thermo {new.every} has no effect, as in LIGGGHTS 3.8.0: variable '{old.variable}' "
            "says when lines come; let another variable say it, e.g. stride(N,1000000000,N)"
        )
        return
    thermo.schedule = new


@COMMANDS.register("thermo_style")
def _thermo_style(engine: Engine, words: Words) -> None:
    words.need(1, "thermo_style custom step atoms ke")
    thermo = engine.world.thermo
    style = words.choice(("custom", "one", "multi"), "style")
    thermo.custom, thermo.several = style == "custom", style == "multi"
    if thermo.custom:
        words.need(1, "thermo_style custom step atoms ke")
        columns = check_keywords(words.rest())
        need_names(engine.world, "thermo_style custom", columns, per_atom=False)
        thermo.columns = columns
    else:
        words.rest()
        thermo.columns = USUAL
    thermo.lost, thermo.warned, thermo.norm = "ignore", False, None
    if thermo.modified:
        engine.report.warning(
            "New thermo_style command, previous thermo_modify settings will be lost"
        )
    thermo.modified = False
    engine.report.reset_formats()


@COMMANDS.register("thermo_modify")
def _thermo_modify(engine: Engine, words: Words) -> None:
    words.need(1, "thermo_modify KEYWORD VALUE")
    thermo = engine.world.thermo
    thermo.modified = True
    while not words.done():
        key = words.choice(_MODIFIED)
        words.need(1, f"thermo_modify {key} VALUE")
        if key == "lost":
            thermo.lost = words.choice(_LOST, key)
        elif key == "norm":
            thermo.norm = words.yes_no()
        elif key == "flush":
            thermo.flush = words.yes_no()
        elif key == "format":
            words.need(2, "thermo_modify format WHICH FORMAT")
            which = words.take("a column")
            engine.report.thermo_format(thermo.columns, which, words.take("a format"))
        else:
            thermo.several = words.choice(("one", "multi"), key) == "multi"
