"""What is believed of one unknown before any data: its range and the density inside it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

import numpy as np
from scipy import special

from calibrate.arrays import Array
from calibrate.errors import CalibrationError

__all__ = ["Prior", "Spacing", "from_unit", "to_unit", "truncated_normal"]

Spacing: TypeAlias = Literal["linear", "log"]
Kind: TypeAlias = Literal["uniform", "normal", "half_normal", "non_local"]

TINY: Final = 1e-16
"""Nearest that a probability comes to 0 or 1, so that no quantile is infinite."""

_CHI3: Final = 1.5  # half the degrees of freedom of |x| / s under x^2 N(0, s^2)


def to_unit(value: Array, low: float, high: float, spacing: Spacing) -> Array:
    """Return values scaled so that the range becomes [0, 1]."""
    if spacing == "log":
        return np.asarray(np.log(np.asarray(value) / low) / math.log(high / low))
    return np.asarray((np.asarray(value) - low) / (high - low))


def from_unit(unit: Array, low: float, high: float, spacing: Spacing) -> Array:
    """Undo `to_unit`.

    Examples
    --------
    >>> float(from_unit(0.5, 0.01, 1.0, "log"))
    0.1
    """
    if spacing == "log":
        return np.asarray(low * (high / low) ** np.asarray(unit))
    return np.asarray(low + (high - low) * np.asarray(unit))


def truncated_normal(p: Array, low: Array, high: Array) -> Array:
    """Return quantiles of a unit normal between two limits.

    Parameters
    ----------
    p : array
        Probabilities inside (0, 1).
    low, high : array
        Limits; the quantile is that of the normal given that it lies between them.
    """
    # In the left tail probabilities keep their digits; a span in the right tail is mirrored.
    flip = np.asarray(low) >= 0.0
    a, b = np.where(flip, -high, low), np.where(flip, -low, high)
    share = np.where(flip, 1.0 - p, p)
    below, above = special.ndtr(a), special.ndtr(b)
    x = special.ndtri(below + share * (above - below))
    return np.asarray(np.clip(np.where(flip, -x, x), low, high))


@dataclass(frozen=True)
class Prior:
    """Density of one unknown inside a range; made by the class methods.

    Attributes
    ----------
    kind : {"uniform", "normal", "half_normal", "non_local"}
        ``non_local`` is x^2 N(0, sd^2), for strengths of effects: zero has no probability, so
        that an effect of no size gains nothing over leaving it out (Johnson and Rossell 2010).
    low, high : float
        Range, in the unknown's unit; infinite for nuisances.
    spacing : {"linear", "log"}
        Scale on which a uniform prior is flat and on which emulators and intervals see the range.
    mean, sd : float
        Of the normal before it is cut; always in the unknown's unit.

    Raises
    ------
    CalibrationError
        If range, spacing and width do not go together.
    """

    kind: Kind
    low: float
    high: float
    spacing: Spacing = "linear"
    mean: float = 0.0
    sd: float = 1.0

    def __post_init__(self) -> None:
        """Check that the density exists."""
        self._check(self.low < self.high, "the lower end must be below the upper one")
        self._check(self.spacing == "linear" or self.low > 0.0, "log spacing needs a range above 0")
        self._check(self.sd > 0.0, "sd must be above 0")
        positive = self.kind != "half_normal" or self.low >= 0.0
        self._check(positive, "a half-normal prior needs a range that starts at 0 or above")
        bounded = self.kind != "uniform" or math.isfinite(self.high - self.low)
        self._check(bounded, "a uniform prior needs a finite range")

    def _check(self, good: bool, remedy: str) -> None:
        if not good:
            place = f"{self.kind} prior on [{self.low:g}, {self.high:g}] (sd {self.sd:g})"
            msg = f"{place}: {remedy}"
            raise CalibrationError(msg)

    @classmethod
    def uniform(cls, low: float, high: float, spacing: Spacing = "linear") -> Prior:
        """Return a prior that is flat on the spacing's scale."""
        return cls("uniform", low, high, spacing)

    @classmethod
    def normal(
        cls,
        mean: float,
        sd: float,
        low: float = -math.inf,
        high: float = math.inf,
        spacing: Spacing = "linear",
    ) -> Prior:
        """Return a normal prior, cut at the range."""
        return cls("normal", low, high, spacing, mean, sd)

    @classmethod
    def half_normal(
        cls, sd: float, low: float = 0.0, high: float = math.inf, spacing: Spacing = "linear"
    ) -> Prior:
        """Return the upper half of a normal about 0, cut at the range."""
        return cls("half_normal", low, high, spacing, 0.0, sd)

    @classmethod
    def non_local(cls, sd: float, low: float = -math.inf, high: float = math.inf) -> Prior:
        """Return the prior x^2 N(0, sd^2) of an effect's strength, cut at the range."""
        return cls("non_local", low, high, "linear", 0.0, sd)

    @property
    def bounded(self) -> bool:
        """Whether both ends of the range are finite."""
        return math.isfinite(self.low) and math.isfinite(self.high)

    def quantile(self, p: Array) -> Array:
        """Return the values below which the probability is `p`, any shape."""
        p = np.clip(np.asarray(p, dtype=float), TINY, 1.0 - TINY)
        if self.kind == "uniform":
            return from_unit(p, self.low, self.high, self.spacing)
        if self.kind == "non_local":
            below, above = self._signed(self.low), self._signed(self.high)
            c = np.clip(below + p * (above - below), -1.0 + TINY, 1.0 - TINY)
            size = np.sqrt(2.0 * special.gammaincinv(_CHI3, np.abs(c)))
            return np.asarray(np.clip(np.sign(c) * size * self.sd, self.low, self.high))
        low, high = (self.low - self.mean) / self.sd, (self.high - self.mean) / self.sd
        deviate = truncated_normal(p, np.asarray(low), np.asarray(high))
        return np.asarray(self.mean + self.sd * deviate)

    def _signed(self, value: float) -> float:
        """Return sign(x) P(|X| < |x|) of the uncut non-local prior."""
        share = float(special.gammainc(_CHI3, 0.5 * (value / self.sd) ** 2))
        return math.copysign(share, value)

    def log_density(self, value: Array) -> Array:
        """Return the logarithm of the density inside the range, up to a constant.

        On the spacing's scale for a uniform prior, else per unit of the value.
        """
        value = np.asarray(value, dtype=float)
        if self.kind == "uniform":
            return np.zeros_like(value)
        power = -0.5 * ((value - self.mean) / self.sd) ** 2
        if self.kind == "non_local":
            return np.asarray(power + np.log(np.maximum(value**2, TINY**2)))
        return np.asarray(power)
