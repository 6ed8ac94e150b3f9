"""How much causes can gain at a draw at most, and about: what is not worth a grid is left out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.strengths.prior import StrengthPrior
from calibrate.causes.weighing.bench import Bench
from calibrate.causes.weighing.effects import Added

__all__ = ["gains"]

STRAIGHT: Final = 1e-3
"""Squared bend, in units of the errors, below which an answer is straight."""
USUAL: Final = 2.5
"""Ordinary strengths at which a bent answer is looked at."""
SLACK: Final = 3.0
"""Nats that a prior that is not normal may add."""


def gains(
    bench: Bench, added: Sequence[Added], priors: Sequence[StrengthPrior]
) -> tuple[Array, Array]:
    """Return the most that causes can gain at each draw, and what they gain about, (n,) each.

    Causes whose answers are straight gain what is left along them; others at most all that is left
    of the readings that they touch.
    """
    count, size = len(bench), len(added)
    total, along = np.zeros(count), np.zeros((size, count))
    square = np.zeros((size, size, count))
    straight = True
    for k in sorted({k for one in added for k in one.slopes}):
        left, freedom = bench.left[k], bench.freedom[k]
        whole = np.sum(left**2, axis=1)
        if freedom.any():
            straight = False
            half = 0.5 * (freedom + left.shape[1])
            total += half * np.log1p(whole / freedom)
        else:
            total += 0.5 * whole
        none = np.zeros_like(left)
        parts = []
        for one in added:
            bend = one.bends.get(k, none)
            straight = straight and bool((bend**2).max(initial=0.0) < STRAIGHT)
            parts.append(one.slopes.get(k, none) + USUAL * bend)
        for i, a in enumerate(parts):
            along[i] += np.einsum("nl,nl->n", left, a)
            for j, b in enumerate(parts):
                square[i, j] += np.einsum("nl,nl->n", a, b)
    for i, prior in enumerate(priors):
        square[i, i] += 1e-9 if prior.fixed else prior.width**-2
    likely = 0.5 * _quadratic(along, square)
    return (likely + SLACK if straight else total), np.minimum(likely, total)


def _quadratic(along: Array, square: Array) -> Array:
    """Return b^T A^-1 b for one or two causes, (n,)."""
    if len(along) == 1:
        return np.asarray(along[0] ** 2 / square[0, 0])
    (a, b), ((p, q), (_, s)) = along, square
    return np.asarray((s * a**2 - 2.0 * q * a * b + p * b**2) / np.maximum(p * s - q**2, 1e-300))
