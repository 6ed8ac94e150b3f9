"""``run``, ``fix``, ``unfix`` and ``info``."""

from __future__ import annotations

from collections.abc import Sequence

from minidem.registry import FIXES, command, integer, need, one_of
from minidem.removal import remove_fix
from minidem.run.engine import Engine


@command("fix")
def _fix(engine: Engine, words: Sequence[str]) -> None:
    need(words, 3, "fix ID GROUP STYLE ...")
    name, group, style = words[:3]
    one_of(style, tuple(FIXES), "fix")
    engine.world.bit(group)
    if style not in ("property/global",) and engine.world.box is None:
        msg = "fix command before simulation box is defined; use create_box first"
        raise ValueError(msg)
    if name in engine.world.fixes and style != engine.world.fixes[name].style:
        msg = f"replacing fix '{name}', but the new style '{style}' is not the same"
        raise ValueError(msg)
    if name in engine.world.fixes:
        remove_fix(engine.world, name)
    engine.world.fixes[name] = FIXES[style](engine, name, style, group, words[3:])
    engine.fixes_changed()


@command("unfix")
def _unfix(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "unfix ID")
    remove_fix(engine.world, one_of(words[0], tuple(engine.world.fixes), "fix"))


@command("fix_modify")
def _fix_modify(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "fix_modify ID KEYWORD VALUE")
    one_of(words[0], tuple(engine.world.fixes), "fix")


@command("run")
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
