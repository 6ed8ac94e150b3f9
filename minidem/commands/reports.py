"""``echo``, ``log``, ``thermo_log`` and ``info``: what goes to screen and log."""

from __future__ import annotations

from pathlib import Path

from minidem.commands.command import COMMANDS
from minidem.files import append_text
from minidem.output.info import CATEGORIES, info_text
from minidem.run.engine import Engine
from minidem.script import inside
from minidem.words import Words


@COMMANDS.register("echo")
def _echo(engine: Engine, words: Words) -> None:
    engine.report.echo_to(words.choice(("none", "screen", "log", "both"), "target"))


@COMMANDS.register("info")
def _info(engine: Engine, words: Words) -> None:
    words.need(1, "info CATEGORY ... [out screen | log | append FILE | overwrite FILE]")
    wanted: set[str] = set()
    where, path = "screen", Path()
    while not words.done():
        key = words.choice((*CATEGORIES, "all", "out"), "category")
        if key != "out":
            wanted.update(CATEGORIES if key == "all" else [key])
            continue
        where = words.choice(("screen", "log", "append", "overwrite"), "target")
        if where in ("append", "overwrite"):
            path = inside(engine.world.root, words.take("a file"))
    text = info_text(engine.world, [name for name in CATEGORIES if name in wanted])
    if where == "screen":
        engine.report.screen(text)
    elif where == "log":
        engine.report.line(text)
    else:
        append_text(path, text, anew=where == "overwrite")


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
