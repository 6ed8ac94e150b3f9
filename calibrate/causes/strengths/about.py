"""About which strengths a leading cause is looked for: there a parabola is what it adds."""

from __future__ import annotations

from typing import Final, TypeAlias

import numpy as np

from calibrate.arrays import Array

__all__ = ["Span", "about_of", "span_of"]

Span: TypeAlias = tuple[float, float, float]
"""Strengths between which most of a cause's probability lies, with its middle."""

PARTS: Final = (0.1, 0.5, 0.9)
"""Of the probability, below the lowest, the middle and the highest of them."""
LEAST: Final = 0.7
"""Of the middle: as far apart are the strengths at which a parabola is right, at least; a pair's
are not those of a single cause."""
MOST: Final = 1.0
"""And where they were further apart, they stay the usual ones."""


def span_of(strengths: Array, weights: Array) -> Span:
    """Return between which strengths a cause lies.

    Parameters
    ----------
    strengths, weights : (n,) float64
        Of draws; the weights are 1 together.
    """
    order = np.argsort(strengths)
    at = np.searchsorted(np.cumsum(weights[order]), PARTS)
    low, middle, high = strengths[order[at.clip(0, len(order) - 1)]]
    return float(low), float(middle), float(high)


def about_of(span: Span, known: tuple[float, float] | None) -> tuple[float, float] | None:
    """Return the strengths at which a parabola shall be right; None where it stays as it is.

    Parameters
    ----------
    span : Span
    known : (float, float), optional
        About which strengths the cause was looked for.
    """
    low, middle, high = span
    wide = max(high - low, LEAST * abs(middle))
    told = known is not None and known[0] <= middle <= known[1]
    if told or wide > MOST * abs(middle):
        return None
    return middle - 0.5 * wide, middle + 0.5 * wide
