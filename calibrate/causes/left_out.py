"""What a hypothesis expects of each place, told by all other places."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy import special, stats
from scipy.linalg import block_diag

from calibrate.arrays import Array
from calibrate.causes.residuals import View, views
from calibrate.causes.weighing.evidences import Evidences
from calibrate.causes.weighing.hypotheses import Weighed
from calibrate.inference.sampler.importance import take

__all__ = ["Expected", "expected_of", "told_by_others"]

DRAWS: Final = 1000
SEED: Final = 3


@dataclass(frozen=True)
class Expected:
    """A place as a hypothesis expects it, a normal distribution of its N numbers.

    Attributes
    ----------
    names : tuple of str
        Of its readings.
    y, mean : (N,) float64
        Measured and expected, on the model scale.
    covariance : (N, N) float64
        Of one measurement about the mean: measurement, emulator and what the parameters leave open.
    """

    names: tuple[str, ...]
    y: Array
    mean: Array
    covariance: Array

    def log_density(self, y: Array) -> Array:
        """Return the log density of numbers (..., N)."""
        normal = stats.multivariate_normal(self.mean, self.covariance, allow_singular=True)
        return np.asarray(normal.logpdf(y))


def expected_of(seen: Sequence[View]) -> Expected:
    """Return what some draws expect of the readings of a place."""
    mean = np.column_stack([view.mean for view in seen])
    within = block_diag(*(view.covariance for view in seen))
    names = tuple(view.reading.name for view in seen)
    y = np.concatenate([view.reading.y for view in seen])
    return Expected(names, y, mean.mean(axis=0), within + np.cov(mean.T))


def told_by_others(found: Evidences, one: Weighed) -> list[Expected]:
    """Return every place as a hypothesis expects it that has not seen it, in their order.

    Parameters
    ----------
    found : Evidences
    one : Weighed
        Of one of its hypotheses.
    """
    told, first = [], 0
    for number, place in enumerate(found.board.problem.places):
        own = list(range(first, first + len(place.readings)))
        first += len(own)
        weights = special.softmax(one.log_weight - one.terms[:, own].sum(axis=1))
        rows = take(weights, DRAWS, np.random.default_rng([SEED, number]))
        told.append(expected_of(views(found, one, rows, (number,))))
    return told
