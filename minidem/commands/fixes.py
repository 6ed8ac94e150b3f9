"""``fix``, ``unfix`` and ``fix_modify``; the styles are in `minidem.fixes`."""

from __future__ import annotations

from collections.abc import Sequence

from minidem import fixes as fixes  # registers the styles
from minidem.commands.command import COMMANDS
from minidem.registry import Head
from minidem.run.engine import Engine
from minidem.words import Words, need, one_of
from minidem.world.fix import FIXES
from minidem.world.world import World


@COMMANDS.register("fix")
def _fix(engine: Engine, words: Sequence[str]) -> None:
    need(words, 3, "fix ID GROUP STYLE ...")
    name, group, style = words[:3]
    world = engine.world
    made = FIXES.find(style)
    head = Head(name, style, world.bit(group))
    if world.box is None and not made.before_box:
        msg = "fix command before simulation box is defined; use create_box first"
        raise ValueError(msg)
    if name in world.fixes:
        if style != world.fixes[name].style:
            msg = f"replacing fix '{name}', but the new style '{style}' is not the same"
            raise ValueError(msg)
        _remove(world, name)
    world.fixes[name] = made.read(world, head, Words(words[3:], f"fix {style}"))


@COMMANDS.register("unfix")
def _unfix(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "unfix ID")
    _remove(engine.world, one_of(words[0], tuple(engine.world.fixes), "fix"))


def _remove(world: World, name: str) -> None:
    """Take a fix away; ValueError if another one still needs it."""
    world.fixes[name].remove(world)
    del world.fixes[name]


@COMMANDS.register("fix_modify")
def _fix_modify(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "fix_modify ID KEYWORD VALUE")
    one_of(words[0], tuple(engine.world.fixes), "fix")
