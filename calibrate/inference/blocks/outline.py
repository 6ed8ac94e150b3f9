"""The posterior of the common unknowns as the blocks' fitted mixtures tell it, in closed form.

It costs no prediction, so it may be searched and sampled as often as is useful.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy import special

from calibrate.arrays import Array
from calibrate.inference.blocks.site import Conditional, Site
from calibrate.inference.blocks.structure import Block, Split
from calibrate.inference.blocks.tied import moments
from calibrate.inference.likelihood import IMPOSSIBLE, log_likelihood
from calibrate.inference.priors import TINY
from calibrate.inference.sampler.target import central_derivatives, log_prior

__all__ = ["Common", "Outline"]

_LEAST: Final = 1e-9  # of the range: a smaller spread is none, and would cost digits


@dataclass(frozen=True, eq=False)
class Common:
    """Points of the common unknowns: coordinates and what they mean.

    Attributes
    ----------
    z, values, units : (n, K) float64
        Of the whole problem; columns that are not common mean nothing.
    """

    z: Array
    values: Array
    units: Array

    @classmethod
    def of(cls, split: Split, g: Array) -> Common:
        """Return the points of common coordinates, (n, g)."""
        space = split.problem.space
        z = np.zeros((len(g), space.size))
        z[:, split.common] = g
        values = space.from_normal(z)
        return cls(z, values, space.units(values))

    def shared(self, split: Split, block: Block) -> Array:
        """Return the coordinates, (n, e), of the common unknowns as a block sees them."""
        tied = {i for tie in split.problem.space.ties for i in tie.members}
        columns = [
            special.ndtri(np.clip(self.units[:, i], TINY, 1.0 - TINY))
            if i in tied
            else self.z[:, i]
            for i in block.shared
        ]
        return np.column_stack(columns) if columns else np.zeros((len(self.z), 0))

    def tie(self, column: int) -> tuple[Array, Array]:
        """Return mean and spread, (n,), on the unit range, of the tie whose mean is a column."""
        return self.units[:, column], np.maximum(self.values[:, column + 1], _LEAST)

    def priors(self, block: Block) -> tuple[Array, Array]:
        """Return mean and deviation, (n, d), of the normal prior of a block's coordinates."""
        centre = np.zeros((len(self.z), len(block.own)))
        wide = np.ones_like(centre)
        for k, column in enumerate(block.ties):
            if column >= 0:
                centre[:, k], wide[:, k] = moments(*self.tie(column))
        return centre, wide

    def given(self, split: Split, block: Block, site: Site) -> Conditional:
        """Return the unknowns of a block given these points."""
        return site.given(self.shared(split, block), *self.priors(block))


@dataclass
class Outline:
    """Log posterior of the common unknowns as the sites tell it; a `Density`.

    Attributes
    ----------
    split : Split
    sites : tuple of Site
    """

    split: Split
    sites: tuple[Site, ...]

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return len(self.split.common)

    def progress(self, fraction: float, /) -> None:
        """Tell nobody: it is quick."""

    def log_posterior(self, z: Array) -> Array:
        """Return the log density, (n,), at common coordinates (n, g)."""
        total = log_prior(z)
        good = total > IMPOSSIBLE
        common = Common.of(self.split, z[good])
        found = log_likelihood(self.split.rest, common.values)
        for block, site in zip(self.split.blocks, self.sites, strict=True):
            found = found + common.given(self.split, block, site).log_total
        total[good] += found
        return np.asarray(np.maximum(total, IMPOSSIBLE))

    def derivatives(self, z: Array) -> tuple[Array, Array]:
        """Return gradient and Hessian by differences."""
        return central_derivatives(self.log_posterior, z)
