"""Air slows the grains down (Schiller and Naumann); an extension of minidem."""

from __future__ import annotations

from typing import Any, Final

from liggghts_io.effects.base import Effect
from liggghts_io.experiments.setup import Setup

AIR_DENSITY: Final = 1.204
AIR_VISCOSITY: Final = 1.81e-5
"""Dry air at 20 degrees C and 1013 hPa: kg/m3, Pa s."""


def apply(variables: dict[str, Any], strength: float, _setup: Setup) -> dict[str, Any]:
    """Let still air of 20 degrees C act on every grain, times the strength."""
    return variables | {
        "air_drag": strength,
        "air_density": AIR_DENSITY,
        "air_viscosity": AIR_VISCOSITY,
    }


AIR_DRAG: Final = Effect(
    name="air_drag",
    title="Air drag",
    unit="-",
    meaning="drag of still air over the known drag of single spheres (1: as known)",
    scale=1.0,
    low=0.0,
    high=5.0,
    settled_by="fall times of single grains over some metres",
    settled_se=0.1,
    settled_hours=4.0,
    apply=apply,
    extension="drag/sphere",
)
