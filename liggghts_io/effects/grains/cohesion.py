"""Grains attract each other while they touch (SJKR: energy density times contact area)."""

from __future__ import annotations

from typing import Any, Final

from liggghts_io.effects.base import Effect
from liggghts_io.experiments.setup import Setup


def apply(variables: dict[str, Any], strength: float, _setup: Setup) -> dict[str, Any]:
    """Switch the cohesion model on with this energy density between grains."""
    total = variables["cohesion_pp"] + strength
    return variables | {"cohesive": True, "cohesion_pp": total}


COHESION: Final = Effect(
    name="cohesion_J_m3",
    title="Cohesion between grains",
    unit="J/m3",
    meaning="SJKR cohesion energy density between grains",
    scale=15000.0,
    low=0.0,
    high=500000.0,
    settled_by="the same heap after drying the grains, or a tensile test of the powder",
    settled_se=3000.0,
    settled_hours=8.0,
    apply=apply,
    scope="material",
)
