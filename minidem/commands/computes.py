"""``compute``, ``uncompute`` and ``compute_modify``; the styles are in `minidem.computes`."""

from __future__ import annotations

from collections.abc import Sequence

from minidem import computes as computes  # registers the styles
from minidem.commands.command import COMMANDS
from minidem.registry import Head
from minidem.run.engine import Engine
from minidem.words import Words, need, one_of
from minidem.world.compute import COMPUTES


@COMMANDS.register("compute")
def _compute(engine: Engine, words: Sequence[str]) -> None:
    need(words, 3, "compute ID GROUP STYLE")
    name, group, style = words[:3]
    world = engine.world
    made = COMPUTES.find(style)
    if name in world.computes:
        msg = f"compute ID '{name}' is in use already; 'uncompute {name}' first"
        raise ValueError(msg)
    head = Head(name, style, world.bit(group))
    world.computes[name] = made.read(world, head, Words(words[3:], f"compute {style}"))


@COMMANDS.register("uncompute")
def _uncompute(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "uncompute ID")
    del engine.world.computes[one_of(words[0], tuple(engine.world.computes), "compute")]


@COMMANDS.register("compute_modify")
def _compute_modify(engine: Engine, words: Sequence[str]) -> None:
    need(words, 1, "compute_modify ID KEYWORD VALUE")
    one_of(words[0], tuple(engine.world.computes), "compute")
