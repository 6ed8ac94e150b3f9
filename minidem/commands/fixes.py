"""``fix``, ``unfix`` and ``fix_modify``; the styles are in `minidem.fixes`."""

from __future__ import annotations

from minidem import fixes as fixes  # registers the styles
from minidem.commands.command import COMMANDS
from minidem.errors import InputError
from minidem.registry import Head
from minidem.run.engine import Engine
from minidem.words import Words
from minidem.world.fix import FIXES
from minidem.world.world import World


@COMMANDS.register("fix")
def _fix(engine: Engine, words: Words) -> None:
    words.need(3, "fix ID GROUP STYLE ...")
    world = engine.world
    name, group, style = words.take("an ID"), words.take("a group"), words.take("a style")
    made = FIXES.find(style)
    head = Head(name, style, world.bit(group))
    if world.box is None and not made.before_box:
        msg = "fix command before simulation box is defined; use create_box first"
        raise InputError(msg)
    if name in world.fixes:
        if style != world.fixes[name].style:
            msg = f"replacing fix '{name}', but the new style '{style}' is not the same"
            raise InputError(msg)
        _remove(world, name)
    words = Words(words.rest(), f"fix {style}")
    try:
        world.fixes[name] = made.read(world, head, words)
    except InputError:
        if name in world.meshes.names:  # a mesh whose words are wrong is none for what follows
            world.meshes.remove(name)
        raise
    words.finish()


@COMMANDS.register("unfix")
def _unfix(engine: Engine, words: Words) -> None:
    words.need(1, "unfix ID")
    _remove(engine.world, words.choice(tuple(engine.world.fixes), "ID"))


def _remove(world: World, name: str) -> None:
    """Take a fix away; InputError if another one still needs it."""
    world.fixes[name].remove(world)
    del world.fixes[name]
    world.energies.discard(name)


@COMMANDS.register("fix_modify")
def _fix_modify(engine: Engine, words: Words) -> None:
    words.need(1, "fix_modify ID KEYWORD VALUE")
    name = words.choice(tuple(engine.world.fixes), "ID")
    engine.world.fixes[name].modify(engine.world, Words(words.rest(), "fix_modify"))
