"""The batch that was measured is broader or narrower in size than the sieve table says."""

from __future__ import annotations

from typing import Any, Final

from liggghts_io.effects.base import Effect
from liggghts_io.experiments.common import with_sizes
from liggghts_io.experiments.setup import Setup
from liggghts_io.materials import MEASURED, Particle
from liggghts_io.sizes import mixture


def apply(variables: dict[str, Any], strength: float, setup: Setup) -> dict[str, Any]:
    """Widen or narrow the measured size classes; number and rate of grains keep mass and flow."""
    return with_sizes(variables, mixture(setup.particle, 1.0 + strength))


def clash(particle: Particle) -> str:
    """Return why the effect cannot be added: there is no measured spread to change."""
    if particle.sizes == MEASURED:
        return ""
    return (
        f"{particle.name!r} has sizes = {particle.sizes!r}; set sizes = {MEASURED!r}, or take the "
        "effect size_distribution"
    )


SIZE_SPREAD: Final = Effect(
    name="size_spread",
    title="Spread of sizes",
    unit="-",
    meaning="spread of diameters over the measured one, minus 1 (-1: all of one size)",
    scale=0.5,
    low=-1.0,
    high=1.0,
    settled_by="the sieve curve of this batch",
    settled_se=0.1,
    settled_hours=1.0,
    apply=apply,
    scope="material",
    needs=("size_classes",),
    clash=clash,
)
