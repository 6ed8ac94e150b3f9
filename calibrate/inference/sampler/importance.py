"""Evidence and draws by importance sampling from mixtures of t distributions that adapt."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy import special

from calibrate.arrays import Array
from calibrate.inference.sampler.laplace import curvature_width
from calibrate.inference.sampler.mixture import Mixture, effective_size
from calibrate.inference.sampler.moves import move
from calibrate.inference.sampler.target import Density

__all__ = ["RELIABLE", "Weighted", "adapt", "doubt_of", "take", "weigh"]

RELIABLE: Final = 500.0
"""Effective size above which evidence and draws are taken."""

_TRUSTED: Final = 0.1  # share of effective draws above which the error of an evidence is right
_FROM: Final = 0.3  # share of the whole work that is done before
_TO: Final = 0.8
_ROUNDS: Final = 12
_PATIENCE: Final = 3  # rounds without a better one
_DRAWS: Final = 2000  # of a round
_CLOUD: Final = 500  # draws that are moved in a round
_CLOUD_PER: Final = 10  # of them for each coordinate, where that is more
_FITS: Final = 5  # steps of expectation maximisation in a round
_MOVES: Final = 25  # of the cloud in a round, at most
_AGREED: Final = 0.1  # nats
_COMPONENTS: Final = 16
_NEW: Final = 0.1  # weight with which a component starts
_GOOD: Final = 0.3  # share of effective draws at which a proposal needs no more adapting
_HEAVIEST: Final = 0.02  # while adapting, no draw weighs more than this share of all


@dataclass(frozen=True, eq=False)
class Weighted:
    """Draws with weights and the evidence that they tell.

    Attributes
    ----------
    z : (n, K) float64
        In the coordinates of `Density`.
    weights : (n,) float64
        Sum 1.
    log_evidence, error : float
        Logarithm of the evidence and its standard error.
    size : float
        Effective number of draws.
    doubt : str
        Why the error is not to be trusted; empty where it is.
    """

    z: Array
    weights: Array
    log_evidence: float
    error: float
    size: float
    doubt: str = ""


def doubt_of(size: float, count: int) -> str:
    """Return why the error of an evidence is not to be trusted, from its effective draws.

    On problems with a known evidence the errors were right wherever a tenth of the draws counted,
    and up to ten times too small where fewer did: a thin bent ridge among 43 other unknowns.
    """
    if size >= _TRUSTED * count:
        return ""
    return (
        f"only {100.0 * size / count:.2g} % of the draws count, so that parts of the posterior may "
        "never have been reached: the evidence may be off by much more than its error"
    )


def weigh(target: Density, proposal: Mixture, count: int, rng: np.random.Generator) -> Weighted:
    """Draw from a proposal and weigh by the posterior.

    Parameters
    ----------
    target : Density
    proposal : Mixture
    count : int
        Number of draws.
    rng : Generator
    """
    z = proposal.draw(count, rng)
    log_w = target.log_posterior(z) - proposal.log_density(z)
    total = float(special.logsumexp(log_w))
    weights = np.exp(log_w - total)
    size = effective_size(weights)
    error = math.sqrt(max(1.0 / size - 1.0 / count, 0.0)) if size > 0.0 else math.inf
    doubt = doubt_of(size, count)
    return Weighted(z, weights, total - math.log(count), error, size, doubt)


def adapt(target: Density, proposal: Mixture, rng: np.random.Generator) -> Mixture:
    """Return the proposal moved onto the posterior.

    In rounds: draw, weigh, take draws by weight and move them over the posterior, so that they
    also reach what the proposal did not; fit the proposal to them and add a component where it is
    thinnest against the posterior (as in incremental mixture importance sampling, Raftery and Bao
    2010), with the curvature found there. It ends when two rounds tell the same evidence, or when
    rounds no longer make it better.

    Parameters
    ----------
    target : Density
    proposal : Mixture
        First guess, such as that of `calibrate.inference.sampler.modes.find_modes`.
    rng : Generator
    """
    most, poor, before = 0.0, 0, math.inf
    for number in range(_ROUNDS):
        target.progress(_FROM + number / _ROUNDS * (_TO - _FROM))
        drawn = weigh(target, proposal, _DRAWS, rng)
        good = drawn.size > _GOOD * _DRAWS
        poor = 0 if drawn.size > most else poor + 1
        most = max(most, drawn.size)
        if (good and abs(drawn.log_evidence - before) < _AGREED) or poor >= _PATIENCE:
            return proposal
        before = drawn.log_evidence if good else math.inf
        proposal = _refitted(target, proposal, drawn, rng)
    return proposal


def _refitted(
    target: Density, proposal: Mixture, drawn: Weighted, rng: np.random.Generator
) -> Mixture:
    """Return the proposal fitted to draws that were moved over the posterior."""
    count = max(_CLOUD, _CLOUD_PER * target.size)
    chosen = take(np.minimum(drawn.weights, _HEAVIEST), count, rng)
    cloud = move(target, drawn.z[chosen], rng, most=_MOVES)
    thin = cloud.z[int(np.argmax(cloud.log_p - proposal.log_density(cloud.z)))]
    if len(proposal.weights) < _COMPONENTS:
        proposal = proposal.joined(thin, curvature_width(target, thin), _NEW)
    return proposal.refitted(cloud.z, np.full(count, 1.0 / count), _FITS)


def take(weights: Array, count: int, rng: np.random.Generator) -> Array:
    """Return rows drawn by weight, (count,), as evenly as their number allows."""
    at = (rng.random() + np.arange(count)) / count
    cumulative = np.cumsum(weights) / np.sum(weights)
    return np.minimum(np.searchsorted(cumulative, at), len(weights) - 1)
