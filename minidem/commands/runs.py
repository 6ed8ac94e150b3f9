"""``run``."""

from __future__ import annotations

from minidem.commands.command import COMMANDS
from minidem.errors import InputError
from minidem.run.engine import Engine
from minidem.words import Words


@COMMANDS.register("run")
def _run(engine: Engine, words: Words) -> None:
    words.need(1, 'run N [upto] [every M "command"]')
    world = engine.world
    steps = words.integer()
    every = 0
    lines: list[str] = []
    while not words.done():
        key = words.choice(("upto", "every", "pre", "post", "start", "stop"))
        if key == "upto":
            if steps < world.step:
                msg = f"run {steps} upto: step {world.step} is later already"
                raise InputError(msg)
            steps -= world.step
        elif key == "every":
            words.need(2, 'run N every M "command"')
            every, lines = words.integer(), words.rest()
        else:
            words.take("a value")
    if steps < 0:
        msg = f"run: {steps} steps"
        raise InputError(msg)
    engine.run(steps, every, lines)
