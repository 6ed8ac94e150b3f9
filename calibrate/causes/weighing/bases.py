"""Where the base model lies: its modes, from points of an annealed cloud and of the prior."""

from __future__ import annotations

import numpy as np

from calibrate.causes.weighing.modes import Mode, mode_near
from calibrate.inference.problem import Problem
from calibrate.inference.sampler.modes import starting_points
from calibrate.inference.sampler.target import Target

__all__ = ["base_modes", "best_mode"]


def best_mode(problem: Problem, rng: np.random.Generator) -> Mode:
    """Return the best mode of a base model."""
    return base_modes(problem, rng)[0]


def base_modes(problem: Problem, rng: np.random.Generator) -> list[Mode]:
    """Return different modes of a base model that may count, the best first.

    Parameters
    ----------
    problem : Problem
    rng : numpy Generator

    Raises
    ------
    CalibrationError
        If no point of the prior can have given the data.
    """
    found = [mode_near(problem, z) for z in starting_points(Target(problem), rng)]
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
