"""``write_restart``, ``read_restart`` and ``restart``."""

from __future__ import annotations

from collections.abc import Sequence

from minidem.commands.command import COMMANDS
from minidem.run.engine import Engine
from minidem.run.restart import read_restart
from minidem.script import inside
from minidem.words import integer, need


@COMMANDS.register("write_restart")
def _write(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "write_restart FILE")
    engine.world.need_box()
    engine.write_restart(words[0])


@COMMANDS.register("read_restart")
def _read(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "read_restart FILE")
    if engine.world.box is not None:
        msg = "read_restart must come before create_box: the box is in the restart file"
        raise ValueError(msg)
    read_restart(engine.world, inside(engine.world.root, words[0]))
    engine.report.line(f"  {engine.world.state.n} atoms")


@COMMANDS.register("restart")
def _restart(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "restart N FILE")
    every = integer(words[0], "restart")
    if every < 0:
        msg = f"restart: the interval {every} is negative"
        raise ValueError(msg)
    if every == 0:
        engine.world.restarts = None
        return
    need(words, 2, "restart N FILE")
    if len(words) > 2 or "*" not in words[1]:
        msg = "restart: give one file name with '*' for the step"
        raise ValueError(msg)
    inside(engine.world.root, words[1])
    engine.world.restarts = (every, words[1])
