"""``echo`` and ``log``: what goes to screen and log."""

from __future__ import annotations

from collections.abc import Sequence

from minidem.commands.command import COMMANDS
from minidem.run.engine import Engine
from minidem.script import inside
from minidem.words import need, one_of


@COMMANDS.register("echo")
def _echo(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "echo none|screen|log|both")
    engine.report.echo_to(words[0])


@COMMANDS.register("log")
def _log(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "log FILE [append]")
    if len(words) > 1:
        one_of(words[1], ("append",), "log keyword")
    path = None if words[0] == "none" else inside(engine.world.root, words[0])
    engine.report.open_log(path, append=len(words) > 1)
