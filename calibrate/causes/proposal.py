"""A mixture that covers a posterior, at the price that two dozen hypotheses allow.

Laplace's approximation finds the modes. Ridges between a cause and the parameters that imitate it
are bent, so the mixture is then fitted to its own weighted draws (adaptive importance sampling,
Cappe et al. 2008): weights are flattened until enough draws carry them, and a component is added
at the draw that the mixture misses most. No chains are run, so this costs a tenth of
`calibrate.inference.sampler.importance.adapt`.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy import optimize

from calibrate.arrays import Array
from calibrate.inference.sampler.laplace import find_modes
from calibrate.inference.sampler.mixture import Mixture, effective_size
from calibrate.inference.sampler.target import Target, log_prior

__all__ = ["proposal_of"]

ROUNDS: Final = 12
DRAWS: Final = 2000
"""Draws of one round."""
GOOD: Final = 0.25
"""Share of effective draws at which the mixture is good enough."""
CARRYING: Final = 10
"""Draws per unknown that must carry the weight, by flattening it if need be."""
COMPONENTS: Final = 8
NEW: Final = 0.1
"""Weight of a component that is added."""
_FITS: Final = 2  # steps of expectation maximisation in a round


def proposal_of(target: Target, rng: np.random.Generator, power: float = 1.0) -> Mixture:
    """Return a mixture from which importance sampling of a posterior is worth its draws.

    Parameters
    ----------
    target : Target
    rng : Generator
    power : float
        Of the likelihood; below 1 for the posteriors of all studies that differ by their errors.
    """
    best = proposal = find_modes(target, rng)
    most = 0.0
    for _ in range(ROUNDS):
        z = proposal.draw(DRAWS, rng)
        likelihood = target.log_likelihood(target.problem.space.from_normal(z))
        log_w = power * likelihood + log_prior(z) - proposal.log_density(z)
        log_w -= log_w.max()
        size = effective_size(np.exp(log_w))
        if size > most:
            best, most = proposal, size
        if size > GOOD * DRAWS:
            break
        weights = _flattened(log_w, float(CARRYING * target.size))
        if len(proposal.weights) < COMPONENTS:
            missed = z[int(np.argmax(log_w))]
            proposal = proposal.joined(missed, _nearest(proposal, missed), NEW)
        proposal = proposal.refitted(z, weights, _FITS)
    return best


def _flattened(log_w: Array, wanted: float) -> Array:
    """Return weights raised to the largest power that leaves so many effective draws, sum 1."""

    def excess(power: float) -> float:
        return effective_size(np.exp(power * log_w)) - wanted

    power = 1.0 if excess(1.0) >= 0.0 else float(optimize.brentq(excess, 0.0, 1.0))
    weights = np.exp(power * log_w)
    return np.asarray(weights / weights.sum())


def _nearest(proposal: Mixture, z: Array) -> Array:
    """Return the covariance of the component to which a point most likely belongs."""
    return np.asarray(proposal.covariances[int(np.argmax(proposal.log_parts(z[None])[0]))])
