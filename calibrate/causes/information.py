"""How much the result of a measurement is expected to tell which of several answers holds.

The expected information of an experiment (Lindley 1956, Ann. Math. Statist. 27, 986) on which model
holds (Box and Hill 1967, Technometrics 9, 57; Meyer, Steinberg and Box 1996, Technometrics 38,
303): with p_h the probability of answer h, f_h the density of the result y if it holds and
f = sum_h p_h f_h,

    I = sum_h p_h integral f_h(y) ln(f_h(y) / f(y)) dy,

between zero and the entropy -sum_h p_h ln p_h.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy import special

from calibrate.arrays import Array

__all__ = ["Expected", "entropy", "information", "shares_after"]

REACH: Final = 8.0
"""Standard deviations to either side that are looked at."""
NODES: Final = 321
"""Of each normal distribution: twenty in a standard deviation, the integral is good to 1e-3."""


@dataclass(frozen=True)
class Expected:
    """Result that an answer expects, a mixture of normal distributions.

    Attributes
    ----------
    parts : tuple of (float, float, float)
        Weight, mean and standard deviation of each; weights have the sum 1.
    """

    parts: tuple[tuple[float, float, float], ...]

    @property
    def likeliest(self) -> tuple[float, float]:
        """Mean and standard deviation of the heaviest part."""
        _, mean, sd = max(self.parts)
        return mean, sd


def entropy(shares: Sequence[float]) -> float:
    """Return how open it is which answer holds, in nats.

    Parameters
    ----------
    shares : sequence of float
        Probabilities.

    Examples
    --------
    >>> round(entropy([0.5, 0.5]), 3), entropy([1.0, 0.0])
    (0.693, 0.0)
    """
    return float(special.entr(np.asarray(shares)).sum())


def information(shares: Sequence[float], expected: Sequence[Expected]) -> float:
    """Return the expected information of a measurement, in nats.

    Parameters
    ----------
    shares : sequence of float
        Probability of each answer before it, sum 1.
    expected : sequence of Expected
        What each of them expects.
    """
    normals = sorted({part[1:] for one in expected for part in one.parts})
    mean, sd = np.array(normals).T
    y = np.unique(mean[:, None] + sd[:, None] * np.linspace(-REACH, REACH, NODES))
    density = _densities(y, expected)
    whole = density @ np.asarray(shares)
    told = special.rel_entr(density, whole[:, None]) @ np.asarray(shares)
    return max(float(np.trapezoid(told, y)), 0.0)


def shares_after(value: float, shares: Sequence[float], expected: Sequence[Expected]) -> Array:
    """Return the probability of each answer after a result.

    Parameters
    ----------
    value : float
        The result.
    shares : sequence of float
    expected : sequence of Expected

    Returns
    -------
    (H,) float64
    """
    logs = np.array([_log_density(value, one) for one in expected])
    with np.errstate(divide="ignore"):  # an answer without any probability keeps none
        return np.asarray(special.softmax(np.log(np.asarray(shares)) + logs))


def _densities(y: Array, expected: Sequence[Expected]) -> Array:
    """Return the density of every result if each answer holds, (len(y), H); equal ones once."""
    once = {one: np.zeros_like(y) for one in expected}
    for one, total in once.items():
        for weight, mean, sd in one.parts:
            total += weight * np.exp(-0.5 * ((y - mean) / sd) ** 2) / (sd * np.sqrt(2.0 * np.pi))
    return np.column_stack([once[one] for one in expected])


def _log_density(value: float, one: Expected) -> float:
    logs = [np.log(w) - 0.5 * ((value - mean) / sd) ** 2 - np.log(sd) for w, mean, sd in one.parts]
    return float(special.logsumexp(logs))
