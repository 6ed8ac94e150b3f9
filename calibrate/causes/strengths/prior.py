"""What is believed of the strength of a cause before the data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy import special

from calibrate.arrays import Array

__all__ = ["StrengthPrior"]

FINE: Final = 1001
LEAST: Final = 0.5
"""Ordinary strength below which even odds stop: draws there are too few to stand for all."""


@dataclass(frozen=True)
class StrengthPrior:
    """What is believed of a strength, in ordinary ones, before the data.

    Attributes
    ----------
    low, high : float
        Equal for a cause that is on or off.
    width : float
        s of x^2 N(0, s^2).
    measured : (float, float) or None
        Value and standard error of an independent measurement.
    """

    low: float
    high: float
    width: float
    measured: tuple[float, float] | None = None

    @property
    def fixed(self) -> bool:
        """Whether it can have one value only."""
        return self.low == self.high

    def log_density(self, x: Array) -> Array:
        """Return the log density, normalised before any measurement, at strengths of any shape."""
        found = np.zeros_like(x) if self.fixed else self._plain(x) - self._log_mass()
        return np.asarray(found + self._log_measured(x))

    def log_evened(self, x: Array) -> Array:
        """Return by what log weights draws count as if all strengths were as probable before.

        Any measurement counts as it did.

        Parameters
        ----------
        x : float64
            Strengths of any shape, in ordinary ones.
        """
        if self.fixed:
            return np.zeros_like(x)
        return -self._plain(np.maximum(np.abs(x), LEAST))

    def _log_measured(self, x: Array) -> Array:
        if self.measured is None:
            return np.zeros_like(x)
        value, se = self.measured
        return np.asarray(-0.5 * ((x - value) / se) ** 2 - np.log(se) - 0.5 * np.log(2.0 * np.pi))

    def _plain(self, x: Array) -> Array:
        size = np.maximum(np.abs(x), 1e-150)
        return np.asarray(2.0 * np.log(size) - 0.5 * (x / self.width) ** 2)

    def _log_mass(self) -> float:
        """Return the logarithm of the integral of x^2 exp(-x^2 / 2 s^2) over the limits."""
        ends = np.array([self.low, self.high]) / self.width
        share = np.sign(ends) * special.gammainc(1.5, 0.5 * ends**2)
        whole = np.sqrt(0.5 * np.pi) * self.width**3
        return float(np.log(whole * (share[1] - share[0])))

    def draw(self, count: int, rng: np.random.Generator) -> Array:
        """Return strengths before any measurement, (count,)."""
        if self.fixed:
            return np.full(count, self.low)
        x = np.linspace(self.low, self.high, FINE)
        mass = np.cumsum(np.exp(self._plain(x)))
        return np.asarray(np.interp(rng.random(count) * mass[-1], mass, x))
