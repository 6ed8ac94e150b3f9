"""What one effect adds to one number of one experiment, learnt from twins.

A twin is a run once more with the effect on: same parameters, same seed, so that the luck of the
run cancels. The differences of twins are

    y(u, s) - y(u, 0) = s (a + b.(u - 1/2) + g(u)) + s^2 c + noise

with strengths s in ordinary ones, g smooth as the output itself is (its correlation lengths are
held), and all four parts normal about zero with variances that are learnt. Other effects have no
part in it: one candidate more changes nothing of the others.
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

CENTRES: Final = np.log([0.05, 0.02, 0.002, 0.02])
SPREADS: Final = np.array([2.5, 2.0, 2.0, 2.5])
LOWEST: Final = np.log([1e-8, 1e-8, 1e-9, 1e-8])
HIGHEST: Final = np.log([1e3, 1e2, 1e1, 4.0])
"""Of the variances of level and slopes, of g, of the bend and of the noise, in variances of the
output per ordinary strength: weak priors of their logarithms, and limits."""
STEPS: Final = 100
MOST_LEARNT: Final = 3.0
"""Largest factor on variances for what few twins tell."""


@dataclass(frozen=True)
class Twins:
    """Differences of twins.

    Attributes
    ----------
    u : (n, d) float64
        On [0, 1].
    strength : (n,) float64
        In ordinary strengths, none 0.
    change : (n, ...) float64
        With the effect minus without.
    """

    u: Array
    strength: Array
    change: Array

    def __len__(self) -> int:
        """Return n."""
        return len(self.strength)

    def rows(self, which: Array) -> Twins:
        """Return some of them."""
        return Twins(self.u[which], self.strength[which], self.change[which])


@dataclass(frozen=True)
class Signature:
    """The answer of one number to one effect.

    Attributes
    ----------
    lengths : (d,) float64
        Correlation lengths of the output.
    scale : float
        Its size; 0 where the effect never changes it.
    variances : (4,) float64
        Of level and slopes, g, bend and noise, relative to the size.
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
        between = _between(self.lengths, self.variances, u, strength, self.twins)
        level, smooth, bend, _ = self.variances
        away = 1.0 + np.sum((u - MIDDLE) ** 2, axis=1)
        spread = strength**2 * (level * away + smooth) + strength**4 * bend
        spread -= np.einsum("ij,jk,ik->i", between, self._inverse, between)
        spread = self.inflation * self.scale**2 * np.maximum(spread, 0.0)
        return self.scale * (between @ self._weights), spread

    def parts(self, u: Array) -> tuple[Array, Array]:
        """Return the change per strength and per squared strength at n inputs, each (n,)."""
        if self.scale == 0.0:
            return np.zeros(len(u)), np.zeros(len(u))
        level, smooth, bend, _ = self.variances
        shape = _shape(self.lengths, u, self.twins.u, level, smooth)
        own = self._weights * self.twins.strength
        bent = float(self._weights @ self.twins.strength**2) * bend
        return self.scale * (shape @ own), np.full(len(u), self.scale * bent)


def _shape(lengths: Array, a: Array, b: Array, level: float, smooth: float) -> Array:
    linear = 1.0 + (a - MIDDLE) @ (b - MIDDLE).T
    return np.asarray(level * linear + smooth * matern_between(a / lengths, b / lengths))


def _between(lengths: Array, variances: Array, u: Array, strength: Array, twins: Twins) -> Array:
    """Return the covariance of changes at n inputs with those of the twins, (n, n_twins)."""
    level, smooth, bend, _ = variances
    both = np.multiply.outer(strength, twins.strength)
    return np.asarray(both * _shape(lengths, u, twins.u, level, smooth) + bend * both**2)


def learn_signature(lengths: Array, scale: float, twins: Twins) -> Signature:
    """Learn the answer of one number from twins.

    Parameters
    ----------
    lengths : (d,) float64
        Correlation lengths of the number without the effect.
    scale : float
        Its size; 0 for one that never changes.
    twins : Twins
        n of them; `change` is (n,).
    """
    size = float(np.abs(twins.change).max(initial=0.0))
    if scale == 0.0 or size == 0.0:
        none = np.zeros((0, 0))
        return Signature(lengths, 0.0, np.zeros(4), 1.0, twins, none, np.zeros(0))
    y = twins.change / scale
    both = np.multiply.outer(twins.strength, twins.strength)
    alike = matern_between(twins.u / lengths, twins.u / lengths)
    linear = 1.0 + (twins.u - MIDDLE) @ (twins.u - MIDDLE).T
    bases = np.array([both * linear, both * alike, both**2, np.eye(len(y))])
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
