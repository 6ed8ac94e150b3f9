"""``write_restart``, ``read_restart`` and ``restart``."""

from __future__ import annotations

from minidem.commands.command import COMMANDS
from minidem.errors import InputError, MistakeError
from minidem.run.engine import Engine
from minidem.run.restarts.restart import read_restart
from minidem.script import inside
from minidem.words import Words
from minidem.world.periodic import box_text
from minidem.world.settings import Schedule


@COMMANDS.register("write_restart")
def _write(engine: Engine, words: Words) -> None:
    words.need(1, "write_restart FILE")
    engine.world.need_box()
    name = words.take("a file")
    if not words.done():
        msg = f"write_restart takes one file, found '{words.peek()[:40]}' behind it"
        raise MistakeError(msg)
    engine.write_restart(name)


@COMMANDS.register("read_restart")
def _read(engine: Engine, words: Words) -> None:
    words.need(1, "read_restart FILE")
    world = engine.world
    if world.box is not None:
        msg = "read_restart must come before create_box: the box is in the restart file"
        raise InputError(msg)
    read_restart(world, words.take("a file"))
    world.log(f"  {box_text(world.need_box())}")
    engine.report.line(f"  {world.state.n} atoms")


@COMMANDS.register("restart")
def _restart(engine: Engine, words: Words) -> None:
    words.need(1, "restart N FILE [FILE2]")
    schedule = Schedule.read(words, least=0)
    if not (schedule.every or schedule.variable):
        engine.world.restarts = engine.world.restart_turns = None
        return
    words.need(1, "restart N FILE")
    name = words.take("a file")
    if not words.done():
        turns = [name, words.take("a second file")]
        for one in turns:
            inside(engine.world.root, one)
        engine.world.restart_turns = (schedule, turns)
        return
    if "*" not in name:
        name += ".*"
    inside(engine.world.root, name)
    engine.world.restarts = (schedule, name)
