"""The next batch of a study: runs that help its posterior, and what they may change."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.emulator.emulator import TrainedEmulator
from calibrate.emulator.types import Inputs
from calibrate.inference.discrepancy import discrepancy_probabilities
from calibrate.inference.likelihood import log_likelihood
from calibrate.inference.problem import Problem
from calibrate.planning.stop import expected_moves
from calibrate.questions.core.emulate import Emulators
from calibrate.questions.joint.offers import Choice, Question, choose_runs
from calibrate.study.model import Study
from liggghts_io import CaseSpec

__all__ = ["Batch", "error_ratios", "next_batch"]

FANTASIES: Final = 12
"""Outcomes of a batch that are imagined."""
JUDGED: Final = 800
"""Posterior draws that are weighed anew with each imagined outcome."""


@dataclass(frozen=True)
class Batch:
    """Runs that are worth making, and what they are expected to change.

    Attributes
    ----------
    specs : tuple of CaseSpec
    moves : tuple of float
        Expected move of each unknown's answers, in lengths of its interval.
    """

    specs: tuple[CaseSpec, ...]
    moves: tuple[float, ...]


def error_ratios(problem: Problem, samples: Array) -> dict[str, float]:
    """Return the emulator's variance over the measurement's at posterior draws, by target.

    Parameters
    ----------
    problem : Problem
    samples : (n, K) float64

    Returns
    -------
    dict of str to float
        Mean over the draws, and over the levels of a curve.
    """
    found = {}
    for place in problem.places:
        total = place.predict(samples).total
        held = 1.0 - discrepancy_probabilities(place, samples)
        for k, reading in enumerate(place.readings):
            ratio = total[:, reading.columns] / reading.se**2
            found[reading.name] = float(np.mean(ratio * held[:, k, None]))
    return found


def next_batch(
    study: Study,
    problem: Problem,
    emulators: Emulators,
    samples: Array,
    count: int,
    rng: np.random.Generator,
    first_seed: int,
) -> Batch:
    """Return the most useful runs.

    Parameters
    ----------
    study : Study
    problem : Problem
        With these emulators.
    emulators : Emulators
    samples : (n, K) float64
        Posterior draws.
    count : int
        Most runs.
    rng : numpy Generator
    first_seed : int
        Seed of the first run; the others follow.
    """
    choice = choose_runs(study, emulators, [Question(problem, samples)], count, rng, first_seed)
    judged = samples[rng.choice(len(samples), size=min(JUDGED, len(samples)), replace=False)]
    moves = _moves(problem, choice, judged, rng)
    return Batch(choice.specs, tuple(float(move) for move in moves))


def _moves(problem: Problem, choice: Choice, samples: Array, rng: np.random.Generator) -> Array:
    """Return how far the answers are expected to move once the batch has been run, (K,)."""
    if not choice.chosen:
        return np.zeros(problem.space.size)
    now = log_likelihood(problem, samples)
    ratios = []
    for _ in range(FANTASIES):
        changed: dict[int, TrainedEmulator] = {}
        for number, offer in enumerate(choice.offers):
            rows = [one.candidate for one in choice.chosen if one.field == number]
            if rows:
                inputs = offer.field.candidates.rows(np.array(rows))
                old = offer.trained.emulator
                changed[id(old)] = old.updated(inputs, _imagined(old, inputs, rng))
        places = tuple(
            replace(place, emulator=changed.get(id(place.emulator), place.emulator))
            for place in problem.places
        )
        ratios.append(log_likelihood(replace(problem, places=places), samples) - now)
    return expected_moves(samples, np.array(ratios))


def _imagined(emulator: TrainedEmulator, inputs: Inputs, rng: np.random.Generator) -> Array:
    """Draw what runs may show, (n, M)."""
    expected = emulator.predict(inputs)
    own = np.sqrt(expected.variance + emulator.noise) * rng.normal(size=expected.mean.shape)
    shared = rng.normal(size=(len(inputs), 1, expected.factors.shape[2]))
    return np.asarray(expected.mean + own + np.sum(expected.factors * shared, axis=2))
