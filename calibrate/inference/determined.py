"""What the data determine, and what they do not, in numbers and in words.

An unknown whose posterior is as wide as its prior has no value worth printing: it gets a sentence,
with the experiment that would settle it; so does one that lies in one of several regions as far
apart as its range is wide, and the sentence names them. Two unknowns of which only a product (or a
sum) is determined get a sentence too.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from scipy.linalg import eigh

from calibrate.arrays import Array
from calibrate.inference.intervals import density
from calibrate.inference.posterior import Posterior, regions_of
from calibrate.inference.priors import to_unit
from calibrate.inference.space import Space

__all__ = ["Determined", "determined"]

NOTHING_RATIO: Final = 0.8
"""Posterior over prior standard deviation above which the data say nothing worth a number."""
NOTHING_NATS: Final = 0.3
"""Information below which, in the same case, that is so."""

_LEVEL: Final = 0.68
_APART: Final = 0.8  # of the range, above which regions are as far apart as it is wide
_RIDGE_ALONE: Final = 0.3  # ratio above which each of two unknowns alone is poorly determined
_RIDGE_ACROSS: Final = 0.4  # width of their best combination over that of the better of the two
_SHOWN: Final = 0.1  # square of a weight above which it is printed with a direction
_PRIOR_DRAWS: Final = 4000


@dataclass(frozen=True, eq=False)
class Determined:
    """How far the data narrow what was believed before.

    Attributes
    ----------
    table : DataFrame
        Index name; prior_sd and posterior_sd on the unit range, their ratio, nats of information
        about it alone, and determined.
    directions : DataFrame
        Best determined first: ratio of posterior to prior sd, nats, and direction in words.
    sentences : tuple of str
        What nothing determines, and what is determined together only.
    """

    table: pd.DataFrame
    directions: pd.DataFrame
    sentences: tuple[str, ...]


def determined(
    posterior: Posterior, rng: np.random.Generator, remedies: Mapping[str, str] | None = None
) -> Determined:
    """Compare a posterior with its prior.

    Parameters
    ----------
    posterior : Posterior
    rng : Generator
        For draws of the prior.
    remedies : mapping of str to str, optional
        Name of an unknown, with or without its instance -> the experiment that would determine it,
        as it stands in a sentence: ``a tilting plate``.
    """
    space = posterior.space
    asked = [i for i in space.asked if i < len(space.unknowns)]
    before = space.draw(_PRIOR_DRAWS, rng)
    prior, after = space.units(before), space.units(posterior.samples)
    rows, apart = [], {}
    for i in asked:
        wide, narrow = float(prior[:, i].std()), float(after[:, i].std())
        nats = information(prior[:, i], after[:, i])
        said = narrow < NOTHING_RATIO * wide or nats > NOTHING_NATS
        if said and (several := far_apart(space, posterior.samples, i)):
            said, apart[space.names[i]] = False, several
        rows.append((space.names[i], wide, narrow, narrow / wide, nats, said))
    columns = ["name", "prior_sd", "posterior_sd", "ratio", "nats", "determined"]
    table = pd.DataFrame(rows, columns=columns).set_index("name")
    ratio = {row[0]: row[3] for row in rows}
    together = ridges(space, before, posterior.samples, ratio)
    in_pairs = {name for pair in together for name in pair}
    sentences = [
        apart.get(space.names[i], "") or nothing_said(space, i, remedies or {})
        for i in asked
        if not table.loc[space.names[i], "determined"] and space.names[i] not in in_pairs
    ]
    sentences += together.values()
    names = [space.names[i] for i in asked]
    directions = _directions(prior[:, asked], after[:, asked], names)
    return Determined(table, directions, tuple(sentences))


def information(before: Array, after: Array) -> float:
    """Return the Kullback-Leibler divergence of two sets of draws of one number, in nats.

    Never below 0, where draws of one density end up by chance.
    """
    low, high = min(before.min(), after.min()), max(before.max(), after.max())
    edges, p = density(after, low, high)
    other_edges, q = density(before, low, high)
    centres = 0.5 * (edges[1:] + edges[:-1])
    q_density = np.interp(centres, 0.5 * (other_edges[1:] + other_edges[:-1]), q)
    q_density /= other_edges[1] - other_edges[0]
    p_density = p / (edges[1] - edges[0])
    seen = (p > 0.0) & (q_density > 0.0)
    return max(float(np.sum(p[seen] * np.log(p_density[seen] / q_density[seen]))), 0.0)


def far_apart(space: Space, samples: Array, column: int) -> str:
    """Return the sentence about an unknown in several regions that span its range, or ''."""
    spans = regions_of(space, samples, column, _LEVEL)
    prior = space.priors[column]
    if len(spans) < 2 or not prior.bounded:
        return ""
    ends = to_unit(np.array([spans[0].low, spans[-1].high]), prior.low, prior.high, prior.spacing)
    if ends[1] - ends[0] < _APART:
        return ""
    words = " or ".join(f"{one.low:.3g} to {one.high:.3g}" for one in spans)
    return f"{space.unknowns[column].key}: {words} (68 %); these data do not say which"


def nothing_said(space: Space, column: int, remedies: Mapping[str, str]) -> str:
    """Return the sentence about an unknown that nothing determines."""
    one = space.unknowns[column]
    remedy = remedies.get(one.key, remedies.get(one.name, ""))
    end = f"; {remedy} would" if remedy else ""
    return f"{one.key}: nothing in these data determines it{end}"


def ridges(
    space: Space, before: Array, after: Array, ratio: Mapping[str, float]
) -> dict[tuple[str, str], str]:
    """Return sentences about pairs of which only a combination is determined, by their names.

    Parameters
    ----------
    space : Space
    before, after : (n, K) float64
        Values drawn from prior and posterior.
    ratio : mapping of str to float
        Posterior over prior standard deviation of each unknown that is asked for.
    """
    loose = [space.index(name) for name, one in ratio.items() if one > _RIDGE_ALONE]
    found = {}
    for number, i in enumerate(loose):
        for j in loose[number + 1 :]:
            pair = [i, j]
            powers = all(space.priors[k].low > 0.0 for k in pair)
            x = [np.log(v[:, pair]) if powers else v[:, pair] for v in (before, after)]
            prior, seen = (np.cov(one, rowvar=False) for one in x)
            share, axes = eigh(seen, prior)
            width = float(np.sqrt(max(share[0], 0.0)))
            names = space.names[i], space.names[j]
            if width < _RIDGE_ACROSS * min(ratio[names[0]], ratio[names[1]]):
                found[names] = _ridge(names, axes[:, 0], powers=powers)
    return found


def _ridge(names: tuple[str, str], axis: Array, *, powers: bool) -> str:
    """Return the sentence about one pair; the larger exponent or factor becomes 1."""
    a, b = axis / axis[int(np.argmax(np.abs(axis)))]
    if powers:
        product = " ".join(
            name if abs(power - 1.0) < 5e-3 else f"{name}^{power:.2g}"
            for name, power in zip(names, (a, b), strict=True)
        )
    else:
        sign = "+" if a * b > 0.0 else "-"
        product = f"{abs(a):.2g} {names[0]} {sign} {abs(b):.2g} {names[1]}"
    return f"{names[0]}, {names[1]}: only {product} is determined, neither of them alone"


def _directions(prior: Array, after: Array, names: list[str]) -> pd.DataFrame:
    """Return the directions in which the data narrow the prior, the narrowest first."""
    if not names:
        return pd.DataFrame(columns=["ratio", "nats", "direction"])
    sizes = np.cov(after, rowvar=False).reshape(len(names), -1)
    share, axes = eigh(sizes, np.cov(prior, rowvar=False).reshape(len(names), -1))
    ratio = np.sqrt(np.maximum(share, 0.0))
    words = []
    for axis in axes.T:
        weight = axis / np.linalg.norm(axis)
        main = [k for k in np.argsort(-np.abs(weight)) if weight[k] ** 2 > _SHOWN]
        words.append(" ".join(f"{weight[k]:+.2f} {names[k]}" for k in main))
    safe = np.maximum(ratio, np.finfo(float).tiny)
    return pd.DataFrame({"ratio": ratio, "nats": -np.log(safe), "direction": words})
