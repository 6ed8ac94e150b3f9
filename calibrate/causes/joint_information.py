"""How much a result of several numbers is expected to tell which of several answers holds.

It is the expected information of `calibrate.causes.information`. Over several numbers the integral
is out of reach of nodes, and is drawn: as many results of each answer, with the same deviates.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy import special

from calibrate.arrays import Array

__all__ = ["Together", "joint_information", "joint_shares_after"]

DRAWS: Final = 20_000
"""Results of each answer. The logarithm of a ratio scatters by about 1, so that the mean of so many
is good to 0.007 nats."""


@dataclass(frozen=True, eq=False)
class Together:
    """Result that an answer expects, a normal distribution of several numbers.

    Attributes
    ----------
    mean : (d,) float64
    covariance : (d, d) float64
    """

    mean: Array
    covariance: Array

    def log_density(self, y: Array) -> Array:
        """Return the log density of results (n, d), without the part that all answers share."""
        root = np.linalg.cholesky(self.covariance)
        z = np.linalg.solve(root, (y - self.mean).T)
        return np.asarray(-0.5 * (z**2).sum(axis=0) - np.log(np.diag(root)).sum())


def joint_information(
    shares: Sequence[float],
    expected: Sequence[Together],
    rng: np.random.Generator,
    draws: int = DRAWS,
) -> float:
    """Return the expected information of a result of several numbers, in nats.

    Parameters
    ----------
    shares : sequence of float
        Probability of each answer before it, above zero, sum 1.
    expected : sequence of Together
        What each of them expects.
    rng : numpy Generator
    draws : int
        Results of each answer.
    """
    deviates = rng.standard_normal((draws, len(expected[0].mean)))
    told = 0.0
    for number, (share, one) in enumerate(zip(shares, expected, strict=True)):
        y = one.mean + deviates @ np.linalg.cholesky(one.covariance).T
        logs = np.array([other.log_density(y) for other in expected])
        whole = special.logsumexp(logs + np.log(np.asarray(shares))[:, None], axis=0)
        told += share * float(np.mean(logs[number] - whole))
    return max(told, 0.0)


def joint_shares_after(
    value: Array, shares: Sequence[float], expected: Sequence[Together]
) -> Array:
    """Return the probability of each answer after a result.

    Parameters
    ----------
    value : (d,) float64
        The result.
    shares : sequence of float
    expected : sequence of Together

    Returns
    -------
    (H,) float64
    """
    logs = np.array([float(one.log_density(value[None])[0]) for one in expected])
    return np.asarray(special.softmax(np.log(np.asarray(shares)) + logs))
