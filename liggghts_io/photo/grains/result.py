"""What was found on photographs of grains: diameters, circularities, what was left out and why."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from liggghts_io.photo.grains.shapes import OTHER, REASONS
from liggghts_io.photo.light import FloatArray, Polarity

QUANTILES: Final = (0.1, 0.5, 0.9)
_FEWEST: Final = 30  # grains that tell whether they look larger on one side
_LEAST_GROWTH: Final = 0.06  # of a size, from one side to the other
_SURE: Final = 3.7  # standard errors, that chance exceeds once in two thousand photographs
_APART: Final = 3.0  # standard deviations beyond which a grain tells nothing of that


@dataclass(frozen=True)
class GrainSizes:
    """Grains of a photograph.

    Attributes
    ----------
    diameters_m : (n,) float64
        Of the circle of equal projected area [m], equation 1.
    circularities : (n,) float64
        Perimeter of that circle over the perimeter, equation 2.
    outlines : (n, k, 2) float64
        Column and row in the photograph [px].
    left_out : (m, k, 2) float64
        Outlines of what was not counted [px].
    reasons : tuple of str
        Why, for each of them.
    others : int
        Things of the ground's other side, bright among dark grains or dark among bright ones, or
        such of another colour as were not found.
    polarity : str
        Whether grains are "dark" or "bright".
    metres_per_pixel : float
    shadows : bool
        Whether they threw shadows to one side, which were left out.
    """

    diameters_m: FloatArray
    circularities: FloatArray
    outlines: FloatArray
    left_out: FloatArray
    reasons: tuple[str, ...]
    others: int
    polarity: Polarity
    metres_per_pixel: float
    shadows: bool = False

    @property
    def count(self) -> int:
        """Grains."""
        return len(self.diameters_m)

    @property
    def d32_m(self) -> float:
        """Sauter diameter [m], equation 3."""
        return float(np.sum(self.diameters_m**3) / np.sum(self.diameters_m**2))

    @property
    def d32_se_m(self) -> float:
        """Standard error of the Sauter diameter from the number of grains [m]; infinite for one."""
        if self.count < 2:
            return math.inf
        squares = self.diameters_m**2
        parts = (self.diameters_m - self.d32_m) * squares / squares.mean()
        return float(np.sqrt(np.sum(parts**2)) / self.count)

    @property
    def circularity(self) -> float:
        """Mean circularity."""
        return float(self.circularities.mean())

    @property
    def pixels_across(self) -> float:
        """Median diameter [px]."""
        return float(np.median(self.diameters_m)) / self.metres_per_pixel

    def quantiles_m(self) -> tuple[float, ...]:
        """Return d10,0, d50,0 and d90,0: number quantiles of the diameters [m]."""
        return tuple(float(one) for one in np.quantile(self.diameters_m, QUANTILES))

    def growth(self) -> float:
        """Return the part by which grains look larger on one side than opposite, 0 for none.

        So they do where the camera looked at them obliquely; of one photograph.
        """
        if self.count < _FEWEST:
            return 0.0
        places = self.outlines.mean(axis=1)
        across = (places - places.mean(axis=0)) / np.maximum(np.ptp(places, axis=0), 1e-9)
        sizes = np.log(self.diameters_m)
        kept = np.abs(sizes - np.median(sizes)) <= _APART * float(np.std(sizes))
        terms, sizes = np.column_stack([np.ones(self.count), across])[kept], sizes[kept]
        inverse = np.linalg.pinv(terms.T @ terms)
        slopes = inverse @ terms.T @ sizes
        scatter = float(np.mean((sizes - terms @ slopes) ** 2))
        least = np.maximum(_SURE * np.sqrt(scatter * np.diag(inverse)), _LEAST_GROWTH)
        sure = (np.abs(slopes) > least)[1:]
        return float(np.expm1(np.abs(slopes[1:])[sure].max(initial=0.0)))

    def rejected(self) -> Mapping[str, int]:
        """Return how many things were not counted, by the reason."""
        counts = {reason: self.reasons.count(reason) for reason in REASONS}
        counts[OTHER] += self.others
        return {reason: count for reason, count in counts.items() if count}


def pooled(each: Sequence[GrainSizes]) -> GrainSizes:
    """Return the grains of several photographs of one bulk as one; outlines stay apart."""
    first = each[0]
    if len(each) == 1:
        return first
    return replace(
        first,
        diameters_m=np.concatenate([one.diameters_m for one in each]),
        circularities=np.concatenate([one.circularities for one in each]),
        others=sum(one.others for one in each),
    )
