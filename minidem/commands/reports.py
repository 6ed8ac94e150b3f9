"""``echo``, ``log`` and ``thermo_log``: what goes to screen and log."""

from __future__ import annotations

from pathlib import Path

from minidem.commands.command import COMMANDS
from minidem.run.engine import Engine
from minidem.script import inside
from minidem.words import Words


@COMMANDS.register("echo")
def _echo(engine: Engine, words: Words) -> None:
    engine.report.echo_to(words.choice(("none", "screen", "log", "both"), "target"))


@COMMANDS.register("log")
def _log(engine: Engine, words: Words) -> None:
    path, append = _target(engine, words)
    engine.report.open_log(path, append=append)


@COMMANDS.register("thermo_log")
def _thermo_log(engine: Engine, words: Words) -> None:
    path, append = _target(engine, words)
    engine.report.open_thermo_log(path, append=append)


def _target(engine: Engine, words: Words) -> tuple[Path | None, bool]:
    """Read a file, ``none`` for no file, and whether to go on at its end."""
    name = words.take("a file")
    append = not words.done() and words.choice(("append",)) == "append"
    return (None if name == "none" else inside(engine.world.root, name)), append
