"""The Matern correlation of many pairs, as machine code.

Where emulators are asked, most time went into exponentials: the mathematical library takes them one
by one on processors without AVX-512. Here a loop without branches computes four at a time.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.compiled import compiled

__all__ = ["matern_of"]

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


def _matern(squared: Array) -> None:
    for i in range(squared.size):
        d = min(math.sqrt(max(squared[i], 0.0)), FAR)
        power = -d * LOG2_E
        shifted = power + ROUND
        g = (power - (shifted - ROUND)) * LOG_2
        e = C8 + g * (C9 + g * (C10 + g * (C11 + g * C12)))
        e = C4 + g * (C5 + g * (C6 + g * (C7 + g * e)))
        e = 1.0 + g * (1.0 + g * (C2 + g * (C3 + g * e)))
        bits = (np.float64(shifted).view(np.int64) + BIAS) << PLACES
        squared[i] = e * np.int64(bits).view(np.float64) * (1.0 + d * (1.0 + d * (1.0 / 3.0)))


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
    compiled(_matern)(squared.reshape(-1))
    return squared
