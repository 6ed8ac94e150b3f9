"""Faster impacts rebound less: restitution falls with impact speed; an extension of minidem."""

from __future__ import annotations

from typing import Any, Final

from liggghts_io.effects.base import Effect
from liggghts_io.experiments.setup import Setup

REFERENCE_SPEED: Final = 0.1
"""Impact speed up to which the restitution is that of the parameters [m/s]."""


def apply(variables: dict[str, Any], strength: float, _setup: Setup) -> dict[str, Any]:
    """Let the restitution of all contacts fall with this power of the impact speed."""
    return variables | {
        "restitution_exponent": strength,
        "restitution_speed": REFERENCE_SPEED,
    }


RESTITUTION_SLOPE: Final = Effect(
    name="restitution_slope",
    title="Restitution falls with speed",
    unit="-",
    meaning="exponent k of e (v / 0.1 m/s)^-k above 0.1 m/s (1/4: plastic yield)",
    scale=0.1,
    low=0.0,
    high=1.0,
    settled_by="drop tests of single grains from several heights",
    settled_se=0.02,
    settled_hours=4.0,
    apply=apply,
    scope="material",
    extension="velocityRestitution",
)
