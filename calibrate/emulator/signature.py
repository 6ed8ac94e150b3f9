"""What one effect adds to one number of one experiment, learnt from runs with it.

Most of them are twins: a run once more with the effect on, same parameters, same seed. With m(u)
what is expected without the effect,

    y(u, s) - m(u) = s (a + b.(u - 1/2) + g(u) + o) + s^2 c + h(u, s) + k (y(u, 0) - m(u)) + noise

with strengths s in ordinary ones, g smooth as the output itself is (its correlation lengths are
held), h as smooth in u, none at none and of any shape in s, o what the answer at a point has of its
own (repeats tell it from luck), k the part of a run's luck that its twin shares, and all of them
normal about zero with variances that are learnt. A glued plate holds until friction gives way,
restitution that falls with speed empties one box and then fills it: no parabola with one bend for
all parameters is like that. h is smooth in sign(s) ln(1 + |s|), so that it may change most at small
strengths, and has a quick and a slow part.

k is 1 where an effect leaves the run as it is; but grains collide in another order after the least
change, and then little is shared: a plain difference of twins would have the luck of two runs. What
a run without a twin would share adds to its noise. The noise has the variance v + w s^2: heaps of
grains that stick scatter more than others. Other effects have no part in it: one candidate more
changes nothing of the others.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.linalg import cho_factor, cho_solve, cholesky, lapack
from scipy.optimize import minimize

from calibrate.arrays import Array
from calibrate.emulator.correlations import answers_between, strengths_of
from calibrate.emulator.covariance import MIDDLE, matern_between, matern_to, turned, whitened

__all__ = ["Signature", "Twins", "learn_signature"]

CENTRES: Final = np.log([0.05, 0.02, 0.02, 0.002, 0.0005, 0.005, 0.005, 0.1, 0.02, 0.0005])
SPREADS: Final = np.array([2.5, 2.5, 2.0, 2.0, 2.0, 2.0, 2.0, 1.5, 2.5, 2.0])
LOWEST: Final = np.log([1e-8, 1e-8, 1e-8, 1e-9, 1e-9, 1e-9, 1e-9, 1e-4, 1e-8, 1e-9])
HIGHEST: Final = np.log([1e3, 1e3, 1e2, 1e1, 1e1, 1e2, 1e2, 4.0, 4.0, 1e1])
"""Of the variances of a, of each b, of g, of c, of o, of both parts of h, of k, of the noise and of
its growth w, in variances of the output per ordinary strength (h and k: as they are): weak priors
of their logarithms, and limits."""
WITHOUT_LUCK: Final = 7
"""How many of them belong to the change itself."""
ONE_SIDED: Final = (1.0, 2.5)
TWO_SIDED: Final = (-2.0, 2.0)
"""Ordinary strengths at which a parabola stands for the answer where one is asked for."""
STEPS: Final = 100
ROUNDING: Final = 1e-10
"""Part of a mean variance."""
MOST_LEARNT: Final = 3.0
"""Largest factor on variances for what few twins tell."""


@dataclass(frozen=True)
class Twins:
    """Runs with an effect, and their twins without it.

    Attributes
    ----------
    u : (n, d) float64
        On [0, 1].
    strength : (n,) float64
        In ordinary strengths, none 0.
    change : (n, ...) float64
        With the effect, minus what is expected without.
    luck : (n, ...) float64
        The twin without the effect, minus what is expected; 0 where nothing is left to luck, and
        for a run without a twin.
    """

    u: Array
    strength: Array
    change: Array
    luck: Array

    def __len__(self) -> int:
        """Return n."""
        return len(self.strength)

    def rows(self, which: Array) -> Twins:
        """Return some of them."""
        return Twins(self.u[which], self.strength[which], self.change[which], self.luck[which])

    def by(self, weights: Array) -> Twins:
        """Return a weighted sum (M, ...) of the M numbers that changed instead of them."""
        return Twins(self.u, self.strength, self.change @ weights, self.luck @ weights)


@dataclass(frozen=True)
class Signature:
    """The answer of one number to one effect.

    Attributes
    ----------
    lengths : (d,) float64
        Correlation lengths of the output.
    scale : float
        Its size; 0 where the effect never changes it.
    variances : (10,) float64
        Of a, b, g, c, o, both parts of h, k, the noise and w, relative to the size.
    inflation : float
        Factor on predicted variances, 1 or more.
    twins : Twins
    """

    lengths: Array
    scale: float
    variances: Array
    inflation: float
    twins: Twins
    _inverse_factor: Array
    _weights: Array
    _others: Array
    _turned: Array

    def predict(self, u: Array, strength: Array) -> tuple[Array, Array]:
        """Return mean and variance of the change at n inputs, each (n,)."""
        if self.scale == 0.0:
            return np.zeros(len(u)), np.zeros(len(u))
        own = strengths_of(strength)
        between = self._between(self._alike(u), u, own)
        return self.scale * (between @ self._weights), self._spread(between, u, own)

    def parts(self, u: Array, at: tuple[float, float] | None = None) -> tuple[Array, Array, Array]:
        """Return the change at n inputs per strength and per squared strength, and how sure it is.

        Parameters
        ----------
        u : (n, d) float64
        at : (float, float), optional
            Different strengths, none of them 0, at which the parabola meets the change; usual ones
            where they are left out.

        Returns
        -------
        slope, bend : (n,) float64
        doubt : (n,) float64
            Standard deviation of the change at the larger of both strengths, per strength.
        """
        if self.scale == 0.0:
            return np.zeros(len(u)), np.zeros(len(u)), np.zeros(len(u))
        low, high = at or (TWO_SIDED if self.twins.strength.min() < 0.0 else ONE_SIDED)
        far, near = (low, high) if abs(low) > abs(high) else (high, low)
        alike = self._alike(u)
        one, other = (strengths_of(np.array([s])) for s in (far, near))
        beside = self._between(alike.copy(), u, other)
        between = self._between(alike, u, one)
        steep, flat = (
            self.scale * (found @ self._weights) / s
            for found, s in ((between, far), (beside, near))
        )
        bend = (steep - flat) / (far - near)
        spread = self._spread(between, u, one)
        return steep - far * bend, bend, np.sqrt(spread) / abs(far)

    def _alike(self, u: Array) -> Array:
        return matern_to(u / self.lengths, self._turned)

    def _between(self, alike: Array, u: Array, own: Array) -> Array:
        """Return the covariance of changes at n inputs with those of the twins, (n, n_twins)."""
        level, tilt, smooth, bend, _, quick, slow = self.variances[:WITHOUT_LUCK]
        trend = (u - MIDDLE) @ (tilt * (self.twins.u - MIDDLE)).T
        trend += level
        return answers_between(alike, trend, own, self._others, (smooth, quick, slow, bend))

    def _spread(self, between: Array, u: Array, own: Array) -> Array:
        """Return the variance of changes, (n,); what `_between` gave is overwritten."""
        level, tilt, smooth, bend, alone, quick, slow = self.variances[:WITHOUT_LUCK]
        strength, _, *to_none = own.T
        away = np.sum((u - MIDDLE) ** 2, axis=1)
        spread = strength**2 * (level + tilt * away + smooth + alone + bend * strength**2)
        for part, none in zip((quick, slow), to_none, strict=True):
            spread += part * (1.0 - none**2)
        known = whitened(self._inverse_factor, between)
        spread -= np.einsum("ij,ij->j", known, known)
        return np.asarray(self.inflation * self.scale**2 * np.maximum(spread, 0.0))


def learn_signature(lengths: Array, scale: float, twins: Twins) -> Signature:
    """Learn the answer of one number from twins.

    Parameters
    ----------
    lengths : (d,) float64
        Correlation lengths of the number without the effect.
    scale : float
        Its size; 0 for one that never changes.
    twins : Twins
        n of them; `change` and `luck` are (n,).
    """
    # An effect that leaves every run as it is has nothing but the luck of its twins.
    paired = twins.luck != 0.0
    whole = paired if paired.any() else np.ones(len(twins), dtype=bool)
    size = float(np.abs((twins.change - twins.luck)[whole]).max(initial=0.0))
    if scale == 0.0 or size == 0.0:
        none = np.zeros((0, 0))
        still = np.zeros(len(CENTRES))
        return Signature(lengths, 0.0, still, 1.0, twins, none, np.zeros(0), none, none)
    y, luck = twins.change / scale, twins.luck / scale
    bases = _bases(twins, luck, lengths)
    found = minimize(
        _objective, CENTRES, (bases, y), jac=True, method="L-BFGS-B",
        bounds=list(zip(LOWEST, HIGHEST, strict=True)), options={"maxiter": STEPS},
    )  # fmt: skip
    variances = np.exp(found.x)
    factor = cholesky(_total(variances, bases), lower=True, overwrite_a=True, check_finite=False)
    inverse_factor, _ = lapack.dtrtri(factor, lower=1)
    weights = cho_solve((factor, True), y, check_finite=False)
    # Left-out differences of twins over their expected sizes (Rasmussen & Williams, eq. 5.12).
    left_out = weights**2 / np.einsum("ij,ij->j", inverse_factor, inverse_factor)
    learnt = min((len(y) + 4.0) / max(len(y) - 4.0, 1.0), MOST_LEARNT)
    inflation = max(1.0, float(np.mean(left_out))) * learnt
    own = strengths_of(twins.strength)
    rows = turned(twins.u / lengths)
    return Signature(
        lengths, scale, variances, inflation, twins, inverse_factor, weights, own, rows
    )


def _bases(twins: Twins, luck: Array, lengths: Array) -> Array:
    """Return what each variance multiplies in the covariance of changes, (10, n, n)."""
    both = np.multiply.outer(twins.strength, twins.strength)
    alike = matern_between(twins.u / lengths, twins.u / lengths)
    tilted = (twins.u - MIDDLE) @ (twins.u - MIDDLE).T
    shared = np.multiply.outer(luck, luck)
    # What a run without a twin would share with it is luck that nobody knows.
    paired = luck != 0.0
    shared[np.diag_indices_from(shared)] += np.where(
        paired, 0.0, np.sum(luck**2) / max(np.count_nonzero(paired), 1)
    )
    others, none = strengths_of(twins.strength), np.zeros_like(alike)
    quick, slow = (
        answers_between(alike.copy(), none, others, others, part)
        for part in ((0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0))
    )
    _, point = np.unique(twins.u, axis=0, return_inverse=True)
    same = np.equal.outer(point.ravel(), point.ravel())
    alone, growing = np.eye(len(twins)), np.diag(twins.strength**2)
    smooth = (both, both * tilted, both * alike, both**2, both * same, quick, slow)
    return np.array([*smooth, shared, alone, growing])


def _total(variances: Array, bases: Array) -> Array:
    """Return the covariance of changes, a little more on its diagonal for rounding, (n, n)."""
    total = np.asarray(np.tensordot(variances, bases, axes=1))
    total[np.diag_indices_from(total)] += ROUNDING * np.trace(total) / len(total)
    return total


def _objective(theta: Array, bases: Array, y: Array) -> tuple[float, Array]:
    """Return minus the log posterior density of the variances' logarithms, and its gradient."""
    variances = np.exp(theta)
    total = _total(variances, bases)
    factor = cho_factor(total, lower=True, check_finite=False)
    inverse = cho_solve(factor, np.eye(len(y)), check_finite=False)
    weights = inverse @ y
    away = (theta - CENTRES) / SPREADS
    value = 0.5 * float(y @ weights) + float(np.log(np.diag(factor[0])).sum())
    rest = inverse - np.multiply.outer(weights, weights)
    slope = 0.5 * variances * np.einsum("ij,kij->k", rest, bases)
    return value + 0.5 * float(away @ away), slope + away / SPREADS
