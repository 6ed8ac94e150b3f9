"""Physical causes that the base model leaves out: those of installed packages, ours among them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from liggghts_io.effects.adjustment import adjusting
from liggghts_io.effects.base import Effect
from liggghts_io.effects.from_table import tabled_effects
from liggghts_io.errors import CaseError, nearest
from liggghts_io.experiments import Experiment
from liggghts_io.plug_ins import load_plug_ins

_LOADED: Final = load_plug_ins("bulkcal.effects", Effect, tabled_effects())
EFFECTS: Final[dict[str, Effect]] = _LOADED.found

__all__ = [
    "EFFECTS",
    "Effect",
    "check_engine",
    "effect_in",
    "effect_named",
    "effects_in",
    "own_effects",
]


def effect_named(name: str) -> Effect:
    """Return the effect of that name.

    Raises
    ------
    CaseError
        For an unknown name, with the nearest known one.
    """
    try:
        return EFFECTS[name]
    except KeyError:
        broken = "".join(f"; {one}" for one in _LOADED.broken)
        msg = f"unknown effect {name!r}{nearest(name, list(EFFECTS))}{broken}"
        raise CaseError(msg) from None


def effects_in(experiment: Experiment) -> dict[str, Effect]:
    """Return the effects that can act in an experiment by name: the registered ones, its own.

    Raises
    ------
    CaseError
        If an effect of its own has the name of a registered one.
    """
    registered = {
        name: one
        for name, one in EFFECTS.items()
        if one.acts_in(experiment.name) and (experiment.templated or one.experiments)
    }
    return registered | own_effects(experiment)


def own_effects(experiment: Experiment) -> dict[str, Effect]:
    """Return the effects that an experiment brings by name; see `effects_in`."""
    for one in experiment.effects:
        if one.name in EFFECTS:
            msg = f"{experiment.name}: {one.name} is the name of a known effect; choose another"
            raise CaseError(msg)
    return {one.name: adjusting(one, experiment.name) for one in experiment.effects}


def effect_in(experiment: Experiment, name: str) -> Effect | None:
    """Return the effect of a name if it can act in an experiment; see `effects_in`."""
    one = EFFECTS.get(name)
    if one is not None:
        acts = one.acts_in(experiment.name) and (experiment.templated or one.experiments)
        return one if acts else None
    own = (adjusting(o, experiment.name) for o in experiment.effects if o.name == name)
    return next(own, None)


def check_engine(strengths: Mapping[str, float], engine: str, place: str) -> None:
    """Refuse an engine that does not know the effects.

    Parameters
    ----------
    strengths : mapping of str to float
        Effects that are switched on.
    engine : str
        "minidem" or "liggghts".
    place : str
        Where the effects stand, for the message.

    Raises
    ------
    CaseError
        For LIGGGHTS and an effect that only minidem has.
    """
    for name, strength in strengths.items():
        word = EFFECTS[name].extension if name in EFFECTS else ""
        if engine == "liggghts" and word and strength != 0.0:
            msg = (
                f"{place}: effect {name} = {strength:g} needs '{word}', an extension of minidem "
                "that LIGGGHTS 3.8.0 does not have; run it with minidem, or set the strength to 0"
            )
            raise CaseError(msg)
