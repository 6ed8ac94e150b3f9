"""What one effect adds to one number of one experiment, learnt from runs with it.

Most of them are twins: a run once more with the effect on, same parameters, same seed. With m(u)
what is expected without the effect,

    y(u, s) - m(u) = s (a + b.(u - 1/2) + g(u) + o) + s^2 c + s ln s d + k (y(u, 0) - m(u)) + noise

with strengths s in ordinary ones, g smooth as the output itself is (its correlation lengths are
held), o what the answer at a point has of its own (repeats tell it from luck), k the part of a
run's luck that its twin shares, and all of them normal about zero with variances that are learnt;
d only where s cannot be negative: glued plates that slip a little answer far more per strength than
those that slip a lot. k is 1 where an effect leaves the run as it is; but grains collide in another
order after the least change, and then little is shared: a plain difference of twins would have the
luck of two runs. What a run without a twin would share adds to its noise. The noise has the
variance v + w s^2: heaps of grains that stick scatter more than others. Other effects have no part
in it: one candidate more changes nothing of the others.
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

CENTRES: Final = np.log([0.05, 0.02, 0.02, 0.002, 0.005, 0.0005, 0.1, 0.02, 0.0005])
SPREADS: Final = np.array([2.5, 2.5, 2.0, 2.0, 2.0, 2.0, 1.5, 2.5, 2.0])
LOWEST: Final = np.log([1e-8, 1e-8, 1e-8, 1e-9, 1e-9, 1e-9, 1e-4, 1e-8, 1e-9])
HIGHEST: Final = np.log([1e3, 1e3, 1e2, 1e1, 1e1, 1e1, 4.0, 4.0, 1e1])
"""Of the variances of a, of each b, of g, of c, of d, of o, of k, of the noise and of its growth w,
in variances of the output per ordinary strength (k: as it is): weak priors of their logarithms, and
limits."""
WITHOUT_LUCK: Final = 6
"""How many of them belong to the change itself."""
CURL: Final = 4
"""Which of them is d."""
LOW, HIGH = 1.0, 2.5
"""Ordinary strengths at which a parabola stands for s ln s where one is asked for."""
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
    variances : (9,) float64
        Of a, b, g, c, d, o, k, the noise and w, relative to the size.
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
        shape = _shape(self.lengths, self.variances, u, self.twins.u)
        between = self._between(shape, strength)
        return self.scale * (between @ self._weights), self._spread(between, u, strength)

    def parts(self, u: Array, usual: float) -> tuple[Array, Array, Array]:
        """Return the change at n inputs per strength and per squared strength, and how sure it is.

        Parameters
        ----------
        u : (n, d) float64
        usual : float
            Strength at which it is uncertain by the last.

        Returns
        -------
        slope, bend : (n,) float64
        doubt : (n,) float64
            Standard deviation of the change at the usual strength, per strength.
        """
        if self.scale == 0.0:
            return np.zeros(len(u)), np.zeros(len(u)), np.zeros(len(u))
        *_, bend, curl, _ = self.variances[:WITHOUT_LUCK]
        shape = _shape(self.lengths, self.variances, u, self.twins.u)
        own = self._weights * self.twins.strength
        bent = float(self._weights @ self.twins.strength**2) * bend
        # A parabola that meets s ln s at two strengths.
        steep, flat = np.log([HIGH, LOW])
        curled = float(self._weights @ _curl(self.twins.strength)) * curl
        bent += curled * (steep - flat) / (HIGH - LOW)
        straight = curled * (HIGH * flat - LOW * steep) / (HIGH - LOW)
        slope = self.scale * (shape @ own + straight)
        bends = np.full(len(u), self.scale * bent)
        strength = np.array([usual])
        spread = self._spread(self._between(shape, strength), u, strength)
        return slope, bends, np.sqrt(spread) / abs(usual)

    def _between(self, shape: Array, strength: Array) -> Array:
        """Return the covariance of changes at n inputs with those of the twins, (n, n_twins).

        Strengths are (n,), or (1,) where all are the same.
        """
        *_, bend, curl, _ = self.variances[:WITHOUT_LUCK]
        both = np.multiply.outer(strength, self.twins.strength)
        found = both * shape
        found += bend * both**2
        if curl > 0.0:
            found += curl * np.multiply.outer(_curl(strength), _curl(self.twins.strength))
        return np.asarray(found)

    def _spread(self, between: Array, u: Array, strength: Array) -> Array:
        level, tilt, smooth, bend, curl, own = self.variances[:WITHOUT_LUCK]
        away = np.sum((u - MIDDLE) ** 2, axis=1)
        spread = strength**2 * (level + tilt * away + smooth + own) + strength**4 * bend
        spread += curl * _curl(strength) ** 2
        spread -= np.einsum("ij,ij->i", between @ self._inverse, between)
        return np.asarray(self.inflation * self.scale**2 * np.maximum(spread, 0.0))


def _curl(strength: Array) -> Array:
    """Return s ln s, 0 at 0 and below."""
    size = np.maximum(strength, np.finfo(float).tiny)
    return np.asarray(np.where(strength > 0.0, strength * np.log(size), 0.0))


def _shape(lengths: Array, variances: Array, a: Array, b: Array) -> Array:
    level, tilt, smooth = variances[:3]
    found = matern_between(a / lengths, b / lengths)
    found *= smooth
    found += (a - MIDDLE) @ (tilt * (b - MIDDLE)).T
    found += level
    return np.asarray(found)


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
    curled = np.multiply.outer(_curl(twins.strength), _curl(twins.strength))
    if twins.strength.min() < 0.0:
        curled = np.zeros_like(both)
    _, point = np.unique(twins.u, axis=0, return_inverse=True)
    same = np.equal.outer(point.ravel(), point.ravel())
    alone, growing = np.eye(len(y)), np.diag(twins.strength**2)
    bases = np.array(
        [both, both * tilted, both * alike, both**2, curled, both * same, shared, alone, growing]
    )
    found = minimize(
        _objective, CENTRES, (bases, y), jac=True, method="L-BFGS-B",
        bounds=list(zip(LOWEST, HIGHEST, strict=True)), options={"maxiter": STEPS},
    )  # fmt: skip
    variances = np.exp(found.x)
    if not curled.any():
        variances[CURL] = 0.0
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
