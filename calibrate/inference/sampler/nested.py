"""Nested sampling with dynesty: one likelihood at a time, an independent check of the rest."""

from __future__ import annotations

import warnings
from typing import Final

import numpy as np
from scipy import special

from calibrate.arrays import Array
from calibrate.inference.sampler.importance import Weighted
from calibrate.inference.sampler.mixture import effective_size
from calibrate.inference.sampler.target import Target

__all__ = ["nested"]

_LIVE: Final = 500
_LEFT: Final = 0.05  # nats that may be missing at the end


def nested(target: Target, rng: np.random.Generator) -> Weighted:
    """Return weighted draws from the posterior and the evidence.

    Parameters
    ----------
    target : Target
    rng : Generator
    """
    import dynesty  # late: it brings matplotlib, and only checks need it

    space = target.problem.space

    def log_likelihood(cube: Array) -> float:
        return float(target.log_likelihood(space.transform(cube[None]))[0])

    with warnings.catch_warnings():
        # Plateaus of equal likelihood and slow proposals: nothing that a user can act on.
        warnings.simplefilter("ignore")
        sampler = dynesty.NestedSampler(
            log_likelihood, np.array, space.size, nlive=_LIVE, rstate=rng
        )
        sampler.run_nested(dlogz=_LEFT, print_progress=False)
    found = sampler.results
    weights = np.asarray(found.importance_weights())
    z = special.ndtri(np.clip(found.samples, 1e-16, 1.0 - 1e-16))
    return Weighted(
        z,
        weights / weights.sum(),
        float(found.logz[-1]),
        float(found.logzerr[-1]),
        effective_size(weights),
    )
