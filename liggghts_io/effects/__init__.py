"""Physical causes that the base model leaves out: one file each, one line each in the registry."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from liggghts_io.effects.adjustment import adjusting
from liggghts_io.effects.air_drag import AIR_DRAG
from liggghts_io.effects.base import Effect
from liggghts_io.effects.cohesion import COHESION
from liggghts_io.effects.mass_flow_factor import MASS_FLOW_FACTOR
from liggghts_io.effects.plate_period import PLATE_PERIOD
from liggghts_io.effects.plate_tilt import PLATE_TILT
from liggghts_io.effects.restitution_slope import RESTITUTION_SLOPE
from liggghts_io.effects.size_distribution import SIZE_DISTRIBUTION
from liggghts_io.effects.static_friction_ratio import STATIC_FRICTION_RATIO
from liggghts_io.effects.wall_adhesion import WALL_ADHESION
from liggghts_io.errors import CaseError, nearest
from liggghts_io.experiments import Experiment

EFFECTS: Final = {
    one.name: one
    for one in (
        PLATE_TILT,
        PLATE_PERIOD,
        MASS_FLOW_FACTOR,
        SIZE_DISTRIBUTION,
        COHESION,
        WALL_ADHESION,
        AIR_DRAG,
        RESTITUTION_SLOPE,
        STATIC_FRICTION_RATIO,
    )
}

__all__ = ["EFFECTS", "Effect", "check_engine", "effect_named", "effects_in"]


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
        msg = f"unknown effect {name!r}{nearest(name, list(EFFECTS))}"
        raise CaseError(msg) from None


def effects_in(experiment: Experiment) -> dict[str, Effect]:
    """Return the effects that can act in an experiment by name: the registered ones, its own."""
    registered = {
        name: one
        for name, one in EFFECTS.items()
        if one.acts_in(experiment.name) and (experiment.templated or one.experiments)
    }
    return registered | {one.name: adjusting(one, experiment.name) for one in experiment.effects}


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
