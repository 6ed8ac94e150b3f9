"""The next batch of runs: those that make the answer more certain for what they cost.

What matters is the variance of the emulators, in units of the measurements' variance, averaged
over the posterior. A run is worth the fall of that sum, divided by its cost. Runs are chosen one
after another; after each the emulator is told a run that shows what it expects (a fantasy), which
changes its variance as the real run will.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final, Protocol

import numpy as np

from calibrate.arrays import Array
from calibrate.emulator.types import Inputs, Prediction

__all__ = ["Chosen", "Field", "Refinable", "best_batch", "flattened", "on_grid"]

REPEAT_BONUS: Final = 1.05
"""A repeat of a known point also tells the noise, and wins where it is this near to the best."""
SPREAD: Final = 0.7
"""Candidates are posterior draws moved by this part of the posterior's own scatter."""
GRID: Final = 1000
"""Candidates lie on so many parts of a range: no last digit of a machine becomes another run."""


class Refinable(Protocol):
    """What is needed of an emulator."""

    def predict(self, inputs: Inputs) -> Prediction:
        """Return the expected outputs and their variances."""

    def weighted_reduction(self, candidates: Inputs, at: Inputs, weights: Array) -> Array:
        """Return the fall of the weighted variance at `at` from a run at each candidate, (c,)."""

    def updated(self, inputs: Inputs, y: Array) -> Refinable:
        """Return the emulator with further runs, hyperparameters held."""


@dataclass(frozen=True)
class Field:
    """Where the runs of one emulator can be made, and where its error matters.

    Attributes
    ----------
    emulator : Refinable
        Of M outputs.
    at : Inputs
        n posterior draws; draws of several places stand below each other.
    weights : (n, M) float64
        What a unit of variance counts there: one over the measurement's variance, over the
        number of draws; 0 for what is not measured.
    candidates : Inputs
        c runs that could be made.
    known : (c,) bool
        Whether a candidate repeats a point that was run.
    costs : (c,) float64
        What each costs, in any unit that all fields share.
    """

    emulator: Refinable
    at: Inputs
    weights: Array
    candidates: Inputs
    known: Array
    costs: Array


@dataclass(frozen=True)
class Chosen:
    """A run that is worth its cost.

    Attributes
    ----------
    field, candidate : int
        Index of the field, and of the candidate in it.
    gain : float
        Fall of the sum of variance ratios that is expected of it.
    """

    field: int
    candidate: int
    gain: float


def best_batch(fields: Sequence[Field], count: int, budget: float = np.inf) -> list[Chosen]:
    """Choose runs one after another.

    Parameters
    ----------
    fields : sequence of Field
    count : int
        Most runs.
    budget : float
        Most cost of all of them.

    Returns
    -------
    list of Chosen
        In the order of choice; the same candidate twice means two seeds. Fewer than `count`
        where the budget ends or no run changes anything.
    """
    now = list(fields)
    gains = [_gains(field) for field in now]
    chosen: list[Chosen] = []
    spent = 0.0
    for _ in range(count):
        scores = [_scores(g, f, budget - spent) for g, f in zip(gains, now, strict=True)]
        k = int(np.argmax([score.max(initial=0.0) for score in scores]))
        if scores[k].max(initial=0.0) <= 0.0:
            break
        c = int(np.argmax(scores[k]))
        chosen.append(Chosen(k, c, float(gains[k][c])))
        spent += float(now[k].costs[c])
        now[k] = _imagined(now[k], c)
        gains[k] = _gains(now[k])
    return chosen


def _gains(field: Field) -> Array:
    """Return the fall of the weighted variance from each candidate, (c,)."""
    if len(field.candidates.u) == 0:
        return np.empty(0)
    return field.emulator.weighted_reduction(field.candidates, field.at, field.weights)


def _scores(gains: Array, field: Field, left: float) -> Array:
    """Return gains per cost; 0 for what cannot be paid."""
    worth = gains * np.where(field.known, REPEAT_BONUS, 1.0) / field.costs
    return np.where(field.costs <= left, worth, 0.0)


def _imagined(field: Field, candidate: int) -> Field:
    """Return the field as if a candidate had been run and shown what was expected."""
    one = field.candidates.rows(slice(candidate, candidate + 1))
    expected = field.emulator.predict(one).mean
    return replace(field, emulator=field.emulator.updated(one, expected))


def flattened(samples: Array, count: int, rng: np.random.Generator) -> Array:
    """Return points around a posterior, wider than it, on [0, 1].

    Parameters
    ----------
    samples : (n, K) float64
        Posterior draws on [0, 1].
    count : int
    rng : numpy Generator

    Returns
    -------
    (count, K) float64
        Half of them draws, half draws moved by `SPREAD` of the posterior's scatter and
        reflected at the limits; on the nearest thousandth.
    """
    drawn = samples[rng.integers(len(samples), size=count)]
    centred = samples - samples.mean(axis=0)
    moves = centred[rng.integers(len(samples), size=count)]
    moves -= centred[rng.integers(len(samples), size=count)]
    moved = drawn + np.where(np.arange(count) % 2, SPREAD, 0.0)[:, None] * moves
    folded = np.abs(np.mod(moved + 1.0, 2.0) - 1.0)
    return on_grid(folded)


def on_grid(u: Array) -> Array:
    """Return the nearest thousandths, so that no last digit becomes another run."""
    return np.asarray(np.round(u * GRID) / GRID)
