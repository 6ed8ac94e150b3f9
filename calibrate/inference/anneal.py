"""Annealing a cloud of points from the prior to the posterior (sequential Monte Carlo).

The likelihood is switched on in powers; each step keeps half of the cloud effective, points are
drawn by weight and moved over the tempered posterior. The evidence is the product of the mean
weights (Del Moral et al. 2006).
"""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy import optimize, special

from calibrate.arrays import Array
from calibrate.inference.importance import Weighted, take
from calibrate.inference.mixture import effective_size
from calibrate.inference.moves import move
from calibrate.inference.target import Target

__all__ = ["anneal"]

_KEPT: Final = 0.5  # share of the cloud that stays effective in a step
_STALLED: Final = 1e-6  # smallest step


def anneal(target: Target, count: int, rng: np.random.Generator) -> Weighted:
    """Return draws from the posterior, of equal weight, and the evidence.

    Parameters
    ----------
    target : Target
    count : int
        Size of the cloud.
    rng : Generator
    """
    z = rng.standard_normal((count, target.size))
    log_p = target.log_posterior(z)
    power, log_evidence, variance = 0.0, 0.0, 0.0
    while power < 1.0:
        log_l = target.tempered(z, log_p, 1.0) - target.tempered(z, log_p, 0.0)
        step = _step(log_l, power)
        total = float(special.logsumexp(step * log_l))
        weights = np.exp(step * log_l - total)
        log_evidence += total - float(np.log(count))
        variance += 1.0 / effective_size(weights) - 1.0 / count
        power = 1.0 if power + step > 1.0 - _STALLED else power + step
        moved = move(target, z[take(weights, count, rng)], rng, power)
        z, log_p = moved.z, moved.log_p
        target.progress(power)
    equal = np.full(count, 1.0 / count)
    return Weighted(z, equal, log_evidence, float(np.sqrt(variance)), float(count))


def _step(log_l: Array, power: float) -> float:
    """Return how far the power may rise so that the cloud keeps its effective share."""

    def excess(step: float) -> float:
        log_w = step * log_l
        return effective_size(np.exp(log_w - log_w.max())) / len(log_l) - _KEPT

    if excess(1.0 - power) > 0.0:
        return 1.0 - power
    return max(float(optimize.brentq(excess, 0.0, 1.0 - power)), _STALLED)
