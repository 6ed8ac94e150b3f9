"""``pair_style`` and ``pair_coeff``: the contact model of particles."""

from __future__ import annotations

from minidem.commands.command import COMMANDS
from minidem.contact.model import parse_model, parse_settings
from minidem.errors import InputError
from minidem.run.engine import Engine
from minidem.script.names import OLD_MODELS, foreign
from minidem.words import Words, integer

_HYBRID = ("hybrid", "hybrid/overlay")
"""Styles of several pair styles; of one they are that one."""


@COMMANDS.register("pair_style")
def _pair_style(engine: Engine, words: Words) -> None:
    if words.peek() in OLD_MODELS:
        msg = (
            f"pair_style {words.peek()}: a name that LIGGGHTS 3.8.0 does not have either; write "
            f"'pair_style gran model {OLD_MODELS[words.peek()]}'"
        )
        raise InputError(msg)
    if told := foreign("pair_style", words.peek()):
        raise InputError(told)
    words.need(2, "pair_style gran model hertz tangential history")
    hybrid = words.choice(("gran", *_HYBRID), "style") in _HYBRID
    if hybrid:
        words.choice(("gran",), "style")
    rest = words.rest()
    if hybrid and "gran" in rest:
        msg = (
            "pair_style hybrid: a second 'gran' would be a second contact law of the same "
            "particles, which is not in minidem; leave one out"
        )
        raise InputError(msg)
    switches, rest = parse_model(rest)
    parse_settings(rest, switches)
    engine.world.pair.switches = switches
    engine.world.pair.covered = []
    engine.world.pair.given += 1
    engine.world.pair.hybrid = hybrid


@COMMANDS.register("pair_coeff")
def _pair_coeff(engine: Engine, words: Words) -> None:
    words.need(2, "pair_coeff * *")
    first, second = words.take("atom types"), words.take("atom types")
    world = engine.world
    if world.pair.hybrid:
        words.need(1, "pair_coeff * * gran")
        words.choice(("gran",), "style")
    words.finish()
    for known, what in ((world.box, "simulation box"), (world.pair.switches, "pair_style")):
        if known is None:
            msg = f"Pair_coeff command before {what} is defined; move it behind that"
            raise InputError(msg)
    one, other = (_types(word, world.types) for word in (first, second))
    if one.start >= other.stop:  # LIGGGHTS counts pairs whose first type is not the larger one
        msg = f"Incorrect args for pair coefficients: '{first} {second}'; give 'pair_coeff * *'"
        raise InputError(msg)
    world.pair.covered.append(range(max(one.start, other.start), min(one.stop, other.stop)))


def _types(word: str, most: int) -> range:
    """Return the atom types of ``3``, ``*``, ``2*``, ``*2`` or ``1*2``."""
    low, star, high = word.partition("*")
    first = integer(low, "pair_coeff") if low or not star else 1
    last = (integer(high, "pair_coeff") if high else most) if star else first
    if first < 1 or last > most:
        msg = f"Numeric index is out of bounds: '{word}' of pair_coeff; atom types are 1 to {most}"
        raise InputError(msg)
    return range(first, last + 1)
