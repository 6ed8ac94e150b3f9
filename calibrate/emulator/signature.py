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
from scipy.linalg import cho_factor, cho_solve
from scipy.optimize import minimize

from calibrate.arrays import Array
from calibrate.emulator.covariance import MIDDLE, matern_between

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
QUICK, SLOW = 0.3, 1.0
"""Correlation lengths of both parts of h, in ln(1 + |s|)."""
ONE_SIDED: Final = (1.0, 2.5)
TWO_SIDED: Final = (-2.0, 2.0)
"""Ordinary strengths at which a parabola stands for the answer where one is asked for."""
STEPS: Final = 100
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
    _inverse: Array
    _weights: Array

    def predict(self, u: Array, strength: Array) -> tuple[Array, Array]:
        """Return mean and variance of the change at n inputs, each (n,)."""
        if self.scale == 0.0:
            return np.zeros(len(u)), np.zeros(len(u))
        between = self._between(self._alike(u), u, strength)
        return self.scale * (between @ self._weights), self._spread(between, u, strength)

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
        between, beside = (self._between(alike, u, np.array([s])) for s in (far, near))
        steep, flat = (
            self.scale * (one @ self._weights) / s for one, s in ((between, far), (beside, near))
        )
        bend = (steep - flat) / (far - near)
        spread = self._spread(between, u, np.array([far]))
        return steep - far * bend, bend, np.sqrt(spread) / abs(far)

    def _alike(self, u: Array) -> Array:
        return np.asarray(matern_between(u / self.lengths, self.twins.u / self.lengths))

    def _between(self, alike: Array, u: Array, strength: Array) -> Array:
        """Return the covariance of changes at n inputs with those of the twins, (n, n_twins).

        Strengths are (n,), or (1,) where all are the same.
        """
        level, tilt, smooth, bend, _, quick, slow = self.variances[:WITHOUT_LUCK]
        others = self.twins.strength
        both = np.multiply.outer(strength, others)
        found = smooth * both
        found += quick * _shaped(strength, others, QUICK)
        found += slow * _shaped(strength, others, SLOW)
        found = found * alike
        shape = (u - MIDDLE) @ (tilt * (self.twins.u - MIDDLE)).T
        shape += level
        shape += bend * both
        found += shape * both
        return np.asarray(found)

    def _spread(self, between: Array, u: Array, strength: Array) -> Array:
        level, tilt, smooth, bend, own, quick, slow = self.variances[:WITHOUT_LUCK]
        away = np.sum((u - MIDDLE) ** 2, axis=1)
        spread = strength**2 * (level + tilt * away + smooth + own) + strength**4 * bend
        spread += quick * (1.0 - _to_none(strength, QUICK) ** 2)
        spread += slow * (1.0 - _to_none(strength, SLOW) ** 2)
        spread -= np.einsum("ij,ij->i", between @ self._inverse, between)
        return np.asarray(self.inflation * self.scale**2 * np.maximum(spread, 0.0))


def _shaped(a: Array, b: Array, length: float) -> Array:
    """Return correlations of what is none at none and smooth in the logarithm of the strength."""
    apart = np.subtract.outer(_log(a), _log(b)) / length
    found = np.exp(-0.5 * apart**2)
    found -= np.multiply.outer(_to_none(a, length), _to_none(b, length))
    return np.asarray(found)


def _to_none(strength: Array, length: float) -> Array:
    return np.asarray(np.exp(-0.5 * (_log(strength) / length) ** 2))


def _log(strength: Array) -> Array:
    return np.asarray(np.sign(strength) * np.log1p(np.abs(strength)))


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
        return Signature(lengths, 0.0, np.zeros(len(CENTRES)), 1.0, twins, none, np.zeros(0))
    y, luck = twins.change / scale, twins.luck / scale
    both = np.multiply.outer(twins.strength, twins.strength)
    alike = matern_between(twins.u / lengths, twins.u / lengths)
    tilted = (twins.u - MIDDLE) @ (twins.u - MIDDLE).T
    shared = np.multiply.outer(luck, luck)
    # What a run without a twin would share with it is luck that nobody knows.
    shared[np.diag_indices_from(shared)] += np.where(paired, 0.0, np.mean(luck[whole] ** 2))
    quick, slow = (alike * _shaped(twins.strength, twins.strength, x) for x in (QUICK, SLOW))
    _, point = np.unique(twins.u, axis=0, return_inverse=True)
    same = np.equal.outer(point.ravel(), point.ravel())
    alone, growing = np.eye(len(y)), np.diag(twins.strength**2)
    bases = np.array(
        [
            both,
            both * tilted,
            both * alike,
            both**2,
            both * same,
            quick,
            slow,
            shared,
            alone,
            growing,
        ]
    )
    found = minimize(
        _objective, CENTRES, (bases, y), jac=True, method="L-BFGS-B",
        bounds=list(zip(LOWEST, HIGHEST, strict=True)), options={"maxiter": STEPS},
    )  # fmt: skip
    variances = np.exp(found.x)
    inverse = np.linalg.inv(np.tensordot(variances, bases, axes=1))
    weights = inverse @ y
    # Left-out differences of twins over their expected sizes (Rasmussen & Williams, eq. 5.12).
    left_out = weights**2 / np.diag(inverse)
    learnt = min((len(y) + 4.0) / max(len(y) - 4.0, 1.0), MOST_LEARNT)
    inflation = max(1.0, float(np.mean(left_out))) * learnt
    return Signature(lengths, scale, variances, inflation, twins, inverse, weights)


def _objective(theta: Array, bases: Array, y: Array) -> tuple[float, Array]:
    """Return minus the log posterior density of the variances' logarithms, and its gradient."""
    variances = np.exp(theta)
    total = np.tensordot(variances, bases, axes=1)
    total[np.diag_indices_from(total)] += 1e-10 * np.trace(total) / len(y)
    factor = cho_factor(total, lower=True, check_finite=False)
    inverse = cho_solve(factor, np.eye(len(y)), check_finite=False)
    weights = inverse @ y
    away = (theta - CENTRES) / SPREADS
    value = 0.5 * float(y @ weights) + float(np.log(np.diag(factor[0])).sum())
    rest = inverse - np.multiply.outer(weights, weights)
    slope = 0.5 * variances * np.einsum("ij,kij->k", rest, bases)
    return value + 0.5 * float(away @ away), slope + away / SPREADS
