"""Importance sampling of problems that fall into blocks.

A point of the common unknowns is weighed by the product of what each block says there, and each of
these is a mean over a few draws of the block's own unknowns. Such weights are unbiased, so evidence
and error are those of plain importance sampling; but the scatter of a block is divided by the
number of its draws before blocks multiply. Ten blocks, each with half of its draws effective, would
leave one draw in a thousand if drawn together, and one in two or three this way.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy import special

from calibrate.arrays import Array
from calibrate.inference.blocks.outline import Common, Outline
from calibrate.inference.blocks.site import Site
from calibrate.inference.blocks.structure import Block, Split
from calibrate.inference.blocks.tied import delta_coordinate, relative_log_density
from calibrate.inference.likelihood import IMPOSSIBLE, log_likelihood
from calibrate.inference.sampler.importance import RELIABLE, Weighted, adapt, doubt_of, take, weigh
from calibrate.inference.sampler.mixture import Mixture, effective_size
from calibrate.inference.sampler.modes import find_modes
from calibrate.inference.sampler.target import Target, log_prior

__all__ = ["weigh_blocks"]

_SITE_DRAWS: Final = 4000
_COMPONENTS: Final = 0.005  # share of a site below which a component is left out
_PILOT: Final = (500, 8)  # common points and draws of each block there
_FINAL: Final = (4000, 16_000)
_HOPE: Final = 5.0  # times as many effective draws as their number says, after another fit
_DRAWS: Final = (2, 64)  # of a block at one common point
_SCATTER: Final = 0.5  # variance of log weights that all blocks together may add
_ROUNDS: Final = 4
_GOOD: Final = 0.3
_FITS: Final = 5
_RESULT: Final = 4000  # draws of equal weight


@dataclass(frozen=True, eq=False)
class _Own:
    """Draws of one block's unknowns at n common points: coordinates (n, r, d) and log weights."""

    w: Array
    log_w: Array

    @property
    def log_mean(self) -> Array:
        """Logarithm of the mean weight at every point, (n,)."""
        total = special.logsumexp(self.log_w, axis=1)
        return np.asarray(total - math.log(self.log_w.shape[1]))


@dataclass(frozen=True, eq=False)
class _Drawn:
    """Common points with weights, and the draws of every block there."""

    common: Common
    g: Array
    log_w: Array
    own: tuple[_Own, ...]

    @property
    def weights(self) -> Array:
        """Weights of the points, (n,), sum 1."""
        return np.asarray(np.exp(self.log_w - special.logsumexp(self.log_w)))

    @property
    def scatter(self) -> Array:
        """Relative variance of the weights of one draw of each block, (blocks,)."""
        found = []
        for one in self.own:
            inner = np.exp(one.log_w - one.log_mean[:, None])
            found.append(float(self.weights @ inner.var(axis=1, ddof=1)))
        return np.array(found)


def weigh_blocks(target: Target, split: Split, rng: np.random.Generator) -> Weighted:
    """Return draws of the posterior, of equal weight, and the evidence.

    Parameters
    ----------
    target : Target
    split : Split
        Of the target's problem.
    rng : Generator
    """
    share = 0.5 / len(split.blocks)
    sites = []
    for number, block in enumerate(split.blocks):
        sites.append(_site(target, block, rng))
        target.progress(share * (number + 1))
    outline = Outline(split, tuple(sites))
    proposal = adapt(outline, find_modes(outline, rng), rng)
    target.progress(0.6)
    few, each = _PILOT
    counts = np.full(len(split.blocks), each)
    for _ in range(_ROUNDS):
        pilot = _drawn(target, outline, proposal, few, counts, rng)
        counts = _wanted(pilot.scatter)
        if effective_size(pilot.weights) > _GOOD * few:
            break
        proposal = _mixed(proposal, pilot)
    target.progress(0.65)
    count = _FINAL[0]
    drawn = _drawn(target, outline, proposal, count, counts, rng)
    size = effective_size(drawn.weights)
    if RELIABLE > size > RELIABLE * _FINAL[0] / _FINAL[1] / _HOPE:
        drawn = _drawn(target, outline, _mixed(proposal, drawn), _FINAL[1], counts, rng)
    return _equal(split, drawn, rng)


def _site(target: Target, block: Block, rng: np.random.Generator) -> Site:
    """Fit a mixture to what a block alone says."""
    own = Target(block.problem, target.stop)
    mixture = adapt(own, find_modes(own, rng), rng)
    found = weigh(own, mixture, _SITE_DRAWS, rng)
    mixture = mixture.refitted(found.z, found.weights, _FITS)
    kept = mixture.weights > _COMPONENTS
    mixture = Mixture(
        mixture.weights[kept], mixture.means[kept], mixture.covariances[kept], mixture.dof
    )
    target.calls += own.calls * len(block.problem.places) // max(len(target.problem.places), 1)
    return Site.of(mixture, found.log_evidence, len(block.own))


def _wanted(scatter: Array) -> Array:
    """Return how many draws each block needs so that their scatter stays within bounds."""
    root = np.sqrt(scatter)
    wanted = np.ceil(root * root.sum() / _SCATTER)
    return np.asarray(np.clip(wanted, *_DRAWS).astype(int))


def _mixed(proposal: Mixture, drawn: _Drawn) -> Mixture:
    """Return a proposal moved towards weighted points."""
    return proposal.refitted(drawn.g, drawn.weights, _FITS)


def _drawn(
    target: Target,
    outline: Outline,
    proposal: Mixture,
    count: int,
    counts: Array,
    rng: np.random.Generator,
) -> _Drawn:
    """Draw common points and each block's unknowns there, and weigh them."""
    split = outline.split
    g = proposal.draw(count, rng)
    common = Common.of(split, g)
    log_w = log_prior(g) - proposal.log_density(g)
    log_w += log_likelihood(split.rest, common.values)
    own = []
    for block, site, each in zip(split.blocks, outline.sites, counts, strict=True):
        own.append(_own(target, split, block, site, common, int(each), rng))
        log_w = log_w + own[-1].log_mean
    return _Drawn(common, g, np.maximum(log_w, IMPOSSIBLE), tuple(own))


def _own(
    target: Target,
    split: Split,
    block: Block,
    site: Site,
    common: Common,
    count: int,
    rng: np.random.Generator,
) -> _Own:
    """Draw and weigh the unknowns of one block at common points."""
    given = common.given(split, block, site)
    w = given.draw(count, rng)
    log_w = -given.log_density(w)
    for k, column in enumerate(block.ties):
        if column >= 0:
            mean, spread = (one[:, None] for one in common.tie(column))
            log_w += relative_log_density(w[:, :, k], mean, spread)
    shared = np.repeat(common.shared(split, block), count, axis=0)
    z = w.reshape(-1, w.shape[2])
    own = Target(block.problem, target.stop)
    values = block.problem.space.from_normal(np.hstack([z, shared]))
    log_l = own.log_likelihood(values) + log_prior(z)
    target.calls += len(z) * len(block.problem.places) // max(len(target.problem.places), 1)
    return _Own(w, np.maximum(log_w + log_l.reshape(log_w.shape), IMPOSSIBLE))


def _equal(split: Split, drawn: _Drawn, rng: np.random.Generator) -> Weighted:
    """Return draws of equal weight in the coordinates of the whole problem."""
    rows = take(drawn.weights, _RESULT, rng)
    z = drawn.common.z[rows].copy()
    z[:, split.free] = rng.standard_normal((len(rows), len(split.free)))
    for block, own in zip(split.blocks, drawn.own, strict=True):
        inner = np.cumsum(np.exp(own.log_w - own.log_mean[:, None]), axis=1)[rows]
        pick = np.sum(rng.random((len(rows), 1)) * inner[:, -1:] > inner[:, :-1], axis=1)
        w = own.w[rows, pick]
        for k, (column, hyper) in enumerate(zip(block.own, block.ties, strict=True)):
            z[:, column] = w[:, k]
            if hyper >= 0:
                mean, spread = drawn.common.tie(hyper)
                z[:, column] = delta_coordinate(w[:, k], mean[rows], spread[rows])
    count, size = len(drawn.log_w), effective_size(drawn.weights)
    log_evidence = float(special.logsumexp(drawn.log_w)) - math.log(count)
    error = math.sqrt(max(1.0 / size - 1.0 / count, 0.0))
    equal, doubt = np.full(len(z), 1.0 / len(z)), doubt_of(size, count)
    return Weighted(z, equal, log_evidence, error, size, doubt)
