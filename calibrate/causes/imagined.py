"""Imagined studies: values from a posterior, errors of emulators and measurements drawn anew."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.hypotheses import Hypothesis
from calibrate.inference.problem import Place, Reading

__all__ = ["Studies", "expected", "imagine", "means", "observed"]


@dataclass(frozen=True, eq=False)
class Studies:
    """Data of B studies, real or imagined.

    Attributes
    ----------
    readings : tuple of (B, L) float64
        In the order of the problem's readings.
    known : (B, k) float64
        Independent measurements of the base model's unknowns.
    effects : dict of str to (B,) float64
        Independent measurements of effects.
    """

    readings: tuple[Array, ...]
    known: Array
    effects: dict[str, Array]

    def __len__(self) -> int:
        """Return B."""
        return len(self.known)


def observed(hypothesis: Hypothesis) -> Studies:
    """Return the real data, B = 1."""
    base, bench = hypothesis.board.problem, hypothesis.board.known
    return Studies(
        tuple(one.y[None] for one in base.readings),
        np.array([[one.value for one in base.known]]),
        {effect: np.array([one.value]) for effect, one in bench.items()},
    )


def expected(hypothesis: Hypothesis, values: Array) -> Studies:
    """Return the study without any error, B = 1, at values (K,) of a hypothesis."""
    problem, board, row = hypothesis.problem, hypothesis.board, values[None]
    readings = [one for place in problem.places for one in means(place, row)]
    known = [float(values[one.index]) for one in board.problem.known]
    return Studies(
        tuple(readings),
        np.array([known], dtype=float),
        {name: np.array([one]) for name, one in hypothesis.strengths(values).items()},
    )


def imagine(
    hypothesis: Hypothesis, samples: Array, count: int, rng: np.random.Generator
) -> Studies:
    """Return studies that might have been if a hypothesis is right.

    Parameters
    ----------
    hypothesis : Hypothesis
    samples : (n, K) float64
        Its values, drawn from the posterior.
    count : int
    rng : Generator
    """
    problem, board = hypothesis.problem, hypothesis.board
    values = samples[rng.integers(len(samples), size=count)].copy()
    for column, unknown in enumerate(problem.space.unknowns):
        if unknown.nuisance:  # luck of the bench, which is drawn anew
            values[:, column] = rng.standard_normal(count)
    readings = [one for place in problem.places for one in _measured(place, values, rng)]
    known = [rng.normal(values[:, one.index], one.se) for one in board.problem.known]
    true = hypothesis.strengths(values)
    effects = {name: rng.normal(true[name], bench.se, count) for name, bench in board.known.items()}
    return Studies(tuple(readings), np.array(known).reshape(len(known), count).T, effects)


def _measured(place: Place, values: Array, rng: np.random.Generator) -> list[Array]:
    """Return what might have been read at one place, (n, L) for each reading."""
    own = place.predict(values)
    n = len(values)
    truth = own.mean + np.sqrt(own.variance) * rng.standard_normal(own.mean.shape)
    common = rng.standard_normal((n, own.factors.shape[2]))
    truth = truth + np.einsum("nmf,nf->nm", own.factors, common)
    found = []
    for reading in place.readings:
        y = truth[:, reading.columns].copy()
        for index, loading in reading.shared:
            y += values[:, [index]] * loading
        if reading.extra is not None:
            y += rng.standard_normal((n, reading.extra.shape[1])) @ reading.extra.T
        y += np.sqrt(_errors(reading, n, rng)) * reading.se * rng.standard_normal(y.shape)
        found.append(y)
    return found


def _errors(reading: Reading, count: int, rng: np.random.Generator) -> Array:
    """Return true over stated variance of the error of measurement, (count, 1)."""
    if reading.repeats == 0:
        return np.ones((count, 1))
    dof = reading.repeats - 1
    return np.asarray(dof / rng.chisquare(dof, (count, 1)))


def means(place: Place, values: Array) -> list[Array]:
    """Return what is expected of each reading, shared errors included, (n, L) each."""
    own = place.predict(values).mean
    found = []
    for reading in place.readings:
        mean = own[:, reading.columns].copy()
        for index, loading in reading.shared:
            mean += values[:, [index]] * loading
        found.append(mean)
    return found
