"""Physical causes that the base model leaves out: one file each, one line each in the registry."""

from __future__ import annotations

from typing import Final

from liggghts_io.effects.base import Effect
from liggghts_io.effects.cohesion import COHESION
from liggghts_io.effects.mass_flow_factor import MASS_FLOW_FACTOR
from liggghts_io.effects.plate_period import PLATE_PERIOD
from liggghts_io.effects.plate_tilt import PLATE_TILT
from liggghts_io.effects.size_distribution import SIZE_DISTRIBUTION
from liggghts_io.effects.wall_adhesion import WALL_ADHESION
from liggghts_io.errors import CaseError
from liggghts_io.materials import nearest

EFFECTS: Final = {
    one.name: one
    for one in (
        PLATE_TILT,
        PLATE_PERIOD,
        MASS_FLOW_FACTOR,
        SIZE_DISTRIBUTION,
        COHESION,
        WALL_ADHESION,
    )
}

__all__ = ["EFFECTS", "Effect", "effect_named"]


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
