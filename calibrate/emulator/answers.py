"""Covariances of answers to an effect, as machine code.

Where causes are weighed, answers are asked for a hundred thousand times, mostly at a few points and
at times at thousands: one loop in place of a dozen arrays.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.compiled import compiled

__all__ = ["QUICK", "SLOW", "answers_between", "strengths_of"]

QUICK, SLOW = 0.3, 1.0
"""Correlation lengths in ln(1 + |s|) of both parts of any shape."""
STRENGTH, LOGARITHM, TO_NONE_QUICK, TO_NONE_SLOW = range(4)
WHOLE: Final = -0.5
"""Of the square of a distance in lengths, in the exponent."""


def strengths_of(strength: Array) -> Array:
    """Return what `answers_between` needs of strengths (n,), (n, 4).

    They, sign(s) ln(1 + |s|), and the correlations of both parts with those at none.
    """
    logarithm = np.sign(strength) * np.log1p(np.abs(strength))
    quick, slow = (np.exp(WHOLE * (logarithm / length) ** 2) for length in (QUICK, SLOW))
    return np.column_stack([strength, logarithm, quick, slow])


def _between(
    alike: Array,
    trend: Array,
    own: Array,
    others: Array,
    smooth: float,
    quick: float,
    slow: float,
    bend: float,
) -> None:
    every = len(own) > 1
    of_strength = np.empty(len(others))
    for i in range(len(alike)):
        one = own[i if every else 0]
        if every or i == 0:
            for j in range(len(others)):
                other = others[j]
                apart = one[LOGARITHM] - other[LOGARITHM]
                square = WHOLE * apart * apart
                near = (
                    math.exp(square / (QUICK * QUICK)) - one[TO_NONE_QUICK] * other[TO_NONE_QUICK]
                )
                far = math.exp(square / (SLOW * SLOW)) - one[TO_NONE_SLOW] * other[TO_NONE_SLOW]
                both = one[STRENGTH] * other[STRENGTH]
                of_strength[j] = smooth * both + quick * near + slow * far
        for j in range(len(others)):
            both = one[STRENGTH] * others[j, STRENGTH]
            alike[i, j] = alike[i, j] * of_strength[j] + both * (trend[i, j] + bend * both)


def answers_between(
    alike: Array, trend: Array, own: Array, others: Array, variances: tuple[float, ...]
) -> Array:
    """Return the covariance of answers at n points and strengths with those at m others, (n, m).

    Parameters
    ----------
    alike : (n, m) float64
        Correlation of points as the output has it; is overwritten.
    trend : (n, m) float64
        Covariance of what grows with the strength and is straight in the parameters, per strength.
    own, others : (n, 4) or (1, 4), (m, 4) float64
        Of the strengths, see `strengths_of`; one row where all are the same.
    variances : (float, float, float, float)
        Of the part that grows with the strength, of both parts of any shape, of the bend.
    """
    compiled(_between)(alike, trend, own, others, *variances)
    return alike
