"""Probability of three or more parameters: draws of the common sampler, seen as a grid is seen."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from calibrate.arrays import Array
from calibrate.inference import Interval, Posterior
from calibrate.inference.priors import to_unit

__all__ = ["CloudPosterior"]


@dataclass(frozen=True, eq=False)
class CloudPosterior:
    """Draws of the parameters of a stage, each on [0, 1].

    Attributes
    ----------
    drawn : Posterior
        Parameters first, then the errors that its readings share.
    size : int
        Number d of parameters.
    """

    drawn: Posterior
    size: int

    @property
    def units(self) -> Array:
        """Draws on the unit ranges, (n, d)."""
        units = self.drawn.space.units(self.drawn.samples)[:, : self.size]
        return np.asarray(np.clip(units, 0.0, 1.0))

    def interval(self, parameter: int, level: float) -> Interval:
        """Return the shortest span that holds `level`; a wider level contains a narrower one."""
        space = self.drawn.space
        span, prior = self.drawn.interval(space.names[parameter], level), space.priors[parameter]
        low, high = to_unit(np.array([span.low, span.high]), prior.low, prior.high, prior.spacing)
        return Interval(float(low), float(high), span.open_low, span.open_high)

    def best(self) -> Array:
        """Return the most probable values that lie in all 68 % intervals, (d,)."""
        units = self.drawn.space.units(self.drawn.best[None])[0, : self.size]
        return np.asarray(np.clip(units, 0.0, 1.0))

    def regions(self) -> int:
        """Return into how many separate regions the probability falls."""
        return len(self.drawn.regions)

    def sample(self, count: int, rng: np.random.Generator, flatten: float = 1.0) -> Array:
        """Draw points, (count, d) in the unit cube.

        ``flatten`` below 1 spreads them about their mean as the density to that power would be
        spread if it were normal.
        """
        units = self.units
        mean = units.mean(axis=0)
        some = units[rng.integers(len(units), size=count)]
        return np.asarray(np.clip(mean + (some - mean) / math.sqrt(flatten), 0.0, 1.0))
