"""``run``."""

from __future__ import annotations

from collections.abc import Sequence

from minidem.commands.command import COMMANDS
from minidem.run.engine import Engine
from minidem.words import integer, need, one_of


@COMMANDS.register("run")
def _run(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, 'run N [upto] [every M "command"]')
    steps = integer(words[0], "run")
    rest = list(words[1:])
    every = 0
    lines: list[str] = []
    world = engine.world
    while rest:
        key = one_of(rest[0], ("upto", "every", "pre", "post", "start", "stop"), "run keyword")
        if key == "upto":
            if steps < world.step:
                msg = f"run {steps} upto: step {world.step} is later already"
                raise ValueError(msg)
            steps -= world.step
            rest = rest[1:]
        elif key == "every":
            need(rest, 3, 'run N every M "command"')
            every = integer(rest[1], "run every")
            lines = rest[2:]
            rest = []
        else:
            rest = rest[2:]
    if steps < 0:
        msg = f"run: {steps} steps"
        raise ValueError(msg)
    engine.run(steps, every, lines)
