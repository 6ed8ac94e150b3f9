"""Grains are not all of one size: the measured size classes instead of the Sauter diameter."""

from __future__ import annotations

from typing import Any, Final

from liggghts_io.effects.base import Effect
from liggghts_io.experiments.common import with_sizes
from liggghts_io.experiments.setup import Setup
from liggghts_io.materials import MEASURED, Particle
from liggghts_io.sizes import mixture


def apply(variables: dict[str, Any], strength: float, setup: Setup) -> dict[str, Any]:
    """Replace the single size; number and rate of grains keep mass and mass flow."""
    return with_sizes(variables, mixture(setup.particle, strength))


def clash(particle: Particle) -> str:
    """Return why the effect cannot be added: the measured sizes are there already."""
    if particle.sizes != MEASURED:
        return ""
    return f"{particle.name!r} has sizes = {particle.sizes!r} already; keep one of the two"


SIZE_DISTRIBUTION: Final = Effect(
    name="size_distribution",
    title="Size distribution",
    unit="-",
    meaning="part of the measured spread of diameters (1: the size classes as measured)",
    scale=1.0,
    low=0.0,
    high=1.5,
    settled_by="the sieve curve of this batch",
    settled_se=0.1,
    settled_hours=1.0,
    apply=apply,
    scope="material",
    needs=("size_classes",),
    clash=clash,
)
