"""All pairs of causes at once, roughly: on the straightened bench around one point."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
from scipy import special
from scipy.linalg import cho_factor, cho_solve

from calibrate.arrays import Array
from calibrate.causes.candidates import Board
from calibrate.causes.strengths.prior import StrengthPrior
from calibrate.causes.weighing.tangent import Tangent

__all__ = ["promising"]

NODES: Final = 25
NOTHING: Final = StrengthPrior(0.0, 0.0, 1.0)
"""Of the other cause where a single one is told as a pair is."""
ZOOMS: Final = 6
SMOOTH: Final = 2.0
"""Nats between the highest node and its neighbours, below which a grid is fine enough;"""
NEAR: Final = 4.0
"""and steps to either side that closer nodes cover."""
WIDTHS: Final = 5.0  # of what the data leave of a strength, to either side of the best one
BENT: Final = 0.1


def promising(
    tangent: Tangent,
    board: Board,
    priors: Mapping[str, StrengthPrior],
    pairs: Sequence[tuple[str, str]],
    margin: float,
) -> list[tuple[str, str]]:
    """Return the pairs that may count from one point, the best first.

    Log evidences of all hypotheses are compared as the same straight bench tells them: where a
    strong cause acts, that of one point cannot be held against that of another.

    Parameters
    ----------
    tangent : Tangent
        At the point.
    board : Board
    priors : mapping
        Of the strengths, by name.
    pairs : sequence of (str, str)
    margin : float
        Nats by which a pair may lie below the base model and the best single cause.
    """
    names = [one.name for one in board.candidates]
    parts = np.array([part for one in board.candidates for part in tangent.added(one)])
    turned = cho_solve(cho_factor(tangent.covariance), parts.T)
    along = (tangent.left + tangent.slopes @ tangent.z) @ turned
    products = parts @ turned

    def told(*members: str) -> tuple[Array, Array]:
        at = [2 * names.index(name) + part for name in members for part in (0, 1)]
        return along[at], products[np.ix_(at, at)]

    def alone(name: str) -> float:
        one, products = (np.pad(part, (0, 2)) for part in told(name))
        return _integral(one, products, (priors[name], NOTHING)) + board.constant((name,))

    best = max([board.constant(()), *map(alone, names)])
    found = {
        (a, b): _integral(*told(a, b), (priors[a], priors[b])) + board.constant((a, b))
        for a, b in pairs
    }
    return sorted((p for p in found if found[p] > best - margin), key=lambda p: -found[p])


def _integral(along: Array, products: Array, priors: tuple[StrengthPrior, StrengthPrior]) -> float:
    """Return the log of likelihood gain times prior, integrated over two strengths.

    Parameters
    ----------
    along : (4,) float64
        Products of what is left with slope and bend of both causes.
    products : (4, 4) float64
        Of these among each other.
    priors : (StrengthPrior, StrengthPrior)
    """
    (x, wide), (y, high) = (_grid(along, products, priors, k) for k in (0, 1))
    log_part = _log_part(along, products, priors, x, y)
    for _ in range(ZOOMS):
        i, j = map(int, np.unravel_index(int(np.argmax(log_part)), log_part.shape))
        around = log_part[max(i - 1, 0) : i + 2, max(j - 1, 0) : j + 2]
        if log_part[i, j] - around.min() < SMOOTH:
            break
        # A peak between the nodes: closer ones around the highest, which hold nearly all of it.
        x, wide = _closer(x, wide, i, priors[0])
        y, high = _closer(y, high, j, priors[1])
        log_part = _log_part(along, products, priors, x, y)
    return float(special.logsumexp(log_part)) + sum(float(np.log(w)) for w in (wide, high) if w)


def _log_part(
    along: Array, products: Array, priors: tuple[StrengthPrior, StrengthPrior], x: Array, y: Array
) -> Array:
    """Return the log of likelihood gain times prior on a grid, (n, m)."""
    xx, yy = np.meshgrid(x, y, indexing="ij")
    powers = np.array([xx, xx**2, yy, yy**2]).reshape(4, -1)
    gain = along @ powers - 0.5 * np.sum(powers * (products @ powers), axis=0)
    found = gain.reshape(xx.shape) + priors[0].log_density(x)[:, None] + priors[1].log_density(y)
    return np.asarray(found)


def _closer(x: Array, wide: float, i: int, prior: StrengthPrior) -> tuple[Array, float]:
    """Return nodes around one of some, and their step."""
    if not wide:
        return x, wide
    low = max(prior.low, float(x[i]) - NEAR * wide)
    high = min(prior.high, float(x[i]) + NEAR * wide)
    step = (high - low) / NODES
    return low + step * (np.arange(NODES) + 0.5), step


def _grid(
    along: Array, products: Array, priors: tuple[StrengthPrior, StrengthPrior], k: int
) -> tuple[Array, float]:
    """Return a grid around where the slopes alone would put a strength, and its step."""
    prior = priors[k]
    if prior.fixed:
        return np.array([prior.low]), 0.0
    at = [0, 2]
    precision = products[np.ix_(at, at)].copy()
    precision += np.diag([0.0 if p.fixed else p.width**-2 for p in priors])
    precision += 1e-9 * np.eye(2)
    covariance = np.linalg.inv(precision)
    middle = float((covariance @ along[at])[k])
    reach = WIDTHS * float(np.sqrt(covariance[k, k]))
    # Where bends matter the slopes mislead: then the whole range is looked at.
    bent = products[2 * k + 1, 2 * k + 1] * prior.width**2 > BENT * products[2 * k, 2 * k]
    low = prior.low if bent else max(prior.low, min(middle, prior.high) - reach)
    high = prior.high if bent else min(prior.high, max(middle, prior.low) + reach)
    width = (high - low) / NODES
    return low + width * (np.arange(NODES) + 0.5), width
