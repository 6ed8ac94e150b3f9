"""The bench, straight around the best values of the base model: thousands of imagined studies.

Everything measured is y = J z + what causes add + errors of unit variance, z with the unit normal
as prior; so what is left has the covariance K = 1 + J J^T. One cause of strength x is then told by
one number of a study, t = a^T K^-1 y / sqrt(I) with the information I = a^T K^-1 a, which is
normal about x sqrt(I) with a variance of 1 + d x^2, d because the answer to the cause is known
from few runs. A cause whose answer bends is judged by all of y.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.linalg import cho_factor, cho_solve, cholesky

from calibrate.arrays import Array, log_sum
from calibrate.causes.candidates import Board
from calibrate.causes.strengths.prior import StrengthPrior
from calibrate.causes.weighing.effects import added_by
from calibrate.causes.weighing.tangent import Tangent

__all__ = ["Straight", "straight_at"]

NODES: Final = 41
NOTHING: Final = 1e-12
BENT: Final = 0.05
"""Share of the squared answer to an ordinary strength, twice of it, from which it is bent."""


@dataclass(frozen=True, eq=False)
class Straight:
    """The bench around one point; N numbers, c candidates.

    Attributes
    ----------
    names : tuple of str
    slopes : (N, K) float64
        J.
    answers, bends : (N, c) float64
        What each cause adds per strength, and per squared strength.
    doubts : (c,) float64
        d.
    luck : (c,) float64
        By how much I is larger, on average, because the luck of the runs behind an answer is taken
        for a part of it.
    inverse : (N, N) float64
        K^-1.
    root : (N, N) float64
        Lower factor of K.
    priors : tuple of StrengthPrior
    """

    names: tuple[str, ...]
    slopes: Array
    answers: Array
    bends: Array
    doubts: Array
    luck: Array
    inverse: Array
    root: Array
    priors: tuple[StrengthPrior, ...]

    @property
    def information(self) -> Array:
        """I of each cause, (c,)."""
        return np.asarray(np.einsum("ic,ij,jc->c", self.answers, self.inverse, self.answers))

    def bent(self, k: int) -> bool:
        """Whether the answer to a cause is far from straight at the strengths it may have."""
        a, c, s = self.answers[:, k], self.bends[:, k], self.priors[k].width
        return bool(s**2 * (c @ self.inverse @ c) > BENT * (a @ self.inverse @ a) + NOTHING)

    def added(self, k: int, x: Array) -> Array:
        """Return what a cause adds at strengths (B,), (B, N)."""
        both = np.multiply.outer
        return np.asarray(both(x, self.answers[:, k]) + both(x**2, self.bends[:, k]))

    def imagine(self, count: int, rng: np.random.Generator) -> Array:
        """Return studies without any cause, (count, N)."""
        return np.asarray(rng.standard_normal((count, len(self.root))) @ self.root.T)

    def with_cause(self, k: int, x: Array, rng: np.random.Generator) -> Array:
        """Return studies with a cause of strengths (B,), (B, N), as far as its answer is known."""
        y = self.imagine(len(x), rng) + self.added(k, x)
        size = np.sqrt(self.doubts[k] / max(float(self.information[k]), NOTHING))
        return np.asarray(
            y + (size * x * rng.standard_normal(len(x)))[:, None] * self.answers[:, k]
        )

    def log_ratios(self, y: Array) -> Array:
        """Return log evidence ratios of all causes for studies (B, N), (B, c)."""
        found = np.zeros((len(y), len(self.names)))
        for k in range(len(self.names)):
            found[:, k] = self._log_ratio(k, y)
        return found

    def _log_ratio(self, k: int, y: Array) -> Array:
        prior = self.priors[k]
        x, width = _nodes(prior)
        a, c = self.answers[:, k], self.bends[:, k]
        turned = self.inverse @ np.column_stack([a, c])
        ra, rc = (y @ turned).T
        aa, ac, cc = a @ turned[:, 0], c @ turned[:, 0], c @ turned[:, 1]
        if self.bent(k):
            square = x**2 * aa + 2.0 * x**3 * ac + x**4 * cc
            gain = np.multiply.outer(ra, x) + np.multiply.outer(rc, x**2) - 0.5 * square
        else:
            size = np.sqrt(max(aa, NOTHING))
            t = (ra / size)[:, None]
            spread = 1.0 + self.doubts[k] * x**2
            gain = 0.5 * (t**2 - (t - size * x) ** 2 / spread - np.log(spread))
        step = np.log(width) if width else 0.0
        return np.asarray(log_sum(gain + prior.log_density(x)) + step)


def _nodes(prior: StrengthPrior) -> tuple[Array, float]:
    if prior.fixed:
        return np.array([prior.low]), 0.0
    width = (prior.high - prior.low) / NODES
    return prior.low + width * (np.arange(NODES) + 0.5), width


def straight_at(board: Board, tangent: Tangent) -> Straight:
    """Return the bench, straight around a point."""
    count = len(tangent.left)
    answers, bends, doubts, luck = [], [], [], []
    inverse = cho_solve(cho_factor(tangent.covariance), np.eye(count))
    for one in board.candidates:
        added = added_by(tangent.bench, one)
        a, c = tangent.stacked(added)
        spread = np.zeros(count)
        for k, grown in added.doubts.items():
            spread[tangent.spans[k]] = grown[0]
        turned = inverse @ a
        answers.append(a)
        bends.append(c)
        doubts.append(float(turned**2 @ spread / max(a @ turned, NOTHING)))
        luck.append(float(np.diag(inverse) @ spread))
    return Straight(
        tuple(one.name for one in board.candidates),
        tangent.slopes,
        np.column_stack(answers) if answers else np.zeros((count, 0)),
        np.column_stack(bends) if bends else np.zeros((count, 0)),
        np.array(doubts),
        np.array(luck),
        inverse,
        cholesky(tangent.covariance, lower=True),
        tuple(board.strength_prior(one) for one in board.candidates),
    )
