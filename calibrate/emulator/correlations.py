"""Correlations of many pairs of runs, and of answers to an effect, as machine code.

Where emulators are asked, most time went into exponentials: the mathematical library takes them one
by one on processors without AVX-512. Here loops without branches compute four at a time; and where
causes are weighed, one loop stands for a dozen arrays.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.compiled import compiled

__all__ = ["answers_between", "matern_of", "strengths_of"]

LOG2_E: Final = 1.0 / math.log(2.0)
LOG_2: Final = math.log(2.0)
FAR: Final = 600.0
"""Distances beyond count as this one, with a correlation of 1e-255: 2^-k stays a number."""
ROUND: Final = 1.5 * 2.0**52
"""A number of this size has no places behind the point, so adding it rounds; its low bits are the
whole number."""
BIAS: Final = 1023
PLACES: Final = 52
"""Of the bits of a number: those of the exponent begin here, and 2^0 has the exponent BIAS."""
C2, C3, C4, C5, C6, C7, C8, C9, C10, C11, C12 = (1.0 / math.factorial(k) for k in range(2, 13))
"""Taylor's series of e^g; for |g| < log(2) / 2 what is left out is below 2e-16."""

QUICK, SLOW = 0.3, 1.0
"""Correlation lengths in ln(1 + |s|) of both parts of any shape."""
STRENGTH, LOGARITHM, TO_NONE_QUICK, TO_NONE_SLOW = range(4)
WHOLE: Final = -0.5
"""Of the square of a distance in lengths, in the exponent."""
FARTHEST: Final = FAR * QUICK**2
"""Square of a distance beyond which all count as this one."""
OF_QUICK, OF_SLOW = (WHOLE / length**2 for length in (QUICK, SLOW))


def _exponential(x: float) -> float:
    """Return e^x for -FAR <= x <= 0, without a branch."""
    power = x * LOG2_E
    shifted = power + ROUND
    g = (power - (shifted - ROUND)) * LOG_2
    e = C8 + g * (C9 + g * (C10 + g * (C11 + g * C12)))
    e = C4 + g * (C5 + g * (C6 + g * (C7 + g * e)))
    e = 1.0 + g * (1.0 + g * (C2 + g * (C3 + g * e)))
    bits = (np.float64(shifted).view(np.int64) + BIAS) << PLACES
    return float(e * np.int64(bits).view(np.float64))


def _matern(squared: Array) -> None:
    for i in range(squared.size):
        d = min(math.sqrt(max(squared[i], 0.0)), FAR)
        squared[i] = _exponential(-d) * (1.0 + d * (1.0 + d * (1.0 / 3.0)))


def matern_of(squared: Array) -> Array:
    """Turn squared distances into correlations, in place: (1 + d + d^2 / 3) e^-d of the root d.

    Parameters
    ----------
    squared : (n, m) float64
        5 r^2, C-contiguous; what rounding has made negative is zero.

    Returns
    -------
    (n, m) float64
        The same array; errors are below 1e-15, or 1e-16 d of the value.
    """
    compiled(_matern, _exponential)(squared.reshape(-1))
    return squared


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
    # Each column in a row, so that four pairs are taken at a time.
    strength, logarithm, to_quick, to_slow = others.T.copy()
    for i in range(len(alike)):
        one, position, quick_one, slow_one = own[i if every else 0]
        if every or i == 0:
            for j in range(len(others)):
                apart = position - logarithm[j]
                square = min(apart * apart, FARTHEST)
                near = _exponential(OF_QUICK * square) - quick_one * to_quick[j]
                far = _exponential(OF_SLOW * square) - slow_one * to_slow[j]
                of_strength[j] = smooth * one * strength[j] + quick * near + slow * far
        for j in range(len(others)):
            both = one * strength[j]
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
    compiled(_between, _exponential)(alike, trend, own, others, *variances)
    return alike
