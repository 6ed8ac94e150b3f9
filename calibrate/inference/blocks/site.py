"""What one block says of its unknowns, as a mixture of normals, and what follows given the rest.

Q(w, s), a mixture fitted to the block's posterior with unit-normal priors of its own coordinates w
and of the common ones s, divided by the prior of s is what the block says. Times the prior that a
tie gives its members, N(a, b^2), it is again a mixture in closed form: from it the block's unknowns
are drawn, and its integral is how probable the block's data are for these common unknowns. For
informative data it is a normal around them, without data it is the prior, whatever the spread: so
neither the members nor their deviations from the mean need be chosen as coordinates.

Shapes: n points of the common unknowns, r draws each, c components, d own unknowns, e shared ones.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy import special

from calibrate.arrays import Array
from calibrate.inference.sampler.laplace import DOF
from calibrate.inference.sampler.mixture import Mixture

__all__ = ["Conditional", "Site"]


@dataclass(frozen=True, eq=False)
class Conditional:
    """Mixture of t distributions of the own unknowns at n points of the common ones.

    Attributes
    ----------
    log_parts : (n, c) float64
        Logarithm of the integral of every component; their sum is what the block says.
    means : (n, c, d) float64
    roots : (n, c, d, d) float64
        Lower Cholesky factors of the precisions.
    """

    log_parts: Array
    means: Array
    roots: Array

    @property
    def log_total(self) -> Array:
        """Logarithm of the sum of the components' integrals, (n,)."""
        return np.asarray(special.logsumexp(self.log_parts, axis=1))

    def draw(self, count: int, rng: np.random.Generator) -> Array:
        """Return own unknowns, (n, count, d)."""
        n, _, d = self.means.shape
        share = np.cumsum(np.exp(self.log_parts - self.log_total[:, None]), axis=1)
        at = (rng.random((n, 1)) + np.arange(count)) / count  # every component gets its share
        which = np.sum(at[:, :, None] > share[:, None, :-1], axis=2)
        row = np.arange(n)[:, None]
        normal = rng.standard_normal((n, count, d, 1))
        wide = np.sqrt(DOF / rng.chisquare(DOF, (n, count, 1)))
        away = np.linalg.solve(np.swapaxes(self.roots[row, which], 2, 3), normal)[..., 0]
        return np.asarray(self.means[row, which] + wide * away)

    def log_density(self, w: Array) -> Array:
        """Return the log density, (n, r), of own unknowns (n, r, d)."""
        d = w.shape[2]
        constant = float(special.gammaln(0.5 * (DOF + d)) - special.gammaln(0.5 * DOF))
        constant -= 0.5 * d * math.log(DOF * math.pi)
        parts = []
        share = self.log_parts - self.log_total[:, None]
        for c in range(self.means.shape[1]):
            x = (w - self.means[:, None, c]) @ self.roots[:, c]
            power = -0.5 * (DOF + d) * np.log1p(np.sum(x**2, axis=2) / DOF)
            half = np.log(np.diagonal(self.roots[:, c], axis1=1, axis2=2)).sum(axis=1)
            parts.append(power + (half + share[:, c])[:, None])
        return np.asarray(special.logsumexp(parts, axis=0) + constant)


@dataclass(frozen=True, eq=False)
class Site:
    """A fitted mixture of a block, cut into own and shared coordinates.

    Attributes
    ----------
    log_weights : (c,) float64
        Log evidence of the block alone included.
    own, shared : (c, d), (c, e) float64
        Means.
    inner : (c, d, d) float64
        Precision of the own coordinates given the shared ones.
    slopes : (c, d, e) float64
        How their mean moves with the shared ones.
    outer : (c, e, e) float64
        Covariance of the shared ones.
    """

    log_weights: Array
    own: Array
    shared: Array
    inner: Array
    slopes: Array
    outer: Array

    @classmethod
    def of(cls, mixture: Mixture, log_evidence: float, own: int) -> Site:
        """Return the site of a mixture whose first `own` coordinates are the block's."""
        precision = np.linalg.inv(mixture.covariances)
        inner = precision[:, :own, :own]
        return cls(
            np.log(mixture.weights) + log_evidence,
            mixture.means[:, :own],
            mixture.means[:, own:],
            inner,
            -np.linalg.solve(inner, precision[:, :own, own:]),
            mixture.covariances[:, own:, own:],
        )

    def given(self, shared: Array, centre: Array, wide: Array) -> Conditional:
        """Return the own unknowns given the common ones.

        Parameters
        ----------
        shared : (n, e) float64
            Common coordinates that act here.
        centre, wide : (n, d) float64
            Normal prior of each own coordinate; 0 and 1 where it has no tie.
        """
        wide = np.minimum(wide, 1.0)  # nothing is wider than the flat prior that is in the site
        more = 1.0 / wide**2 - 1.0
        before = 0.5 * np.sum(centre**2, axis=1) - np.log(wide).sum(axis=1)
        log_parts, means, roots = [], [], []
        d = self.own.shape[1]
        for c in range(len(self.own)):
            away = shared - self.shared[c]
            # Counted from the prior's centre, so that a narrow prior costs no digits.
            mean = self.own[c] + away @ self.slopes[c].T - centre
            total = self.inner[c] + more[:, :, None] * np.eye(d)
            lift = mean @ self.inner[c] + centre
            root = np.linalg.cholesky(total)
            new = np.linalg.solve(total, lift[:, :, None])[:, :, 0]
            part = self._of_shared(c, shared) + before + 0.5 * np.sum(lift * new, axis=1)
            part += 0.5 * np.linalg.slogdet(self.inner[c])[1]
            part -= 0.5 * np.einsum("ni,ij,nj->n", mean, self.inner[c], mean)
            part -= np.log(np.diagonal(root, axis1=1, axis2=2)).sum(axis=1)
            log_parts.append(part)
            means.append(centre + new)
            roots.append(root)
        return Conditional(np.stack(log_parts, 1), np.stack(means, 1), np.stack(roots, 1))

    def _of_shared(self, c: int, shared: Array) -> Array:
        """Return the log of weight times density of the shared coordinates over their prior."""
        away = shared - self.shared[c]
        if not shared.shape[1]:
            return np.full(len(shared), self.log_weights[c])
        power = np.sum(away * np.linalg.solve(self.outer[c], away.T).T, axis=1)
        height = -0.5 * np.linalg.slogdet(self.outer[c])[1]
        return np.asarray(self.log_weights[c] + height - 0.5 * power + 0.5 * np.sum(shared**2, 1))
