"""The glued layer gives way: grains on it do not meet walls that hold them without limit."""

from __future__ import annotations

from typing import Any, Final

from liggghts_io.effects.base import Effect
from liggghts_io.experiments.setup import Setup
from liggghts_io.materials import GLUED, GLUED_FRICTION


def apply(variables: dict[str, Any], strength: float, _setup: Setup) -> dict[str, Any]:
    """Let the glued wall hold with this reciprocal of a friction coefficient."""
    friction = 1.0 / (strength + 1.0 / GLUED_FRICTION)
    return variables | {"mu_pw": friction, "mu_roll_pw": friction}


GLUED_SLIP: Final = Effect(
    name="glued_slip",
    title="Glued layer that slips",
    unit="-",
    meaning="one over the friction coefficient of the glued layer (0: it holds)",
    scale=1.0,
    low=0.0,
    high=10.0,
    settled_by="a glued plate tilted under load until grains slide on it",
    settled_se=0.05,
    settled_hours=1.0,
    apply=apply,
    experiments=("heap", "conveyor"),
    walls=(GLUED,),
    scope="material",
)
