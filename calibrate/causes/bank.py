"""How probable imagined studies are under a hypothesis.

A bank is one set of draws from a hypothesis, wide enough for all studies that differ by their
errors; what the emulators expect is computed once, and every study only weighs the draws.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from scipy import special

from calibrate.arrays import Array
from calibrate.causes.candidates import Measured
from calibrate.causes.hypotheses import Hypothesis, Weighed
from calibrate.causes.imagined import Studies, means, observed
from calibrate.inference.evidence import fitted, start_from
from calibrate.inference.likelihood import nodes, variances
from calibrate.inference.problem import Known, Place, Problem, Reading
from calibrate.inference.sampler.target import Target, log_prior

__all__ = ["Bank", "bank_of", "sways"]

DRAWS: Final = (2000, 16_000)
"""Draws of a bank, at least and at most."""
PER_STUDY: Final = 1000
"""Draws that would do for one study alone; a bank serves studies whose posteriors lie around each
other with twice the spread of one, so that each uses 3^(-K/2) of the draws in K dimensions."""
POWER: Final = 0.35
"""Of the likelihood from which a bank is drawn: studies differ in values and errors."""
PRIOR_SHARE: Final = 0.1
"""Share of a bank's draws that come from the prior."""
WIDEST: Final = 1e3
"""Largest true over stated variance of an error: imagined data lie no further away."""
OTHERS: Final = 100
"""Imagined emulators from other runs."""
BLOCK: Final = 4_000_000
"""Numbers that are worked on at once."""


@dataclass(frozen=True, eq=False)
class _Expected:
    """What the draws of a bank expect of one reading.

    Attributes
    ----------
    reading : Reading
    place : int
    mean : (S, L) float64
        Shared errors included.
    lam : (S, L), axes : (S, L, L) float64
        See `calibrate.inference.likelihood.variances`.
    """

    reading: Reading
    place: int
    mean: Array
    lam: Array
    axes: Array

    def log_density(self, y: Array) -> Array:
        """Return the log density of readings (B, L) at every draw, (B, S)."""
        w, log_weight = _few_nodes(self.reading.repeats, len(self.reading.se))
        total = self.lam[:, None, :] + w[:, None]  # (S, q, L)
        constant = log_weight - 0.5 * np.log(total).sum(axis=2)
        constant -= np.log(self.reading.se).sum() + 0.5 * y.shape[1] * np.log(2.0 * np.pi)
        found = np.empty((len(y), len(self.mean)))
        step = max(1, BLOCK // self.mean.size)
        for start in range(0, len(y), step):
            some = (y[start : start + step, None, :] - self.mean) / self.reading.se
            if y.shape[1] > 1:
                some = np.einsum("bsl,slk->bsk", some, self.axes)
            found[start : start + step] = _summed(some**2, total, constant)
        return found


def _summed(squares: Array, total: Array, constant: Array) -> Array:
    """Return the logarithm of the sum over nodes of exp(constant - squares / total / 2), (b, S).

    Parameters
    ----------
    squares : (b, S, L) float64
    total : (S, q, L) float64
    constant : (S, q) float64
    """
    inverse = -0.5 / total
    # Relative to the widest node, none of the others can overflow, and one is left in any case.
    found = np.ones(squares.shape[:2])
    for q in range(total.shape[1] - 1):
        power = _dotted(squares, inverse[:, q] - inverse[:, -1])
        power += constant[:, q] - constant[:, -1]
        np.exp(power, out=power)
        found += power
    np.log(found, out=found)
    found += constant[:, -1]
    found += _dotted(squares, inverse[:, -1])
    return found


def _dotted(squares: Array, weights: Array) -> Array:
    """Return the sum over levels of squares (b, S, L) times weights (S, L), (b, S)."""
    if weights.shape[1] == 1:
        return np.asarray(squares[:, :, 0] * weights[:, 0])
    return np.asarray(np.einsum("bsl,sl->bs", squares, weights))


def _few_nodes(repeats: int, levels: int) -> tuple[Array, Array]:
    """Return a third of the nodes of the likelihood: imagined studies need fewer digits."""
    w, log_weight = nodes(repeats, levels)
    if repeats == 0:
        return w, log_weight
    few = w[::2] < WIDEST
    w, log_weight = w[::2][few], log_weight[::2][few]
    return w, log_weight - special.logsumexp(log_weight)


@dataclass(frozen=True, eq=False)
class Bank:
    """Draws from one hypothesis.

    Attributes
    ----------
    hypothesis : Hypothesis
    problem : Problem
        Of the hypothesis.
    values : (S, K) float64
    log_weight : (S,) float64
        Log prior density over the density they were drawn from.
    expected : tuple of _Expected
        In the order of the readings.
    """

    hypothesis: Hypothesis
    problem: Problem
    values: Array
    log_weight: Array
    expected: tuple[_Expected, ...]

    def terms(self, studies: Studies) -> Array:
        """Return the log density of the data of each place, (places, B, S)."""
        found = np.zeros((len(self.problem.places), len(studies), len(self.values)))
        for one, y in zip(self.expected, studies.readings, strict=True):
            found[one.place] += one.log_density(y)
        return found

    def known(self, studies: Studies) -> Array:
        """Return the log density of independent measurements, (B, S), up to a constant.

        The constant is the same for all hypotheses.
        """
        base = self.hypothesis.board.problem
        found = np.zeros((len(studies), len(self.values)))
        for k, one in enumerate(base.known):
            found += _normal(studies.known[:, k, None], self.values[:, one.index], one)
        for effect, mean in self.hypothesis.strengths(self.values).items():
            bench = self.hypothesis.board.known[effect]
            found += _normal(studies.effects[effect][:, None], mean, bench)
        return found

    def log_evidences(self, studies: Studies) -> Array:
        """Return the log evidence of every study, (B,)."""
        return self.evidences_of(self.terms(studies).sum(axis=0), self.known(studies))

    def evidences_of(self, terms: Array, known: Array) -> Array:
        """Return the log evidence from log densities of data (B, S), those of `known` added."""
        total = special.logsumexp(terms + known + self.log_weight, axis=1)
        return np.asarray(total - np.log(len(self.values)))

    def sizes(self, studies: Studies) -> Array:
        """Return the effective number of draws for every study, (B,)."""
        log_w = self.terms(studies).sum(axis=0) + self.known(studies) + self.log_weight
        w = np.exp(log_w - log_w.max(axis=1, keepdims=True))
        return np.asarray(w.sum(axis=1) ** 2 / (w**2).sum(axis=1))


def _normal(y: Array, mean: Array, bench: Known | Measured) -> Array:
    return np.asarray(-0.5 * ((y - mean) / bench.se) ** 2)


def bank_of(hypothesis: Hypothesis, centre: Studies, seed: int, known: Weighed) -> Bank:
    """Return a bank for studies like the first one of some.

    Parameters
    ----------
    hypothesis : Hypothesis
    centre : Studies
        B = 1; the middle of the studies that will be asked for.
    seed : int
        The same for all hypotheses that are compared.
    known : Weighed
        The base model, or the same hypothesis: where the search starts.
    """
    rng = np.random.default_rng(seed)
    problem = hypothesis.problem
    size = problem.space.size
    target = Target(_with_data(hypothesis, centre))
    wide = fitted(target, start_from(known.found, target), rng, POWER)
    wide = wide.joined(np.zeros(size), np.eye(size), PRIOR_SHARE)
    z = wide.draw(int(np.clip(PER_STUDY * 3.0 ** (0.5 * size), *DRAWS)), rng)
    values = problem.space.from_normal(z)
    expected = [
        one for k, place in enumerate(problem.places) for one in _expected(place, k, values)
    ]
    log_weight = log_prior(z) - wide.log_density(z)
    return Bank(hypothesis, problem, values, log_weight, tuple(expected))


def _with_data(hypothesis: Hypothesis, data: Studies) -> Problem:
    """Return the problem of a hypothesis with the data of the first of some studies."""
    board = hypothesis.board
    readings = iter(data.readings)
    places = tuple(
        replace(p, readings=tuple(replace(r, y=next(readings)[0]) for r in p.readings))
        for p in board.problem.places
    )
    known = tuple(
        replace(one, value=float(data.known[0, k])) for k, one in enumerate(board.problem.known)
    )
    bench = {name: Measured(float(data.effects[name][0]), m.se) for name, m in board.known.items()}
    base = replace(board.problem, places=places, known=known)
    return replace(hypothesis, board=replace(board, problem=base, known=bench)).problem


def _expected(place: Place, number: int, values: Array) -> Sequence[_Expected]:
    own = place.predict(values)
    return [
        _Expected(reading, number, mean, *variances(reading, own.columns(reading.columns)))
        for reading, mean in zip(place.readings, means(place, values), strict=True)
    ]


def sways(base: Weighed, others: Sequence[Weighed], seed: int) -> list[float]:
    """Return how much log evidence ratios sway between emulators from other runs, as many as here.

    Other runs would have given other expected values. Those are drawn from what the emulators say
    of their own errors at the most probable values, with the same luck for all hypotheses. Where
    emulators make up a share f^2 of all variance, a ratio R sways by about f sqrt(2 R), so that a
    large one is never sharp while they are less certain than the measurements.

    Parameters
    ----------
    base : Weighed
    others : sequence of Weighed
        Hypotheses that are compared with it.
    seed : int

    Returns
    -------
    list of float
        Standard deviations, in nats.
    """
    plain, *found = [_with_other_runs(one, seed) for one in (base, *others)]
    return [float(np.std(one - plain)) for one in found]


def _with_other_runs(one: Weighed, seed: int) -> Array:
    """Return log evidences with imagined other runs, relative to that with these, (`OTHERS`,)."""
    data = observed(one.hypothesis)
    studies = _other_runs(one, data, np.random.default_rng([seed, 4]))
    return _posterior_bank(one, data).log_evidences(studies)


def _posterior_bank(one: Weighed, data: Studies) -> Bank:
    """Return a bank of a posterior's samples; its evidences are relative to that of the data."""
    values, problem = one.samples, one.problem
    expected = [e for k, place in enumerate(problem.places) for e in _expected(place, k, values)]
    bank = Bank(one.hypothesis, problem, values, np.zeros(len(values)), tuple(expected))
    here = bank.terms(data).sum(axis=0) + bank.known(data)
    return replace(bank, log_weight=-here[0])


def _other_runs(one: Weighed, data: Studies, rng: np.random.Generator) -> Studies:
    """Return the data moved by what other runs might move the emulators, B = `OTHERS`."""
    moved, at = [], 0
    for place in one.problem.places:
        own = place.predict(one.best[None])
        error = np.sqrt(own.variance) * rng.standard_normal((OTHERS, own.mean.shape[1]))
        error += rng.standard_normal((OTHERS, own.factors.shape[2])) @ own.factors[0].T
        for reading in place.readings:
            moved.append(data.readings[at] + error[:, reading.columns])
            at += 1
    known = np.repeat(data.known, OTHERS, axis=0)
    return Studies(tuple(moved), known, {n: np.repeat(v, OTHERS) for n, v in data.effects.items()})
