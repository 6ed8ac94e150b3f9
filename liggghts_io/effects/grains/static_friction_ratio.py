"""Friction at rest is above that of sliding; an extension of minidem."""

from __future__ import annotations

from typing import Any, Final

from liggghts_io.effects.base import Effect
from liggghts_io.experiments.setup import Setup

WEAKENING_SPEED: Final = 0.01
"""Sliding speed over which friction falls from static to kinetic [m/s]."""


def apply(variables: dict[str, Any], strength: float, _setup: Setup) -> dict[str, Any]:
    """Raise friction at rest between grains and on the wall under test by this part."""
    return variables | {
        "static_friction": True,
        **{
            f"mu_static_{pair}": variables[f"mu_{pair}"] * (1.0 + strength)
            for pair in ("pp", "pw")
            if f"mu_{pair}" in variables  # an experiment may have one kind of contact only
        },
        "weakening_speed": WEAKENING_SPEED,
    }


STATIC_FRICTION_RATIO: Final = Effect(
    name="static_friction_ratio",
    title="Static above sliding friction",
    unit="-",
    meaning="static over sliding friction, minus 1, of grains and of the wall under test",
    scale=0.2,
    low=0.0,
    high=2.0,
    settled_by="the angle at which grains start to slide on a slope, and that at which they stop",
    settled_se=0.05,
    settled_hours=0.5,
    apply=apply,
    scope="material",
    extension="staticFriction",
)
