"""Strengths on a grid: how probable each is, given a draw of all else."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from calibrate.arrays import Array, log_sum
from calibrate.causes.strengths.prior import StrengthPrior
from calibrate.causes.strengths.terms import Cross, Terms, gain_across, gain_along

__all__ = ["COARSE", "Line", "Plane"]

NODES: Final = 61
COARSE: Final = 15
"""Nodes with which it is seen which draws count."""
FEW: Final = 19
"""Nodes for two strengths at once, each."""
_WIDE: Final = 0.25
"""Part of the strengths that come from a wider density,"""
_FLATTENED: Final = 0.3
"""which is this power of the grid's;"""
_EVEN: Final = 0.05
"""and part that come from the whole grid."""
KEPT: Final = 14.0
"""Nats below the highest at which a strength is left out of the grid."""


@dataclass(frozen=True)
class Line:
    """One strength given each of n draws.

    Attributes
    ----------
    nodes : (g,) float64
        Middles of bins of one width.
    width : float
        0 for a strength that can have one value only.
    log_part : (n, g) float64
        Log likelihood gain plus log prior at each node.
    """

    nodes: Array
    width: float
    log_part: Array

    @classmethod
    def of(cls, terms: Sequence[Terms], prior: StrengthPrior, log_weight: Array) -> Line:
        """Return a grid that is as fine as the draws that count need it.

        Parameters
        ----------
        terms : sequence of Terms
        prior : StrengthPrior
        log_weight : (n,) float64
            Of the draws without the cause; draws that cannot count do not widen the grid.
        """
        low, high = prior.low, prior.high
        for _ in range(4):
            line = cls.between(terms, prior, low, high, len(log_weight))
            if prior.fixed:
                return line
            counts = (line.log_part + log_weight[:, None]).max(axis=0)
            near = np.flatnonzero(counts > counts.max() - KEPT)
            if len(near) > NODES // 3:
                break
            low = max(prior.low, line.nodes[near[0]] - line.width)
            high = min(prior.high, line.nodes[near[-1]] + line.width)
        return line

    @classmethod
    def between(
        cls,
        terms: Sequence[Terms],
        prior: StrengthPrior,
        low: float,
        high: float,
        rows: int,
        count: int = NODES,
    ) -> Line:
        """Return an even grid between two strengths for so many rows, or draws."""
        if prior.fixed:
            x, width = np.array([prior.low]), 0.0
        else:
            width = (high - low) / count
            x = low + width * (np.arange(count) + 0.5)
        return cls(x, width, gain_along(terms, x, rows) + prior.log_density(x))

    @property
    def span(self) -> tuple[float, float]:
        """Between which strengths the grid lies."""
        half = 0.5 * self.width
        return float(self.nodes[0] - half), float(self.nodes[-1] + half)

    @property
    def log_integral(self) -> Array:
        """Logarithm of likelihood gain times prior, integrated over the strength, (n,)."""
        step = np.log(self.width) if self.width else 0.0
        return np.asarray(log_sum(self.log_part.copy()) + step)

    def draw(self, rng: np.random.Generator) -> tuple[Array, Array]:
        """Return a strength for each draw, and the log density it was drawn with, (n,) each."""
        count = len(self.log_part)
        if self.width == 0.0:
            return np.full(count, self.nodes[0]), np.zeros(count)
        bin_, share = _picked(self.log_part, rng)
        x = self.nodes[bin_] + self.width * (rng.random(count) - 0.5)
        return x, np.log(share / self.width)


@dataclass(frozen=True)
class Plane:
    """Two strengths given each of n draws.

    Attributes
    ----------
    first, second : (g,), (h,) float64
        Middles of bins.
    widths : (float, float)
        0 for a strength that can have one value only.
    log_part : (n, g, h) float64
    """

    first: Array
    second: Array
    widths: tuple[float, float]
    log_part: Array

    @classmethod
    def of(
        cls,
        cross: Sequence[Cross],
        priors: tuple[StrengthPrior, StrengthPrior],
        log_weight: Array,
    ) -> Plane:
        """Return a grid, see `Line.of`."""
        spans = [(one.low, one.high) for one in priors]
        for _ in range(4):
            grids = [_even(*span) for span in spans]
            plane = cls._filled(cross, priors, grids, len(log_weight))
            counts = (plane.log_part + log_weight[:, None, None]).max(axis=0)
            near = counts > counts.max() - KEPT
            new = [
                _narrowed(grid, near.any(axis=1 - axis), prior)
                for axis, (grid, prior) in enumerate(zip(grids, priors, strict=True))
            ]
            done = all(
                prior.fixed or near.any(axis=1 - axis).sum() > FEW // 3
                for axis, prior in enumerate(priors)
            )
            if done:
                break
            spans = new
        return plane

    @classmethod
    def _filled(
        cls,
        cross: Sequence[Cross],
        priors: tuple[StrengthPrior, StrengthPrior],
        grids: list[tuple[Array, float]],
        rows: int,
    ) -> Plane:
        (x, wide), (y, high) = grids
        part = gain_across(cross, x, y, rows)
        part += priors[0].log_density(x)[:, None] + priors[1].log_density(y)
        return cls(x, y, (wide, high), part)

    @property
    def log_integral(self) -> Array:
        """Logarithm of likelihood gain times prior, integrated over both strengths, (n,)."""
        steps = sum(np.log(width) for width in self.widths if width)
        flat = self.log_part.reshape(len(self.log_part), -1).copy()
        return np.asarray(log_sum(flat) + steps)

    def draw(self, rng: np.random.Generator) -> tuple[Array, Array]:
        """Return two strengths for each draw, (n, 2), and the log density they were drawn with."""
        count, g, h = self.log_part.shape
        bin_, share = _picked(self.log_part.reshape(count, g * h), rng)
        inside = rng.random((count, 2)) - 0.5
        x = np.column_stack([self.first[bin_ // h], self.second[bin_ % h]])
        x += inside * np.array(self.widths)
        steps = sum(np.log(width) for width in self.widths if width)
        return x, np.log(share) - steps


def _picked(log_part: Array, rng: np.random.Generator) -> tuple[Array, Array]:
    """Return a bin for each row of logarithms, (n,), and the probability it was picked with.

    Some come from a wider density and a few from all bins alike: the grid is not the likelihood
    itself, and so no weight is far above the others.
    """
    count, bins = log_part.shape
    relative = log_part - log_part.max(axis=1, keepdims=True)
    part, wide = np.exp(relative), np.exp(_FLATTENED * relative)
    share = (1.0 - _WIDE - _EVEN) / part.sum(axis=1, keepdims=True) * part
    share += _WIDE / wide.sum(axis=1, keepdims=True) * wide
    share += _EVEN / bins
    cumulative = np.cumsum(share, axis=1)
    asked = rng.random(count) * cumulative[:, -1]
    found = np.minimum(np.sum(cumulative < asked[:, None], axis=1), bins - 1)
    return found, share[np.arange(count), found]


def _even(low: float, high: float) -> tuple[Array, float]:
    """Return middles of bins between two strengths, and their width."""
    if low == high:
        return np.array([low]), 0.0
    width = (high - low) / FEW
    return low + width * (np.arange(FEW) + 0.5), width


def _narrowed(grid: tuple[Array, float], near: Array, prior: StrengthPrior) -> tuple[float, float]:
    x, width = grid
    at = np.flatnonzero(near)
    return max(prior.low, x[at[0]] - width), min(prior.high, x[at[-1]] + width)
