"""The conveyor plate is not level: gravity leans along the transport direction."""

from __future__ import annotations

import math
from typing import Any, Final

from liggghts_io.effects.base import Effect
from liggghts_io.experiments.setup import Setup


def apply(variables: dict[str, Any], strength: float, _setup: Setup) -> dict[str, Any]:
    """Turn gravity about the transverse axis; the plate stays along x, its end is the low side."""
    angle = math.radians(strength)
    x, y, z = variables["gravity"]
    cos, sin = math.cos(angle), math.sin(angle)
    return variables | {"gravity": (x * cos - z * sin, y, z * cos + x * sin)}


PLATE_TILT: Final = Effect(
    name="plate_tilt_deg",
    title="Tilted conveyor plate",
    unit="deg",
    meaning="slope of the plate towards its discharge end",
    scale=1.0,
    low=-10.0,
    high=10.0,
    settled_by="a spirit level on the conveyor plate",
    settled_se=0.1,
    settled_hours=0.1,
    experiments=("conveyor",),
    apply=apply,
)
