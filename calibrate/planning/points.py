"""Space-filling points at which emulators are trained first.

One sequence of scrambled Sobol points serves everything: a part of it for each material, so that
materials which share an emulator do not repeat each other, and every experiment of a material at
the same points, so that a point says what all of them would show.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.stats import qmc

from calibrate.arrays import Array

__all__ = [
    "LEAST_PER_INPUT",
    "PER_INPUT",
    "REPEAT_EVERY",
    "TWIN_EVERY",
    "Points",
    "points_needed",
    "spread",
    "starting_points",
]

PER_INPUT: Final = 10
"""Points of a first design per input (Loeppky, Sacks and Welch, Technometrics 51, 2009)."""
LEAST_PER_INPUT: Final = 3
"""Points of one material per input where several materials share an emulator."""
REPEAT_EVERY: Final = 8
"""One point in so many is run with a second seed; these runs tell the noise."""
TWIN_EVERY: Final = 3
"""One point in so many is run once more for each effect, with the effect on."""


@dataclass(frozen=True)
class Points:
    """Runs of a first design.

    Attributes
    ----------
    u : (n, d) float64
        Parameters on [0, 1].
    strengths : (n, m) float64
        Effects as parts of their ranges: -1 is the lower limit, 1 the upper one, 0 is off.
    seeds : (n,) int64
        Runs of one number share their luck; counted from 0.
    point : (n,) int64
        Which point a run belongs to: repeats and effect twins have the number of their point.
    """

    u: Array
    strengths: Array
    seeds: Array
    point: Array

    def first(self, count: int) -> Points:
        """Return the runs of the first `count` points."""
        keep = self.point < count
        return Points(self.u[keep], self.strengths[keep], self.seeds[keep], self.point[keep])


def points_needed(inputs: int, materials: int = 1) -> int:
    """Return how many points one material needs for an emulator of so many inputs.

    Materials that share an emulator share its points, down to a number with which each of them
    is still seen everywhere.

    Examples
    --------
    >>> points_needed(6), points_needed(8, materials=2), points_needed(8, materials=5)
    (60, 40, 24)
    """
    return max(math.ceil(PER_INPUT * inputs / materials), LEAST_PER_INPUT * inputs)


def spread(count: int, dimensions: int, rng: np.random.Generator) -> Array:
    """Return scrambled Sobol points, (count, dimensions) on [0, 1]."""
    if count == 0 or dimensions == 0:
        return np.empty((count, dimensions))
    sequence = qmc.Sobol(dimensions, seed=rng)
    # A power of two is drawn, of which the first points are again well spread.
    return np.asarray(sequence.random_base2(math.ceil(math.log2(max(count, 2))))[:count])


def starting_points(
    count: int, dimensions: int, effects: int, groups: int, rng: np.random.Generator
) -> tuple[Points, ...]:
    """Return the first runs of several materials.

    Parameters
    ----------
    count : int
        Points of each material.
    dimensions, effects : int
        Parameters, and effects whose strengths are unknown.
    groups : int
        Materials; their points are disjoint parts of one sequence.
    rng : numpy Generator

    Returns
    -------
    tuple of Points
        One per material.
    """
    u = spread(count * groups, dimensions, rng)
    return tuple(
        _with_repeats(u[k * count : (k + 1) * count], effects, k * count, len(u))
        for k in range(groups)
    )


def _with_repeats(u: Array, effects: int, first: int, total: int) -> Points:
    """Add second seeds, counted from `total`, and effect twins to the points of a material."""
    count = len(u)
    base = np.arange(count)
    point, seeds, strengths = [base], [first + base], [np.zeros((count, effects))]
    again = base[::REPEAT_EVERY]
    point.append(again)
    seeds.append(total + first + again)
    strengths.append(np.zeros((len(again), effects)))
    for effect in range(effects):
        # Effects begin at different points, and each one's ends take turns.
        twins = base[effect % TWIN_EVERY :: TWIN_EVERY]
        on = np.zeros((len(twins), effects))
        on[:, effect] = np.where(np.arange(len(twins)) % 2, -1.0, 1.0)
        point.append(twins)
        seeds.append(first + twins)
        strengths.append(on)
    where = np.concatenate(point)
    return Points(u[where], np.concatenate(strengths), np.concatenate(seeds), where)
