"""Hypotheses weighed on a cloud: evidence, its error, strengths and parameters after the data."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy import special

from calibrate.arrays import Array
from calibrate.causes.candidates import Candidate
from calibrate.causes.strengths.grids import COARSE, Line, Plane
from calibrate.causes.strengths.prior import StrengthPrior
from calibrate.causes.weighing.bounds import gains
from calibrate.causes.weighing.cloud import Cloud
from calibrate.causes.weighing.effects import Added
from calibrate.causes.weighing.switched import terms_with
from calibrate.inference.sampler.mixture import effective_size

__all__ = ["Weighed", "rough_evidence", "summed", "weigh"]

FAR: Final = 12.0
"""Nats below the heaviest at which a draw is weighed by the polynomial alone."""
FIRST: Final = 200
"""Draws that tell how high the highest are."""


@dataclass(frozen=True, eq=False)
class Weighed:
    """A hypothesis after the data.

    Attributes
    ----------
    names : tuple of str
        Of its members; () is the base model.
    log_evidence, error : float
        Logarithm of the probability of the data, and its standard error.
    size : float
        Effective number of draws behind it.
    log_weight : (n,) float64
        Of the draws of the cloud, not normalised.
    strengths : (n, m) float64
        Of the members at the draws, in ordinary ones.
    terms : (n, R) float64
        Log density of every reading at draws and strengths.
    """

    names: tuple[str, ...]
    log_evidence: float
    error: float
    size: float
    log_weight: Array
    strengths: Array
    terms: Array

    @property
    def weights(self) -> Array:
        """Of the draws, sum 1, (n,)."""
        return np.asarray(special.softmax(self.log_weight))


def rough_evidence(
    cloud: Cloud,
    log_weight: Array,
    added: Sequence[Added],
    priors: Sequence[StrengthPrior],
) -> Array:
    """Return log weights of the draws with the strengths integrated by the polynomial, (n,).

    Parameters
    ----------
    cloud : Cloud
    log_weight : (n,) float64
        Of its draws under the base model.
    added : sequence of Added
    priors : sequence of StrengthPrior
    """
    if not added:
        return log_weight
    found = np.full(len(log_weight), -np.inf)
    worth = _worth(cloud, log_weight, added, priors)
    found[worth.which] = worth.rough
    fine = worth.first(SERVED)
    grid = _grid(cloud, log_weight, added, priors, fine.which)
    found[fine.which] = log_weight[fine.which] + grid.log_integral + fine.stands_for
    return found


@dataclass(frozen=True)
class _Worth:
    """Draws that can count, the heaviest first; (n,) each.

    ``stands_for`` is the logarithm of the number of draws that one of them stands for, which
    ``rough``, its log weight as a coarse grid sees it, counts.
    """

    which: Array
    rough: Array
    stands_for: Array

    def first(self, count: int) -> _Worth:
        """Return the heaviest."""
        return _Worth(self.which[:count], self.rough[:count], self.stands_for[:count])


def _worth(
    cloud: Cloud, log_weight: Array, added: Sequence[Added], priors: Sequence[StrengthPrior]
) -> _Worth:
    """Return the draws that can count."""
    bound, likely = gains(cloud.bench, added, priors)
    order = np.argsort(-(log_weight + likely))
    first = order[:FIRST]
    grid = _grid(cloud, log_weight, added, priors, first)
    reached = log_weight[first] + grid.log_integral
    # The integral over a strength is below its highest value where the prior is below 1.
    most = log_weight + bound
    kept = most[order] > reached.max() - FAR - MARGIN
    kept[:FIRST] = True
    worth = np.asarray(order[kept])
    stands_for = np.zeros(len(worth))
    if isinstance(grid, Plane):
        worth, stands_for = _thinned(worth)
        rough = log_weight[worth] + _grid(cloud, log_weight, added, priors, worth).log_integral
    else:
        terms = added[0].rows(worth).terms(cloud.bench.slim(worth))
        line = Line.between(terms, priors[0], *grid.span, len(worth), COARSE)
        rough = log_weight[worth] + line.log_integral
    rough = rough + stands_for
    heaviest = np.argsort(-rough)
    return _Worth(worth[heaviest], rough[heaviest], stands_for[heaviest])


def _thinned(ordered: Array) -> tuple[Array, Array]:
    """Return the first draws and an even choice of the rest, and the log of what each stands for.

    Leaving the rest out would cost a pair evidence, more the better the cloud serves it.
    """
    first, rest = ordered[:MOST_FOR_TWO], ordered[MOST_FOR_TWO:]
    if len(rest) <= OTHERS:
        return ordered, np.zeros(len(ordered))
    chosen = rest[((np.arange(OTHERS) + 0.5) * len(rest) / OTHERS).astype(int)]
    each = np.log(len(rest) / OTHERS)
    return np.append(first, chosen), np.append(np.zeros(len(first)), np.full(OTHERS, each))


def _served(worth: _Worth) -> _Worth:
    """Return the draws whose strengths are drawn: all but the lightest that hold next to nothing.

    Data that say little leave weight on all of a cloud.
    """
    reached = np.cumsum(special.softmax(worth.rough))
    return worth.first(max(SERVED, int(np.searchsorted(reached, 1.0 - REST)) + 1))


SERVED: Final = 3000
"""Draws whose strengths are looked at finely, at least; others count by a coarse grid at first."""
REST: Final = 1e-4
"""Share of the weight that lighter draws may hold without any part in the result."""
MOST_FOR_TWO: Final = 1500
"""Draws at which two strengths are looked at, those that could count most;"""
OTHERS: Final = 500
"""and those that stand for all others."""
MARGIN: Final = 4.0
"""Nats by which a prior density may exceed 1 around an independent measurement."""


def _grid(
    cloud: Cloud,
    log_weight: Array,
    added: Sequence[Added],
    priors: Sequence[StrengthPrior],
    which: Array,
) -> Line | Plane:
    bench = cloud.bench.slim(which)
    own = [one.rows(which) for one in added]
    if len(own) == 1:
        return Line.of(own[0].terms(bench), priors[0], log_weight[which])
    return Plane.of(own[0].cross(own[1], bench), (priors[0], priors[1]), log_weight[which])


def weigh(
    cloud: Cloud,
    before: Array,
    log_weight: Array,
    members: Sequence[Candidate],
    added: Sequence[Added],
    priors: Sequence[StrengthPrior],
    constant: float,
    rng: np.random.Generator,
) -> Weighed:
    """Weigh a hypothesis.

    Parameters
    ----------
    cloud : Cloud
        Of n draws.
    before : (n,) float64
        Their log weights without any data.
    log_weight : (n,) float64
        Of the draws under the base model, as the grids see it.
    members : sequence of Candidate
    added : sequence of Added
        What each adds at the draws.
    priors : sequence of StrengthPrior
    constant : float
        Log density of independent measurements of causes that are off.
    rng : Generator
    """
    names = tuple(one.name for one in members)
    count, bench = len(cloud), cloud.bench
    if not members:
        found = before + bench.log_likelihood + constant
        return summed(names, found, np.zeros((count, 0)), bench.terms)
    served = _served(_worth(cloud, log_weight, added, priors))
    which = served.which
    grid = _grid(cloud, log_weight, added, priors, which)
    rough = log_weight[which] + grid.log_integral + served.stands_for
    drawn, log_drawn = _drawn(grid, rng)
    near = rough > rough.max() - FAR
    at, x = which[near], drawn[near]
    strengths, terms = np.zeros((count, len(members))), bench.terms.copy()
    strengths[at] = x
    terms[at] = terms_with(bench, members, x, at)
    believed = sum(prior.log_density(one) for prior, one in zip(priors, x.T, strict=True))
    # Exact now: likelihood and prior of the strength that was drawn, over the density it had.
    found = np.full(count, -np.inf)
    likelihood = terms[at].sum(axis=1) + bench.known[at]
    found[at] = before[at] + likelihood + believed - log_drawn[near] + constant
    found[at] += served.stands_for[near]
    return summed(names, found, strengths, terms)


def _drawn(grid: Line | Plane, rng: np.random.Generator) -> tuple[Array, Array]:
    x, log_drawn = grid.draw(rng)
    return (x[:, None] if x.ndim == 1 else x), log_drawn


def summed(names: tuple[str, ...], log_weight: Array, strengths: Array, terms: Array) -> Weighed:
    """Return a hypothesis from the log weights of the draws."""
    count = len(log_weight)
    total = float(special.logsumexp(log_weight))
    size = effective_size(np.exp(log_weight - total))
    error = float(np.sqrt(max(1.0 / max(size, 1.0) - 1.0 / count, 0.0)))
    return Weighed(names, total - np.log(count), error, size, log_weight, strengths, terms)
