"""``compute``, ``uncompute`` and ``compute_modify``; the styles are in `minidem.computes`."""

from __future__ import annotations

from minidem import computes as computes  # registers the styles
from minidem.commands.command import COMMANDS
from minidem.errors import MistakeError
from minidem.registry import Head
from minidem.run.engine import Engine
from minidem.words import Words
from minidem.world.compute import COMPUTES


@COMMANDS.register("compute")
def _compute(engine: Engine, words: Words) -> None:
    words.need(3, "compute ID GROUP STYLE")
    world = engine.world
    name, group, style = words.take("an ID"), words.take("a group"), words.take("a style")
    made = COMPUTES.find(style)
    if name in world.computes:
        msg = f"compute ID '{name}' is in use already; 'uncompute {name}' first"
        raise MistakeError(msg)
    head = Head(name, style, world.bit(group))
    words = Words(_without_update(words.rest(), style), f"compute {style}")
    world.computes[name] = made.read(world, head, words)
    words.finish()


def _without_update(given: list[str], style: str) -> list[str]:
    """Drop ``update_on_run_end``: values are always those of the present step."""
    key = "update_on_run_end"
    if key in given:
        at = given.index(key)
        Words(given[at + 1 :], f"compute {style} {key}").choice(("yes", "no"), "setting")
        given = given[:at] + given[at + 2 :]
    return given


@COMMANDS.register("uncompute")
def _uncompute(engine: Engine, words: Words) -> None:
    words.need(1, "uncompute ID")
    del engine.world.computes[words.choice(tuple(engine.world.computes), "ID")]


@COMMANDS.register("compute_modify")
def _compute_modify(engine: Engine, words: Words) -> None:
    words.need(1, "compute_modify ID KEYWORD VALUE")
    found = engine.world.computes[words.choice(tuple(engine.world.computes), "ID")]
    while not words.done():
        found.modify(words.choice(("extra", "dynamic", "thermo")), words)
