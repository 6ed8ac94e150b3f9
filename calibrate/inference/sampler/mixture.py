"""Mixtures of multivariate t distributions: what importance samplers draw from."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy import special
from scipy.linalg import cholesky, solve_triangular

from calibrate.arrays import Array, log_sum

__all__ = ["Mixture", "effective_size"]

_RARE: Final = 1e-3  # least weight of a component: what was found once stays looked at
_HEAVIEST: Final = 0.005  # share of all weight that one point has at most in a fit
_RIDGE: Final = 1e-8
_AS_NORMAL: Final = 1e6


@dataclass(frozen=True, eq=False)
class Mixture:
    """Weighted multivariate t distributions.

    Attributes
    ----------
    weights : (c,) float64
    means : (c, K) float64
    covariances : (c, K, K) float64
        Of the normals that the t distributions widen.
    dof : float
        Degrees of freedom; the tails are heavier than those of what is sampled.
    """

    weights: Array
    means: Array
    covariances: Array
    dof: float

    @classmethod
    def prior(cls, size: int) -> Mixture:
        """Return the unit normal of `size` coordinates, nearly: t with many degrees of freedom."""
        return cls(np.ones(1), np.zeros((1, size)), np.eye(size)[None], _AS_NORMAL)

    def roots(self) -> Array:
        """Return the lower Cholesky factors of the covariances, (c, K, K)."""
        return np.array([cholesky(one, lower=True) for one in self.covariances])

    def draw(self, count: int, rng: np.random.Generator) -> Array:
        """Return points, (count, K); every component gets its share, rounded at random."""
        which = np.searchsorted(
            np.cumsum(self.weights), (rng.random() + np.arange(count)) / count, side="right"
        )
        which = np.minimum(which, len(self.weights) - 1)
        normal = rng.standard_normal((count, self.means.shape[1]))
        wide = np.sqrt(self.dof / rng.chisquare(self.dof, count))
        roots = self.roots()
        shifted = np.empty_like(normal)
        for c in range(len(self.weights)):
            rows = which == c
            shifted[rows] = self.means[c] + wide[rows, None] * (normal[rows] @ roots[c].T)
        return shifted

    def log_parts(self, z: Array) -> Array:
        """Return the log density of every component, its weight included, (n, c)."""
        size = z.shape[1]
        constant = float(
            special.gammaln(0.5 * (self.dof + size))
            - special.gammaln(0.5 * self.dof)
            - 0.5 * size * math.log(self.dof * math.pi)
        )
        parts = []
        for weight, mean, root in zip(self.weights, self.means, self.roots(), strict=True):
            # A product with the inverse takes half the time of solving for every point.
            x = (z - mean) @ solve_triangular(root, np.eye(size), lower=True).T
            power = -0.5 * (self.dof + size) * np.log1p(np.einsum("ij,ij->i", x, x) / self.dof)
            parts.append(math.log(weight) + constant + power - float(np.log(np.diag(root)).sum()))
        return np.column_stack(parts)

    def log_density(self, z: Array) -> Array:
        """Return the log density, (n,), at points (n, K)."""
        return log_sum(self.log_parts(z))

    def joined(self, mean: Array, covariance: Array, weight: float) -> Mixture:
        """Return the mixture with one more component of a given weight."""
        return Mixture(
            np.append((1.0 - weight) * self.weights, weight),
            np.vstack([self.means, mean]),
            np.concatenate([self.covariances, covariance[None]]),
            self.dof,
        )

    def refitted(self, z: Array, weights: Array, steps: int = 1) -> Mixture:
        """Return the mixture moved towards weighted points by expectation maximisation.

        A mean or a covariance moves as far as the points behind it can tell it; the rest stays
        with what the mixture said before. No point counts for more than a 200th of all: where few
        have the weight, they are where the mixture is thin, not where most of the posterior is.

        Parameters
        ----------
        z : (n, K) float64
        weights : (n,) float64
            Sum 1.
        steps : int
        """
        held = np.minimum(weights, max(_HEAVIEST, 1.0 / len(z)))
        held /= held.sum()
        now = self
        for _ in range(steps):
            parts = now.log_parts(z)
            share = np.exp(parts - special.logsumexp(parts, axis=1, keepdims=True))
            own = held[:, None] * share
            fits = [self._component(c, z, own[:, c]) for c in range(len(self.weights))]
            shares = np.maximum(own.sum(axis=0), _RARE)
            means, covariances = (np.array(part) for part in zip(*fits, strict=True))
            now = Mixture(shares / shares.sum(), means, covariances, self.dof)
        return now

    def _component(self, c: int, z: Array, weights: Array) -> tuple[Array, Array]:
        """Return mean and covariance of a component between what it was and weighted points."""
        total, size = float(weights.sum()), z.shape[1]
        if not total > 0.0:
            return self.means[c], self.covariances[c]
        count = effective_size(weights)
        mean = weights @ z / total
        centred = z - mean
        seen = (centred * weights[:, None]).T @ centred / total
        trust = count / (count + size)
        # A covariance of K^2 / 2 numbers needs as many points as that.
        trust_wide = count / (count + 0.5 * size**2)
        blended = trust_wide * seen + (1.0 - trust_wide) * self.covariances[c]
        return (
            self.means[c] + trust * (mean - self.means[c]),
            blended + _RIDGE * np.eye(size),
        )


def effective_size(weights: Array) -> float:
    """Return how many draws of equal weight tell as much, by (sum w)^2 / sum w^2.

    Examples
    --------
    >>> import numpy as np
    >>> effective_size(np.array([1.0, 1.0, 0.0]))
    2.0
    """
    squares = float(np.sum(weights**2))
    return float(np.sum(weights)) ** 2 / squares if squares > 0.0 else 0.0
