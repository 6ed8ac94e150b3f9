"""What a hypothesis expects of readings, of all that it has seen and of those that it has not.

Where few draws of the whole study lie where a hypothesis lies without some readings, as that of a
base model whose data hold a strong cause, they do not tell what it expects of these (in a linear
problem distances were 2.9 in truth and 7.0 as told: `tests/calibrate/causes/test_left_out.py`).
There it is looked for anew without them, and drawn around what was found.
"""

from __future__ import annotations

from collections.abc import Sequence, Set
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from scipy import special, stats
from scipy.linalg import block_diag

from calibrate.arrays import Array
from calibrate.causes.candidates import Board
from calibrate.causes.weighing.bench import Bench
from calibrate.causes.weighing.by_modes import WIDER, evened
from calibrate.causes.weighing.cloud import cloud_of, mixture_of
from calibrate.causes.weighing.effects import added_by
from calibrate.causes.weighing.evidences import Evidences
from calibrate.causes.weighing.hypotheses import Weighed, weigh
from calibrate.causes.weighing.modes import mode_near
from calibrate.causes.weighing.switched import predicted_at
from calibrate.emulator.types import Prediction
from calibrate.inference.problem import Problem, Reading
from calibrate.inference.sampler.importance import take
from calibrate.inference.sampler.mixture import effective_size

__all__ = ["Expected", "View", "told_by_others", "views", "views_without"]

DRAWS: Final = 1000
SEED: Final = 3
ENOUGH: Final = 10.0
"""Effective draws without some readings from which a mean and its width are told."""
MANY: Final = 200.0
"""And a covariance: gains follow it, and it is known to one over the root of half of them."""


@dataclass(frozen=True)
class View:
    """A reading as a hypothesis expects it at n draws.

    Attributes
    ----------
    reading : Reading
    mean, variance : (n, L) float64
        On the model scale; the variance is the emulator's.
    covariance : (L, L) float64
        Of one measurement about the mean, on average over the draws.
    """

    reading: Reading
    mean: Array
    variance: Array
    covariance: Array

    def told(self, weights: Array | None = None) -> tuple[Array, Array, Array]:
        """Return mean, variance of the emulator, and variance of the mean over draws, (L,) each.

        Draws count alike without weights (n,).
        """
        if weights is None:
            weights = np.full(len(self.mean), 1.0 / len(self.mean))
        mean = weights @ self.mean
        return mean, weights @ self.variance, weights @ (self.mean - mean) ** 2


def views(found: Evidences, one: Weighed, rows: Array) -> list[View]:
    """Return every reading at some draws of a hypothesis, place by place."""
    every = set(range(one.terms.shape[1]))
    return _views_at(found.cloud.bench, rows, found.board, one.names, one.strengths, every)


def _views_at(
    bench: Bench, rows: Array, board: Board, names: tuple[str, ...], strengths: Array,
    which: Set[int],
) -> list[View]:  # fmt: skip
    """Return some readings at draws of a bench, on which they need not have been read."""
    told, number = [], 0
    for k, place in enumerate(board.problem.places):
        wanted = [one for n, one in enumerate(place.readings, number) if n in which]
        number += len(place.readings)
        if wanted:
            seen = bench.seen[k].rows(rows)
            prediction = predicted_at(seen, k, board.members(names), strengths[rows])
            told += [_viewed(one, prediction, bench.points[rows]) for one in wanted]
    return told


def _viewed(reading: Reading, prediction: Prediction, values: Array) -> View:
    """Return a reading as it is expected at draws with these values (n, K) of the unknowns."""
    own = prediction.columns(reading.columns)
    mean = own.mean.copy()
    for index, loading in reading.shared:
        mean += values[:, [index]] * loading
    extra = np.zeros((len(reading.y), 0)) if reading.extra is None else reading.extra
    common = np.einsum("nlf,nmf->lm", own.factors, own.factors) / max(len(mean), 1)
    alone = np.diag(own.variance.mean(axis=0)) + reading.covariance
    covariance = alone + common + extra @ extra.T
    return View(reading, mean, own.total + np.sum(extra**2, axis=1), covariance)


@dataclass(frozen=True)
class Expected:
    """A place as a hypothesis expects it, a normal distribution of its N numbers.

    Attributes
    ----------
    names : tuple of str
        Of its readings.
    y, mean : (N,) float64
        Measured and expected, on the model scale.
    covariance : (N, N) float64
        Of one measurement about the mean: measurement, emulator and what the parameters leave open.
    """

    names: tuple[str, ...]
    y: Array
    mean: Array
    covariance: Array

    def log_density(self, y: Array) -> Array:
        """Return the log density of numbers (..., N)."""
        normal = stats.multivariate_normal(self.mean, self.covariance, allow_singular=True)
        return np.asarray(normal.logpdf(y))


def told_by_others(found: Evidences, names: tuple[str, ...]) -> list[Expected]:
    """Return every place as a hypothesis expects it that has not seen it, in their order.

    Parameters
    ----------
    found : Evidences
    names : tuple of str
        Of the hypothesis's members; () is the base model.
    """
    told, first = [], 0
    for place in found.board.problem.places:
        own = range(first, first + len(place.readings))
        first += len(own)
        told.append(_expected(views_without(found, names, own, MANY)))
    return told


def views_without(
    found: Evidences, names: tuple[str, ...], which: Sequence[int], enough: float = ENOUGH
) -> list[View]:
    """Return readings as a hypothesis expects them that has not seen them, at equal draws.

    Parameters
    ----------
    found : Evidences
    names : tuple of str
        Of the hypothesis's members; () is the base model.
    which : sequence of int
        Numbers of the readings, place by place.
    enough : float
        Effective draws of the whole study that are taken as they are; else others are made.
    """
    one, rng = found.weighed[names], np.random.default_rng([SEED, *which])
    less = one.log_weight - one.terms[:, list(which)].sum(axis=1)
    if effective_size(special.softmax(less)) >= enough:
        rows = take(special.softmax(less), DRAWS, rng)
        bench, strengths = found.cloud.bench, one.strengths
    else:
        start = found.cloud.z[int(np.argmax(less + found.cloud.log_drawn))]
        bench, strengths, rows = _anew(found.board, names, which, start, rng)
    return _views_at(bench, rows, found.board, names, strengths, set(which))


def _anew(
    board: Board, names: tuple[str, ...], which: Sequence[int], start: Array,
    rng: np.random.Generator,
) -> tuple[Bench, Array, Array]:  # fmt: skip
    """Return a bench and strengths (n, m) of a hypothesis without some readings, and its draws."""
    problem, members = _without(board.problem, set(which)), board.members(names)
    priors = [board.strength_prior(member) for member in members]
    mode = mode_near(problem, start, members, priors)
    around = mixture_of([mode.z], [WIDER * mode.covariance], [1.0])
    cloud = cloud_of(problem, around, DRAWS, rng)
    before = cloud.log_weight
    added = [added_by(cloud.bench, member) for member in members]
    here = weigh(cloud, before, before + cloud.bench.rough, members, added, priors, 0.0, rng)
    rows = take(special.softmax(evened(here.log_weight)), DRAWS, rng)
    return cloud.bench, here.strengths, rows


def _without(problem: Problem, which: Set[int]) -> Problem:
    """Return a problem in which some readings were not read."""
    places, number = [], 0
    for place in problem.places:
        numbered = enumerate(place.readings, number)
        places.append(replace(place, readings=tuple(r for k, r in numbered if k not in which)))
        number += len(place.readings)
    return replace(problem, places=tuple(places))


def _expected(seen: Sequence[View]) -> Expected:
    """Return what some draws expect of the readings of a place."""
    mean = np.column_stack([view.mean for view in seen])
    within = block_diag(*(view.covariance for view in seen))
    names = tuple(view.reading.name for view in seen)
    y = np.concatenate([view.reading.y for view in seen])
    return Expected(names, y, mean.mean(axis=0), within + np.cov(mean.T))
