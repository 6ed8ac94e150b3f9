"""Grains stick to the wall under test while they touch it (SJKR, wall contacts only)."""

from __future__ import annotations

from typing import Any, Final

from liggghts_io.effects.base import Effect
from liggghts_io.experiments.setup import Setup


def apply(variables: dict[str, Any], strength: float, _setup: Setup) -> dict[str, Any]:
    """Switch the cohesion model on with this energy density between grains and the wall."""
    total = variables["cohesion_pw"] + strength
    return variables | {"cohesive": True, "cohesion_pw": total}


WALL_ADHESION: Final = Effect(
    name="wall_adhesion_J_m3",
    title="Adhesion to the wall",
    unit="J/m3",
    meaning="SJKR cohesion energy density between grains and the wall under test",
    scale=5000.0,
    low=0.0,
    high=500000.0,
    settled_by="a single grain layer tilted until it slides, with and without load",
    settled_se=2000.0,
    settled_hours=4.0,
    apply=apply,
    scope="wall",
)
