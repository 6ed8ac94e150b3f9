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

__all__ = ["pair_gains"]

NODES: Final = 25
MANY: Final = 400
WIDTHS: Final = 5.0  # of what the data leave of a strength, to either side of the best one
BENT: Final = 0.1


def pair_gains(
    tangent: Tangent,
    board: Board,
    priors: Mapping[str, StrengthPrior],
    pairs: Sequence[tuple[str, str]],
    beside: tuple[str, ...] = (),
) -> dict[tuple[str, str], float]:
    """Return log evidence ratios of pairs against the base model, or against a single cause.

    Where a strong cause acts, the point is one of its own, far from those of the base model, and
    nothing is told against that from there.

    Parameters
    ----------
    tangent : Tangent
    board : Board
    priors : mapping
        Of the strengths, by name.
    pairs : sequence of (str, str)
    beside : tuple of str
        The single cause.
    """
    names = [one.name for one in board.candidates]
    parts = np.array([part for one in board.candidates for part in tangent.added(one)])
    turned = cho_solve(cho_factor(tangent.covariance), parts.T)
    along = (tangent.left + tangent.slopes @ tangent.z) @ turned
    products = parts @ turned
    found = {}
    known = 0.0
    for k in map(names.index, beside):
        at = [2 * k, 2 * k + 1]
        known = _single(along[at], products[np.ix_(at, at)], priors[beside[0]])
    for a, b in pairs:
        i, j = names.index(a), names.index(b)
        at = [2 * i, 2 * i + 1, 2 * j, 2 * j + 1]
        found[a, b] = _integral(along[at], products[np.ix_(at, at)], (priors[a], priors[b]))
        found[a, b] -= known
    return found


def _single(along: Array, products: Array, prior: StrengthPrior) -> float:
    """Return the log of likelihood gain times prior, integrated over one strength."""
    wide = (prior.high - prior.low) / MANY
    x = np.array([prior.low]) if prior.fixed else prior.low + wide * (np.arange(MANY) + 0.5)
    powers = np.array([x, x**2])
    gain = along @ powers - 0.5 * np.sum(powers * (products @ powers), axis=0)
    step = 0.0 if prior.fixed else float(np.log(wide))
    return float(special.logsumexp(gain + prior.log_density(x))) + step


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
    xx, yy = np.meshgrid(x, y, indexing="ij")
    powers = np.array([xx, xx**2, yy, yy**2]).reshape(4, -1)
    gain = along @ powers - 0.5 * np.sum(powers * (products @ powers), axis=0)
    log_part = gain.reshape(xx.shape) + priors[0].log_density(x)[:, None] + priors[1].log_density(y)
    return float(special.logsumexp(log_part)) + sum(float(np.log(w)) for w in (wide, high) if w)


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
