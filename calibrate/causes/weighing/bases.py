"""Where the base model lies: its modes, from likely points of the prior that lie apart."""

from __future__ import annotations

from typing import Final

import numpy as np

from calibrate.causes.weighing.cloud import Cloud, cloud_of
from calibrate.causes.weighing.modes import Mode, mode_near
from calibrate.inference.problem import Problem
from calibrate.inference.sampler.mixture import Mixture
from calibrate.inference.sampler.modes import apart

__all__ = ["PRIOR_DRAWS", "best_mode", "modes_of"]

PRIOR_DRAWS: Final = 3000
STARTS: Final = 4


def best_mode(problem: Problem, rng: np.random.Generator) -> Mode:
    """Return the best mode of a base model, found from likely points of its prior."""
    prior = Mixture.prior(problem.space.size)
    return modes_of(cloud_of(problem, prior, PRIOR_DRAWS // 3, rng))[0]


def modes_of(cloud: Cloud, starts: int = STARTS) -> list[Mode]:
    """Return different modes of the base model near likely draws that lie apart, the best first.

    Parameters
    ----------
    cloud : Cloud
        Draws of the prior.
    starts : int
        Draws from which modes are looked for.
    """
    order = np.argsort(-cloud.bench.log_likelihood)[: len(cloud) // 20]
    found = [mode_near(cloud.problem, z) for z in apart(cloud.z[order], starts)]
    found.sort(key=lambda one: -one.log_evidence)
    kept: list[Mode] = []
    for one in found:
        near = any(_distance(one, other) < 1.0 for other in kept)
        if not near and one.log_evidence > found[0].log_evidence - 10.0:
            kept.append(one)
    return kept


def _distance(one: Mode, other: Mode) -> float:
    """Return how far two modes lie apart, in widths of the second."""
    away = one.z - other.z
    return float(np.sqrt(away @ np.linalg.solve(other.covariance, away)))
