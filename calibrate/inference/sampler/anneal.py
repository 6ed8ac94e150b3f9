"""Annealing a cloud of points from the prior to the posterior (sequential Monte Carlo).

The cloud follows prior^(1 - t) p^t from t = 0 to the posterior p at t = 1. Each step keeps half of
the cloud effective; points are drawn by weight and moved over the density of that t. The evidence
is the product of the mean weights (Del Moral et al. 2006). Regions get their weights while points
still move between them. Where it started from a fitted proposal of which one draw in a thousand
counted, a tail that the proposal did not reach was missed, and seeds differed more. Points that
have not moved far enough at one step bias all that follow; the error does not count that.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy import optimize, special

from calibrate.arrays import Array
from calibrate.inference.sampler.importance import Weighted, take
from calibrate.inference.sampler.mixture import Mixture, effective_size
from calibrate.inference.sampler.moves import MOST, Cloud, move
from calibrate.inference.sampler.target import Density, Progress

__all__ = ["Annealed", "anneal", "annealed"]

_KEPT: Final = 0.5  # share of the cloud that stays effective in a step
_STALLED: Final = 1e-6  # smallest step
_FROM: Final = 0.8  # share of the whole work that is done before
_TO: Final = 0.9
_DOUBT: Final = (
    "annealed: points that did not move far enough bias it, which its error does not count; with "
    "45 unknowns it was wrong by three to five of its errors where the evidence is known"
)


@dataclass(frozen=True, eq=False)
class Annealed:
    """A cloud at the posterior, and what its way there told of the evidence.

    Attributes
    ----------
    cloud : Cloud
    log_evidence, variance : float
    """

    cloud: Cloud
    log_evidence: float
    variance: float


def anneal(target: Density, count: int, rng: np.random.Generator) -> Weighted:
    """Return draws from the posterior, of equal weight, and the evidence.

    Parameters
    ----------
    target : Density
    count : int
        Size of the cloud.
    rng : Generator
    """

    def tell(power: float) -> None:
        target.progress(_FROM + power * (_TO - _FROM))

    found = annealed(target, Mixture.prior(target.size).draw(count, rng), rng, tell)
    equal = np.full(count, 1.0 / count)
    error = float(np.sqrt(found.variance))
    return Weighted(found.cloud.z, equal, found.log_evidence, error, float(count), _DOUBT)


def annealed(
    target: Density,
    z: Array,
    rng: np.random.Generator,
    tell: Progress,
    most: int = MOST,
) -> Annealed:
    """Return a cloud that went from the prior to the posterior.

    Parameters
    ----------
    target : Density
    z : (n, K) float64
        Draws of the prior.
    rng : Generator
    tell : callable
        Told the power, from 0 to 1.
    most : int
        Moves at one power at most.
    """
    count, prior = len(z), Mixture.prior(target.size)
    log_p = target.log_posterior(z)
    power, log_evidence, variance = 0.0, 0.0, 0.0
    while power < 1.0:
        rise = log_p - prior.log_density(z)
        step = _step(rise, power)
        total = float(special.logsumexp(step * rise))
        weights = np.exp(step * rise - total)
        log_evidence += total - float(np.log(count))
        variance += 1.0 / effective_size(weights) - 1.0 / count
        power = 1.0 if power + step > 1.0 - _STALLED else power + step
        moved = move(target, z[take(weights, count, rng)], rng, power, prior, most)
        z, log_p = moved.z, moved.log_p
        tell(power)
    return Annealed(Cloud(z, log_p), log_evidence, variance)


def _step(rise: Array, power: float) -> float:
    """Return how far the power may go up so that the cloud keeps its effective share."""

    def excess(step: float) -> float:
        log_w = step * rise
        return effective_size(np.exp(log_w - log_w.max())) / len(rise) - _KEPT

    if excess(1.0 - power) > 0.0:
        return 1.0 - power
    return max(float(optimize.brentq(excess, 0.0, 1.0 - power)), _STALLED)
