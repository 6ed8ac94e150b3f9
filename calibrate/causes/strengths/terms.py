"""How the log likelihood changes with strengths: polynomials of each draw.

What a cause adds to a reading is x (a + x c) in units of its errors, so that the square of what is
left is a polynomial of the strength x,

    q(x) = r.r - 2 x r.a - 2 x^2 r.c + x^2 a.a + 2 x^3 a.c + x^4 c.c

and the log density of a reading of L levels, whose variance grows by v = 1 + d x^2 as the answer to
the cause is known the worse the stronger it is, is

    -(q / v + L ln v) / 2                              where its error is known, and
    -(f + L) / 2 ln(1 + q / f v) - L / 2 ln v          where f + 1 repeats told it (Student's t).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from calibrate.arrays import Array

__all__ = ["Cross", "Terms", "gain_along"]


@dataclass(frozen=True)
class Terms:
    """One reading with a cause at n draws.

    Attributes
    ----------
    products : (6, n) float64
        r.r, r.a, r.c, a.a, a.c, c.c: of what is left r, the slope a and the bend c.
    doubt : (n,) float64
        d.
    freedom : (n,) float64
        f; all 0 for a known error.
    levels : int
        L.
    """

    products: Array
    doubt: Array
    freedom: Array
    levels: int

    def fall(self, x: Array) -> Array:
        """Return q(x) - q(0), (n, g), at strengths (g,)."""
        _, ra, rc, aa, ac, cc = self.products[:, :, None]
        found = cc * x
        for more in (2.0 * ac, aa - 2.0 * rc, -2.0 * ra):
            found += more
            found *= x
        return np.asarray(found)

    def gain(self, fall: Array, grown: Array) -> Array:
        """Return how the log density changes.

        Parameters
        ----------
        fall : (n, ...) float64
            q(x) - q(0).
        grown : (n, ...) float64
            v - 1.
        """
        shape = (-1, *([1] * (fall.ndim - 1)))
        rr, freedom = self.products[0].reshape(shape), self.freedom.reshape(shape)
        wide = 1.0 + grown
        square = rr + fall
        np.maximum(square, 0.0, out=square)
        square /= wide
        loss = np.log(wide, out=wide)
        loss *= 0.5 * self.levels
        if freedom.any():
            half = 0.5 * (freedom + self.levels)
            return np.asarray(half * np.log((freedom + rr) / (freedom + square)) - loss)
        gain = np.subtract(rr, square, out=square)
        gain *= 0.5
        gain -= loss
        return np.asarray(gain)


def gain_along(terms: Sequence[Terms], x: Array, rows: int) -> Array:
    """Return the gain of the log likelihood at strengths (g,), (rows, g)."""
    total: Array = np.zeros((rows, len(x)))
    for one in terms:
        total += one.gain(one.fall(x), np.multiply.outer(one.doubt, x**2))
    return total


@dataclass(frozen=True)
class Cross:
    """One reading with two causes at n draws.

    Attributes
    ----------
    first, second : Terms
        Of each cause alone.
    mixed : (4, n) float64
        Products of what they add: slopes, slope and bend both ways, bends.
    """

    first: Terms
    second: Terms
    mixed: Array

    def gain(self, x: Array, y: Array) -> Array:
        """Return the gain of the log likelihood at strengths (g,) and (h,), (n, g, h)."""
        both = np.multiply.outer
        fall = self.first.fall(x)[:, :, None] + self.second.fall(y)[:, None, :]
        powers = (both(x, y), both(x, y**2), both(x**2, y), both(x**2, y**2))
        for product, power in zip(self.mixed, powers, strict=True):
            fall = fall + 2.0 * both(product, power)
        grown = np.multiply.outer(self.first.doubt, x**2)[:, :, None]
        grown = grown + np.multiply.outer(self.second.doubt, y**2)[:, None, :]
        return self.first.gain(fall, grown)
