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
from calibrate.causes.strengths.on_grid import gain_on_grid

__all__ = ["Cross", "Terms", "gain_across", "gain_along"]


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


def gain_along(terms: Sequence[Terms], x: Array, rows: int) -> Array:
    """Return the gain of the log likelihood at strengths (g,), (rows, g)."""
    if not terms:
        return np.zeros((rows, len(x)))
    products = np.zeros((len(terms), 15, rows))
    doubts = np.zeros((len(terms), 2, rows))
    for k, one in enumerate(terms):
        # As the second of two causes, along which the loop is fastest.
        products[k, 0], products[k, 6:11] = one.products[0], one.products[1:]
        doubts[k, 1] = one.doubt
    return _on_grid(products, doubts, terms, np.zeros(1), x)[:, 0]


def gain_across(cross: Sequence[Cross], x: Array, y: Array, rows: int) -> Array:
    """Return the gain of the log likelihood at strengths (g,) and (h,), (rows, g, h)."""
    if not cross:
        return np.zeros((rows, len(x), len(y)))
    products = np.array(
        [np.concatenate([c.first.products, c.second.products[1:], c.mixed]) for c in cross]
    )
    doubts = np.array([[one.first.doubt, one.second.doubt] for one in cross])
    return _on_grid(products, doubts, [one.first for one in cross], x, y)


def _on_grid(products: Array, doubts: Array, terms: Sequence[Terms], x: Array, y: Array) -> Array:
    freedom = np.array([one.freedom for one in terms])
    levels = np.array([one.levels for one in terms])
    return gain_on_grid(products, doubts, freedom, levels, x, y)
