"""``echo``, ``log`` and ``fix print``: what goes to screen and log."""

from __future__ import annotations

from collections.abc import Sequence

from minidem.fixes.printing import PrintFix
from minidem.registry import command, fix, integer, need, one_of, yes_no
from minidem.run.engine import Engine
from minidem.script import inside


@command("echo")
def _echo(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "echo none|screen|log|both")
    engine.report.echo_to(words[0])


@command("log")
def _log(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "log FILE [append]")
    if len(words) > 1:
        one_of(words[1], ("append",), "log keyword")
    path = None if words[0] == "none" else inside(engine.world.root, words[0])
    engine.report.open_log(path, append=len(words) > 1)


@fix("print")
def _print(engine: Engine, name: str, style: str, group: str, words: Sequence[str]) -> PrintFix:
    need(words, 2, 'fix ID GROUP print N "TEXT" [file NAME] [append NAME] [screen yes|no]')
    every = integer(words[0], "fix print")
    if every < 1:
        msg = f"fix print: the interval {every} is not positive"
        raise ValueError(msg)
    made = PrintFix(name, style, engine.world.bit(group), every, words[1])
    made.title = f"# Fix print output for fix {name}"
    rest = list(words[2:])
    while rest:
        key = one_of(rest[0], ("file", "append", "screen", "title"), "fix print keyword")
        need(rest, 2, f"fix print {key} VALUE")
        if key == "screen":
            made.screen = yes_no(rest[1], "fix print screen")
        elif key == "title":
            made.title = rest[1]
        else:
            made.path = inside(engine.world.root, rest[1])
            made.append = key == "append"
        rest = rest[2:]
    made.open_file()
    return made
