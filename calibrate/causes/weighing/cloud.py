"""One cloud of draws for all hypotheses, drawn from a mixture that reaches all of them.

Every draw is weighed against the whole mixture (the balance heuristic of Veach and Guibas 1995), so
that a component which suits one hypothesis serves all others as far as it goes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy import special

from calibrate.arrays import Array
from calibrate.causes.weighing.bench import Bench, bench_at
from calibrate.inference.problem import Problem
from calibrate.inference.sampler.mixture import Mixture, effective_size
from calibrate.inference.sampler.target import log_prior

__all__ = ["FEW", "Cloud", "cloud_of", "effective", "fitted", "mixture_of"]

DOF: Final = 6.0
"""Of the t distributions that are drawn from."""
FEW: Final = 4.0
"""Effective draws for each unknown below which they do not tell where a hypothesis lies."""


@dataclass(frozen=True, eq=False)
class Cloud:
    """Draws of the base model's unknowns.

    Attributes
    ----------
    problem : Problem
    z : (n, K) float64
        Coordinates whose prior is the unit normal.
    bench : Bench
        Of the same draws.
    parts : tuple of (Mixture, int)
        What was drawn from, and how often.
    log_total : (n,) float64
        Log of the sum of the parts' densities, each times how often it was drawn from.
    """

    problem: Problem
    z: Array
    bench: Bench
    parts: tuple[tuple[Mixture, int], ...]
    log_total: Array

    def __len__(self) -> int:
        """Return n."""
        return len(self.z)

    @property
    def log_drawn(self) -> Array:
        """Log density of the whole mixture, (n,)."""
        return np.asarray(self.log_total - math.log(len(self.z)))

    @property
    def log_weight(self) -> Array:
        """Log prior over the density of the draws, (n,)."""
        return np.asarray(log_prior(self.z) - self.log_drawn)

    def grown(self, mixture: Mixture, count: int, rng: np.random.Generator) -> Cloud:
        """Return the cloud with draws from one more mixture."""
        z = mixture.draw(count, rng)
        bench = bench_at(self.problem, self.problem.space.from_normal(z))
        parts = (*self.parts, (mixture, count))
        # What was drawn before has to be weighed against the new part only.
        before = np.logaddexp(self.log_total, _log_total([(mixture, count)], self.z))
        total = np.concatenate([before, _log_total(parts, z)])
        return Cloud(self.problem, np.vstack([self.z, z]), self.bench.joined(bench), parts, total)


def cloud_of(
    problem: Problem,
    mixture: Mixture,
    count: int,
    rng: np.random.Generator,
    points: Sequence[Array] = (),
) -> Cloud:
    """Return a cloud drawn from a mixture, and points (K,) among it that were not drawn."""
    z = np.vstack([*points, mixture.draw(count, rng)])
    parts = ((mixture, len(z)),)
    bench = bench_at(problem, problem.space.from_normal(z))
    return Cloud(problem, z, bench, parts, _log_total(parts, z))


def _log_total(parts: Sequence[tuple[Mixture, int]], z: Array) -> Array:
    each = [one.log_density(z) + math.log(count) for one, count in parts]
    return np.asarray(special.logsumexp(each, axis=0))


def mixture_of(
    means: Sequence[Array], covariances: Sequence[Array], weights: Sequence[float]
) -> Mixture:
    """Return a mixture of t distributions."""
    share = np.array(weights, dtype=float)
    return Mixture(share / share.sum(), np.array(means), np.array(covariances), DOF)


def effective(log_weight: Array) -> float:
    """Return how many draws with these log weights, (n,), tell as much as draws of equal weight."""
    return effective_size(np.exp(log_weight - log_weight.max()))


def fitted(cloud: Cloud, log_weight: Array) -> tuple[Array, Array]:
    """Return middle and width of a hypothesis's draws, flattened until enough of them count.

    Parameters
    ----------
    cloud : Cloud
    log_weight : (n,) float64
        Of its draws.
    """
    size, power = cloud.z.shape[1], 1.0
    # Relative to how densely draws lie there: a flattened weight forgets no more than that.
    relative = log_weight - log_weight.max()
    while effective(power * relative) < FEW * size and power > 0.02:
        power *= 0.75
    w = np.exp(power * relative)
    w /= w.sum()
    mean = w @ cloud.z
    away = cloud.z - mean
    covariance = (away * w[:, None]).T @ away
    trust = effective_size(w) / (effective_size(w) + size)
    return mean, 1.3 * (trust * covariance + (1.0 - trust) * np.diag(np.diag(covariance)))
