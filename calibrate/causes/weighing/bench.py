"""What the base model expects at many draws of its unknowns, and how far the data lie from it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from scipy import special

from calibrate.arrays import Array
from calibrate.emulator.emulator import Scores
from calibrate.emulator.types import Inputs, Prediction
from calibrate.emulator.with_effects import WithEffects
from calibrate.inference.likelihood import log_density, misfit
from calibrate.inference.problem import Place, Problem, Reading

__all__ = ["Bench", "Seen", "bench_at", "whitened"]

HALF: Final = 0.5
"""Ordinary strengths by which a cause is switched on to see what it does, where no twins say it."""


@dataclass(frozen=True, eq=False)
class Seen:
    """One place at n draws.

    Attributes
    ----------
    place : Place
    inputs : Inputs
        Of its emulator, with all candidate causes off.
    scores : Scores or None
        Components without causes, where the emulator learnt causes by themselves.
    prediction : Prediction
        Without causes.
    """

    place: Place
    inputs: Inputs
    scores: Scores | None
    prediction: Prediction

    def rows(self, which: Array) -> Seen:
        """Return some of the draws."""
        scores = None
        if self.scores is not None:
            scores = tuple((mean[which], variance[which]) for mean, variance in self.scores)
        p = self.prediction
        some = Prediction(p.mean[which], p.variance[which], p.factors[which])
        return Seen(self.place, self.inputs.rows(which), scores, some)

    def changes(
        self, column: int, at: tuple[float, float] | None = None
    ) -> tuple[Array, Array, Array]:
        """Return what a cause adds per strength, per squared strength, and how uncertain that is.

        The first two are (n, M); the third holds independent deviations per strength, (n, M, Q).
        Strengths `at` which that is what is expected may be given.
        """
        emulator = self.place.emulator
        if isinstance(emulator, WithEffects):
            return emulator.parts(column, self.inputs.u, at)
        above, below = (self._switched(column, side) for side in (HALF, -HALF))
        up, down, middle = above.mean, below.mean, self.prediction.mean
        doubt = np.sqrt(np.maximum(above.total - self.prediction.total, 0.0)) / HALF
        bend = (up + down - 2.0 * middle) / (2.0 * HALF**2)
        # Where no twins say more, every number goes wrong by itself.
        return (up - down) / (2.0 * HALF), bend, doubt[:, :, None] * np.eye(doubt.shape[1])

    def _switched(self, column: int, strength: Array | float) -> Prediction:
        strengths = self.inputs.strengths.copy()
        strengths[:, column] = strength
        return self.place.emulator.predict(replace(self.inputs, strengths=strengths))

    def predict(self, strengths: Sequence[tuple[int, Array]]) -> Prediction:
        """Return what is expected with causes on: columns, and strengths (n,)."""
        emulator = self.place.emulator
        if not strengths:
            return self.prediction
        if isinstance(emulator, WithEffects) and self.scores is not None:
            return emulator.switched(self.scores, self.inputs.u, strengths)
        on = self.inputs.strengths.copy()
        for column, strength in strengths:
            on[:, column] = strength
        return emulator.predict(replace(self.inputs, strengths=on))


@dataclass(frozen=True, eq=False)
class Bench:
    """All places at n draws, and the data there in units of their errors.

    Attributes
    ----------
    problem : Problem
    points : (n, K) float64
        Values of the base model's unknowns.
    seen : tuple of Seen
    whitening : tuple of (n, L, L) float64
        Of every reading; turns what is left into independent numbers of unit variance, errors of
        the emulators and of the measurement counted.
    left : tuple of (n, L) float64
        Measured minus expected, whitened.
    freedom : tuple of (n,) float64
        Degrees of freedom of each reading's error, that of the emulator counted; 0 for a known
        one.
    terms : (n, R) float64
        Log density of every reading without causes, exact.
    known : (n,) float64
        Log density of independent measurements of the unknowns.
    """

    problem: Problem
    points: Array
    seen: tuple[Seen, ...]
    whitening: tuple[Array, ...]
    left: tuple[Array, ...]
    freedom: tuple[Array, ...]
    terms: Array
    known: Array

    def __len__(self) -> int:
        """Return n."""
        return len(self.points)

    @property
    def rough(self) -> Array:
        """Log likelihood as the grids of strengths see it, (n,)."""
        total = self.known.copy()
        for turned, left, freedom in zip(self.whitening, self.left, self.freedom, strict=True):
            levels = left.shape[1]
            square = np.sum(left**2, axis=1)
            total += np.log(turned[:, range(levels), range(levels)]).sum(axis=1)
            if freedom.any():
                half = 0.5 * (freedom + levels)
                total += special.gammaln(half) - special.gammaln(0.5 * freedom)
                total -= half * np.log1p(square / freedom)
                total -= 0.5 * levels * np.log(freedom * np.pi)
            else:
                total -= 0.5 * (square + levels * np.log(2.0 * np.pi))
        return np.asarray(total)

    @property
    def log_likelihood(self) -> Array:
        """Log likelihood without causes, (n,)."""
        return np.asarray(self.terms.sum(axis=1) + self.known)

    def rows(self, which: Array) -> Bench:
        """Return some of the draws."""
        return Bench(
            self.problem,
            self.points[which],
            tuple(one.rows(which) for one in self.seen),
            tuple(one[which] for one in self.whitening),
            tuple(one[which] for one in self.left),
            tuple(one[which] for one in self.freedom),
            self.terms[which],
            self.known[which],
        )

    def slim(self, which: Array) -> Bench:
        """Return what is left at some of the draws, nothing else."""
        left, freedom = (tuple(one[which] for one in part) for part in (self.left, self.freedom))
        terms = self.terms[which]
        return Bench(self.problem, self.points[which], (), (), left, freedom, terms, self.known)

    def joined(self, other: Bench) -> Bench:
        """Return these draws with others below."""
        return Bench(
            self.problem,
            np.concatenate([self.points, other.points]),
            tuple(_stacked(a, b) for a, b in zip(self.seen, other.seen, strict=True)),
            tuple(np.concatenate(two) for two in zip(self.whitening, other.whitening, strict=True)),
            tuple(np.concatenate(two) for two in zip(self.left, other.left, strict=True)),
            tuple(np.concatenate(two) for two in zip(self.freedom, other.freedom, strict=True)),
            np.concatenate([self.terms, other.terms]),
            np.concatenate([self.known, other.known]),
        )


def _stacked(a: Seen, b: Seen) -> Seen:
    scores = None
    if a.scores is not None and b.scores is not None:
        scores = tuple(
            (np.concatenate([m, n]), np.concatenate([v, w]))
            for (m, v), (n, w) in zip(a.scores, b.scores, strict=True)
        )
    parts = [
        np.concatenate([getattr(a.prediction, name), getattr(b.prediction, name)])
        for name in ("mean", "variance", "factors")
    ]
    return Seen(a.place, a.inputs.joined(b.inputs), scores, Prediction(*parts))


def bench_at(problem: Problem, values: Array) -> Bench:
    """Return what the base model expects at draws.

    Parameters
    ----------
    problem : Problem
        The base model.
    values : (n, K) float64
    """
    seen = tuple(_look(place, values) for place in problem.places)
    whitening, left, freedom, terms = [], [], [], []
    for one in seen:
        for reading in one.place.readings:
            own = one.prediction.columns(reading.columns)
            turned = whitened(reading, own)
            away = misfit(reading, one.prediction, values)
            whitening.append(turned)
            left.append(np.einsum("nkl,nl->nk", turned, away))
            freedom.append(_freedom(reading, own))
            terms.append(log_density(reading, one.prediction, values))
    known = np.zeros(len(values))
    for fact in problem.known:
        known += -0.5 * ((values[:, fact.index] - fact.value) / fact.se) ** 2
        known -= np.log(fact.se) + 0.5 * np.log(2.0 * np.pi)
    table = np.column_stack(terms) if terms else np.zeros((len(values), 0))
    return Bench(problem, values, seen, tuple(whitening), tuple(left), tuple(freedom), table, known)


def _look(place: Place, values: Array) -> Seen:
    inputs = place.inputs(values)
    emulator = place.emulator
    if isinstance(emulator, WithEffects):
        scores = emulator.scores(inputs)
        return Seen(place, inputs, scores, emulator.base.assembled(scores))
    return Seen(place, inputs, None, emulator.predict(inputs))


def whitened(reading: Reading, own: Prediction) -> Array:
    """Return the inverse Cholesky factors of a reading's covariance, (n, L, L)."""
    if len(reading.se) == 1:
        total = own.variance + reading.se**2 + np.sum(own.factors**2, axis=2)
        if reading.extra is not None:
            total = total + np.sum(reading.extra**2, axis=1)
        return np.asarray(1.0 / np.sqrt(total))[:, :, None]
    total = own.factors @ np.swapaxes(own.factors, 1, 2)
    if reading.extra is not None:
        total = total + reading.extra @ reading.extra.T
    at = np.arange(len(reading.se))
    total[:, at, at] += own.variance
    total += reading.covariance
    return np.asarray(np.linalg.inv(np.linalg.cholesky(total)))


def _freedom(reading: Reading, own: Prediction) -> Array:
    """Return the degrees of freedom of a reading's error, the emulator's own error counted.

    Welch and Satterthwaite: of a sum of variances v and s^2, of which the second was told by
    repeats with f degrees of freedom, f (1 + v / s^2)^2.
    """
    if reading.repeats == 0:
        return np.zeros(len(own.mean))
    ratio = np.mean(own.total / reading.se**2, axis=1)
    return np.asarray((reading.repeats - 1) * (1.0 + ratio) ** 2)
