"""Evidence of one hypothesis after another, each a few unknowns more than one that is known.

The search starts where the known one found its posterior, and the draws of new unknowns from their
prior or from a climb to either side. So a hypothesis costs a tenth of a search from nothing, and
what the known one found is looked at in all that follow from it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy import optimize

from calibrate.arrays import Array
from calibrate.inference.problem import Problem
from calibrate.inference.sampler.importance import Weighted, adapt, weigh
from calibrate.inference.sampler.laplace import climb, find_modes, mixture_of
from calibrate.inference.sampler.mixture import Mixture, effective_size
from calibrate.inference.sampler.target import Target, log_prior

__all__ = ["Evidence", "evidence", "evidence_from", "fitted", "start_from"]

ERROR: Final = 0.01
"""Standard error of a log evidence at which drawing ends: ratios then repeat within 0.05."""
_DRAWS: Final = (4000, 128_000)  # first, and at most
_SIDE: Final = 1.0  # prior deviations of a new unknown at which a climb starts, to either side
_BROUGHT: Final = 0.3  # weight of what is brought from the known hypothesis
_ROUND: Final = 1000
_ROUNDS: Final = 10
_GOOD: Final = 0.5  # share of effective draws at which a proposal is good
_CARRYING: Final = 10  # draws per unknown that carry the weight, which is flattened if need be
_COMPONENTS: Final = 16
_NEW: Final = 0.1
_FITS: Final = 2


@dataclass(frozen=True, eq=False)
class Evidence:
    """How probable the data are under one hypothesis, and where its posterior lies.

    Attributes
    ----------
    problem : Problem
    drawn : Weighted
        Draws with weights, log evidence, its error and the doubt about it.
    proposal : Mixture
        What was drawn from.
    """

    problem: Problem
    drawn: Weighted
    proposal: Mixture


def evidence(problem: Problem, rng: np.random.Generator, error: float = ERROR) -> Evidence:
    """Return the evidence of a hypothesis of which nothing is known.

    Parameters
    ----------
    problem : Problem
    rng : Generator
    error : float
        Standard error that is wanted, in nats.
    """
    target = Target(problem)
    proposal = adapt(target, find_modes(target, rng), rng)
    return Evidence(problem, _weighed(target, proposal, error, rng), proposal)


def evidence_from(
    known: Evidence, problem: Problem, rng: np.random.Generator, error: float = ERROR
) -> Evidence:
    """Return the evidence of a hypothesis with all unknowns of a known one and some more.

    Parameters
    ----------
    known : Evidence
    problem : Problem
    rng : Generator
    error : float
        Standard error that is wanted, in nats.

    Raises
    ------
    CalibrationError
        If an unknown of the known hypothesis is missing.
    """
    target = Target(problem)
    proposal = fitted(target, start_from(known, target), rng)
    return Evidence(problem, _weighed(target, proposal, error, rng), proposal)


def start_from(known: Evidence, target: Target) -> Mixture:
    """Return where a posterior may lie that has all unknowns of a known one and some more.

    Parameters
    ----------
    known : Evidence
    target : Target
        Its data may differ from those of the known hypothesis.

    Raises
    ------
    CalibrationError
        If an unknown of the known hypothesis is missing.
    """
    at = [target.problem.space.index(name) for name in known.problem.space.names]
    start = known.drawn.z[int(np.argmax(known.drawn.weights))]
    ends = []
    for side in (-_SIDE, _SIDE) if len(at) < target.size else (0.0,):
        z = np.full(target.size, side)
        z[at] = start
        ends.append(climb(target, z))
    return _joined(mixture_of(ends), _brought(known.proposal, at, target.size))


def _brought(mixture: Mixture, at: list[int], size: int) -> Mixture:
    """Return a mixture in more coordinates, the new ones as their prior has them."""
    count = len(mixture.weights)
    means, covariances = np.zeros((count, size)), np.tile(np.eye(size), (count, 1, 1))
    means[:, at] = mixture.means
    covariances[np.ix_(range(count), at, at)] = mixture.covariances
    return Mixture(mixture.weights, means, covariances, mixture.dof)


def _joined(found: Mixture, brought: Mixture) -> Mixture:
    return Mixture(
        np.concatenate([(1.0 - _BROUGHT) * found.weights, _BROUGHT * brought.weights]),
        np.vstack([found.means, brought.means]),
        np.concatenate([found.covariances, brought.covariances]),
        found.dof,
    )


def fitted(
    target: Target, proposal: Mixture, rng: np.random.Generator, power: float = 1.0
) -> Mixture:
    """Return the best of some rounds that fit a proposal to its own weighted draws.

    Parameters
    ----------
    target : Target
    proposal : Mixture
    rng : Generator
    power : float
        Of the likelihood; below 1 for the posteriors of all data that differ by their errors.

    References
    ----------
    Cappe et al. 2008, Statistics and Computing 18, 447-459 (population Monte Carlo).
    """
    best, most = proposal, 0.0
    for _ in range(_ROUNDS):
        z = proposal.draw(_ROUND, rng)
        likelihood = target.log_likelihood(target.problem.space.from_normal(z))
        log_w = power * likelihood + log_prior(z) - proposal.log_density(z)
        log_w -= log_w.max()
        size = effective_size(np.exp(log_w))
        if size > most:
            best, most = proposal, size
        if size > _GOOD * _ROUND:
            break
        if len(proposal.weights) < _COMPONENTS:
            missed = z[int(np.argmax(log_w))]
            nearest = int(np.argmax(proposal.log_parts(missed[None])[0]))
            proposal = proposal.joined(missed, proposal.covariances[nearest], _NEW)
        proposal = proposal.refitted(z, _flattened(log_w, _CARRYING * target.size), _FITS)
    return best


def _flattened(log_w: Array, wanted: float) -> Array:
    """Return weights raised to the largest power that leaves so many effective draws, sum 1."""

    def excess(power: float) -> float:
        return effective_size(np.exp(power * log_w)) - wanted

    power = 1.0 if excess(1.0) >= 0.0 else float(optimize.brentq(excess, 0.0, 1.0))
    weights = np.exp(power * log_w)
    return np.asarray(weights / weights.sum())


def _weighed(target: Target, proposal: Mixture, error: float, rng: np.random.Generator) -> Weighted:
    """Return weighted draws, as many as the wanted error needs."""
    count, most = _DRAWS
    found = weigh(target, proposal, count, rng)
    if found.error > error:
        needed = count * (found.error / error) ** 2
        found = weigh(target, proposal, int(min(max(needed, count), most)), rng)
    return found
