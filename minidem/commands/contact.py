"""``pair_style`` and ``pair_coeff``: the contact model of particles."""

from __future__ import annotations

from collections.abc import Sequence

from minidem.commands.command import COMMANDS
from minidem.contact.model import parse_model, parse_settings
from minidem.run.engine import Engine
from minidem.words import need, one_of


@COMMANDS.register("pair_style")
def _pair_style(engine: Engine, words: Sequence[str]) -> None:
    need(words, 2, "pair_style gran model hertz tangential history")
    one_of(words[0], ("gran",), "pair style")
    switches, rest = parse_model(words[1:])
    parse_settings(rest, switches)
    engine.world.pair.switches = switches


@COMMANDS.register("pair_coeff")
def _pair_coeff(engine: Engine, words: Sequence[str]) -> None:
    del engine
    if tuple(words[:2]) != ("*", "*"):
        msg = "pair_coeff: only 'pair_coeff * *' makes sense for granular pairs"
        raise ValueError(msg)
