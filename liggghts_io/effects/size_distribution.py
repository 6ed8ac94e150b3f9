"""Grains are not all of one size: the measured size classes instead of the Sauter diameter."""

from __future__ import annotations

from typing import Any, Final

from liggghts_io.effects.base import Effect
from liggghts_io.experiments.setup import Setup
from liggghts_io.materials import SizeClasses
from liggghts_io.scripts.filters import grains

SMALLEST: Final = 0.1
"""Above strength 1 no class shrinks below this part of the middle one, unless it was measured so:
a wide distribution would end at grains of no size, which set the time step."""


def median(classes: SizeClasses) -> float:
    """Return the diameter of the class that holds the middle grain [m]."""
    counted = 0.0
    for diameter, share in classes:
        counted += share
        if counted >= 0.5:
            return diameter
    return classes[-1][0]  # shares that rounding leaves short of a half


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
    middle = median(grain.size_classes)
    shares = [share for _, share in grain.size_classes]
    ratios = [diameter / middle for diameter, _ in grain.size_classes]
    spread = [max(1.0 + strength * (ratio - 1.0), min(ratio, SMALLEST)) for ratio in ratios]
    cubes = [share * s**3 for share, s in zip(shares, spread, strict=True)]
    squares = [share * s**2 for share, s in zip(shares, spread, strict=True)]
    unit = grain.d32_m * sum(squares) / sum(cubes)
    total = sum(cubes)
    return [(unit * s, cube / total) for s, cube in zip(spread, cubes, strict=True)]


def apply(variables: dict[str, Any], strength: float, setup: Setup) -> dict[str, Any]:
    """Replace the single size; number and rate of grains keep mass and mass flow."""
    classes = size_classes(setup, strength)
    density = variables["density"]
    ratio = grains(1.0, classes, density) / grains(1.0, variables["sizes"], density)
    numbers = ("grain_count", "grain_rate")  # an own template may compute them itself
    scaled = {name: variables[name] * ratio for name in numbers if name in variables}
    return variables | {"sizes": classes, **scaled}


SIZE_DISTRIBUTION: Final = Effect(
    name="size_distribution",
    title="Size distribution",
    unit="-",
    meaning="part of the measured spread of diameters (1: the size classes as measured)",
    scale=1.0,
    low=0.0,
    high=1.5,
    settled_by="the sieve curve of this batch",
    apply=apply,
    needs=("size_classes",),
)
