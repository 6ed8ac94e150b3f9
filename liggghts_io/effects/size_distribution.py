"""Grains are not all of one size: the measured quantiles d10, d50, d90 as three size classes."""

from __future__ import annotations

from typing import Any, Final

from liggghts_io.effects.base import Effect
from liggghts_io.experiments.base import Setup
from liggghts_io.scripts.filters import grains

NUMBER_SHARES: Final = (0.3, 0.4, 0.3)
"""Swanson's shares of the 10, 50 and 90 % quantiles: they keep mean and spread of a quantity."""


def size_classes(setup: Setup, strength: float) -> list[tuple[float, float]]:
    """Return diameter [m] and mass fraction of each class.

    Parameters
    ----------
    setup : Setup
    strength : float
        0 gives grains of Sauter diameter, 1 the measured spread; in between the spread shrinks.

    Returns
    -------
    list of (float, float)
        The Sauter diameter of the mixture stays that of the particle.
    """
    grain = setup.particle
    spread = [
        1.0 + strength * (diameter / grain.d50_m - 1.0)
        for diameter in (grain.d10_m, grain.d50_m, grain.d90_m)
    ]
    cubes = [share * s**3 for share, s in zip(NUMBER_SHARES, spread, strict=True)]
    squares = [share * s**2 for share, s in zip(NUMBER_SHARES, spread, strict=True)]
    unit = grain.d32_m * sum(squares) / sum(cubes)
    total = sum(cubes)
    return [(unit * s, cube / total) for s, cube in zip(spread, cubes, strict=True)]


def apply(variables: dict[str, Any], strength: float, setup: Setup) -> dict[str, Any]:
    """Replace the single size; number and rate of grains keep mass and mass flow."""
    classes = size_classes(setup, strength)
    density = variables["density"]
    ratio = grains(1.0, classes, density) / grains(1.0, variables["sizes"], density)
    return variables | {
        "sizes": classes,
        "grain_count": variables["grain_count"] * ratio,
        "grain_rate": variables["grain_rate"] * ratio,
    }


SIZE_DISTRIBUTION: Final = Effect(
    name="size_distribution",
    title="Size distribution",
    unit="-",
    meaning="part of the measured spread of diameters (1: d10, d50, d90 as measured)",
    scale=1.0,
    low=0.0,
    high=1.5,
    settled_by="the sieve curve of this batch",
    experiments=("heap", "conveyor", "plate_impact"),
    apply=apply,
)
