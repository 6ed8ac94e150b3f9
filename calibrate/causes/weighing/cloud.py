"""One cloud of draws for all hypotheses, drawn from a mixture that reaches all of them.

Every draw is weighed against the whole mixture (the balance heuristic of Veach and Guibas 1995), so
that a component which suits one hypothesis serves all others as far as it goes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from scipy import special

from calibrate.arrays import Array
from calibrate.causes.weighing.bench import Bench, bench_at
from calibrate.inference.problem import Problem
from calibrate.inference.sampler.mixture import Mixture
from calibrate.inference.sampler.target import log_prior

__all__ = ["Cloud", "cloud_of"]

DOF: Final = 6.0
"""Of the t distributions that are drawn from."""


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
    """

    problem: Problem
    z: Array
    bench: Bench
    parts: tuple[tuple[Mixture, int], ...]

    def __len__(self) -> int:
        """Return n."""
        return len(self.z)

    @cached_property
    def log_drawn(self) -> Array:
        """Log density of the whole mixture, (n,)."""
        each = [
            one.log_density(self.z) + math.log(count / len(self.z)) for one, count in self.parts
        ]
        return np.asarray(special.logsumexp(each, axis=0))

    @property
    def log_weight(self) -> Array:
        """Log prior over the density of the draws, (n,)."""
        return np.asarray(log_prior(self.z) - self.log_drawn)

    def grown(self, mixture: Mixture, count: int, rng: np.random.Generator) -> Cloud:
        """Return the cloud with draws from one more mixture."""
        z = mixture.draw(count, rng)
        bench = bench_at(self.problem, self.problem.space.from_normal(z))
        parts = (*self.parts, (mixture, count))
        return Cloud(self.problem, np.vstack([self.z, z]), self.bench.joined(bench), parts)


def cloud_of(problem: Problem, mixture: Mixture, count: int, rng: np.random.Generator) -> Cloud:
    """Return a cloud drawn from a mixture."""
    z = mixture.draw(count, rng)
    return Cloud(problem, z, bench_at(problem, problem.space.from_normal(z)), ((mixture, count),))


def mixture_of(
    means: Sequence[Array], covariances: Sequence[Array], weights: Sequence[float]
) -> Mixture:
    """Return a mixture of t distributions."""
    share = np.array(weights, dtype=float)
    return Mixture(share / share.sum(), np.array(means), np.array(covariances), DOF)
