"""``echo`` and ``log``: what goes to screen and log."""

from __future__ import annotations

from minidem.commands.command import COMMANDS
from minidem.run.engine import Engine
from minidem.script import inside
from minidem.words import Words


@COMMANDS.register("echo")
def _echo(engine: Engine, words: Words) -> None:
    engine.report.echo_to(words.choice(("none", "screen", "log", "both"), "target"))


@COMMANDS.register("log")
def _log(engine: Engine, words: Words) -> None:
    words.need(1, "log FILE [append]")
    name = words.take("a file")
    append = not words.done() and words.choice(("append",)) == "append"
    path = None if name == "none" else inside(engine.world.root, name)
    engine.report.open_log(path, append=append)
