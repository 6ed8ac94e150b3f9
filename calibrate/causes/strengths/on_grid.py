"""How the log likelihood changes on a grid of two strengths, as machine code.

Array by array this took a third of a diagnosis: a dozen passes over memory for every reading, and a
logarithm in each. Here one loop goes through the readings of a draw, and takes one logarithm of the
product of all that the variances grow by, and one of that of all tails with the same exponent; of
four strengths at a time, since the mathematical library takes logarithms one by one.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.compiled import compiled

__all__ = ["gain_on_grid"]

MOST: Final = 1e100
"""Product of growths beyond which its logarithm is taken at once: it has to stay a number."""
TAILS: Final = 6
"""As many factors at most in a product of tails: of six between 1e-50 and 1e50 it is a number, and
what is farther off than that does not count."""
LEAST: Final = 1e-300
"""Instead of a product that was too small to be more than 0."""
ROOT_HALF: Final = 0x3FE6A09E667F3BCD
"""The bits of the root of a half: numbers are divided by a power of 2 that leaves them between it
and its inverse."""
PLACES: Final = 52
"""Of the bits of a number: those of the exponent begin here."""
LOG_2: Final = math.log(2.0)
T3, T5, T7, T9, T11, T13, T15, T17, T19, T21 = (2.0 / k for k in range(3, 23, 2))
"""Series of 2 artanh s; for |s| < 0.1716 what is left out is below 1e-18."""


def _logarithm(x: float) -> float:
    """Return ln x of a number from 1e-307 on, without a branch; NaN of what is no finite one."""
    bits = np.float64(x).view(np.int64)
    power = (bits - ROOT_HALF) >> PLACES
    mantissa = np.int64(bits - (power << PLACES)).view(np.float64)
    s = (mantissa - 1.0) / (mantissa + 1.0)
    q = s * s
    t = T11 + q * (T13 + q * (T15 + q * (T17 + q * (T19 + q * T21))))
    t = T3 + q * (T5 + q * (T7 + q * (T9 + q * t)))
    return float(power * LOG_2 + (2.0 * s + s * q * t) + (x - x))


def _add_logarithms(gain: Array, i: int, j: int, factor: float, values: Array) -> None:
    for m in range(len(values)):
        gain[i, j, m] += factor * _logarithm(max(values[m], LEAST))


def _gain(
    products: Array, doubts: Array, freedom: Array, levels: Array, x: Array, y: Array, gain: Array
) -> None:
    count, readings, _ = products.shape
    n = len(y)
    # Rows of one array, or a loop over numbered strengths, the compiler takes one at a time.
    grown, wider, tails = np.empty(n), np.empty(n), np.empty(n)
    most_x, most_y = np.max(x * x), np.max(y * y)
    most_of = np.empty(readings)
    for i in range(count):
        for k in range(readings):
            most_of[k] = (1.0 + doubts[k, 0, i] * most_x + doubts[k, 1, i] * most_y) ** levels[k]
        for j, at in enumerate(x):
            grown[:], tails[:] = 1.0, 1.0
            reached = 1.0
            power, many = 0.0, 0  # exponent and number of the tails in the product
            for k in range(readings):
                rr, ra, rc, aa, ac, cc, rb, rd, bb, bd, dd, ab, ad, cb, cd = products[i, k]
                own = at * (-2.0 * ra + at * (aa - 2.0 * rc + at * (2.0 * ac + at * cc)))
                one = 2.0 * (at * (ab + at * cb) - rb)
                two = bb + 2.0 * (at * (ad + at * cd) - rd)
                three = 2.0 * bd
                first, second = doubts[k, 0, i], doubts[k, 1, i]
                wide = 1.0 + first * at * at
                free, size = freedom[k, i], levels[k]
                half = 0.5 * (free + size)
                if free > 0.0:
                    if many == TAILS or (many > 0 and half != power):
                        _add_logarithms(gain, i, j, power, tails)
                        tails[:] = 1.0
                        many = 0
                    power, many = half, many + 1
                    for m in range(n):
                        b = y[m]
                        left = rr + own + b * (one + b * (two + b * (three + b * dd)))
                        wider[m] = wide + second * b * b
                        tails[m] *= (free + rr) / (free + max(left, 0.0) / wider[m])
                else:  # a loop of its own: the compiler does not take the question out of one
                    for m in range(n):
                        b = y[m]
                        left = rr + own + b * (one + b * (two + b * (three + b * dd)))
                        wider[m] = wide + second * b * b
                        gain[i, j, m] += 0.5 * (rr - max(left, 0.0) / wider[m])
                most = most_of[k]
                if not most < MOST:
                    _add_logarithms(gain, i, j, -0.5 * size, wider)
                    continue
                reached *= most
                if reached > MOST:
                    _add_logarithms(gain, i, j, -0.5, grown)
                    grown[:] = 1.0
                    reached = most
                if most > 1.0:
                    for _ in range(size):
                        for m in range(n):
                            grown[m] *= wider[m]
            if many > 0:
                _add_logarithms(gain, i, j, power, tails)
            if reached > 1.0:
                _add_logarithms(gain, i, j, -0.5, grown)


def gain_on_grid(
    products: Array, doubts: Array, freedom: Array, levels: Array, x: Array, y: Array
) -> Array:
    """Return the gain of the log likelihood of R readings at n draws, (n, g, h).

    Parameters
    ----------
    products : (R, 15, n) float64
        With r what is left, a and c slope and bend of one cause, b and d of the other: r.r, r.a,
        r.c, a.a, a.c, c.c, r.b, r.d, b.b, b.d, d.d, a.b, a.d, c.b, c.d.
    doubts : (R, 2, n) float64
        By how much variances grow with either squared strength.
    freedom : (R, n) float64
        Degrees of freedom of the errors; 0 for known ones.
    levels : (R,) int64
    x, y : (g,), (h,) float64
        Strengths of either cause.
    """
    found = np.zeros((products.shape[2], len(x), len(y)))
    # Draw by draw, as the loop goes.
    own = np.ascontiguousarray(products.transpose(2, 0, 1))
    compiled(_gain, _logarithm, _add_logarithms)(own, doubts, freedom, levels, x, y, found)
    return found
