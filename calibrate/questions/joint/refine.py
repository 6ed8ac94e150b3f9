"""The next batch of a study: runs that help its posterior, and what they may change."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.emulator.emulator import TrainedEmulator
from calibrate.emulator.types import Inputs
from calibrate.inference.likelihood import log_likelihood
from calibrate.inference.problem import Place as Seen
from calibrate.inference.problem import Problem
from calibrate.planning.infill import Chosen, Field, best_batch, flattened
from calibrate.planning.stop import expected_moves
from calibrate.questions.core.design import Stand, case_at, stands_of
from calibrate.questions.core.emulate import Emulators, Trained
from calibrate.questions.core.problem import inputs_at, place_name
from calibrate.questions.core.runs import Runs
from calibrate.study.model import Study
from liggghts_io import CaseSpec

__all__ = ["Batch", "error_ratios", "next_batch"]

DRAWS: Final = 120
"""Posterior draws per place at which the emulators' error counts."""
CANDIDATES: Final = 60
"""New points per material and emulator that are compared."""
REPEATS: Final = 15
"""Known points per material and emulator, the nearest to the posterior, that may be repeated."""
FANTASIES: Final = 12
"""Outcomes of a batch that are imagined."""
SAME: Final = 1e-6
"""Part of a range below which two inputs are the same."""
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


@dataclass(frozen=True)
class _Offer:
    """A field, and whose its candidates are.

    Attributes
    ----------
    trained : Trained
    field : Field
    stands : tuple of Stand
        Of each candidate.
    """

    trained: Trained
    field: Field
    stands: tuple[Stand, ...]


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
        for reading in place.readings:
            ratio = total[:, reading.columns] / reading.se**2
            found[reading.name] = float(np.mean(ratio))
    return found


def next_batch(
    study: Study,
    problem: Problem,
    emulators: Emulators,
    runs: Runs,
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
    runs : Runs
        What was run so far; it tells what a run costs.
    samples : (n, K) float64
        Posterior draws.
    count : int
        Most runs.
    rng : numpy Generator
    first_seed : int
        Seed of the first run; the others follow.
    """
    seen = {place.name: place for place in problem.places}
    forms = {key: one.form for key, one in emulators.trained.items()}
    draws = samples[rng.choice(len(samples), size=min(DRAWS, len(samples)), replace=False)]
    units = problem.space.units(samples)
    wide = problem.space.values_of(flattened(units, CANDIDATES, rng))
    offers = []
    for key, trained in emulators.trained.items():
        stands = [stand for stand in stands_of(study, forms) if stand.form.key == key]
        offers.append(_offer(study, trained, stands, seen, runs, draws, wide))
    chosen = best_batch([offer.field for offer in offers], count)
    specs = tuple(
        _case(study, offers[one.field], one.candidate, first_seed + i)
        for i, one in enumerate(chosen)
    )
    judged = samples[rng.choice(len(samples), size=min(JUDGED, len(samples)), replace=False)]
    moves = _moves(problem, offers, chosen, judged, rng)
    return Batch(specs, tuple(float(move) for move in moves))


def _offer(
    study: Study,
    trained: Trained,
    stands: Sequence[Stand],
    seen: Mapping[str, Seen],
    runs: Runs,
    draws: Array,
    wide: Array,
) -> _Offer:
    """Return where the error of one emulator matters and where it can be run."""
    at: list[Inputs] = []
    weights: list[Array] = []
    candidates: list[Inputs] = []
    known: list[bool] = []
    costs: list[float] = []
    whose: list[Stand] = []
    for stand in stands:
        places = [seen[place_name(one)] for one in stand.places]
        at += [inputs_at(place, draws) for place in places]
        weights += [_weights(place, trained.form.width, len(draws)) for place in places]
        particle = study.material_named(stand.material).bulk.name
        seconds = runs.seconds(stand.form.key, particle)
        for place in places:
            new = inputs_at(place, wide)
            old = _nearest(trained.inputs, inputs_at(place, draws))
            candidates += [new, old]
            known += [False] * len(new) + [True] * len(old)
        here = len(known) - len(costs)
        costs += [seconds if seconds > 0.0 else 1.0] * here
        whose += [stand] * here
    field = Field(
        trained.emulator,
        _stacked(at),
        np.concatenate(weights),
        _stacked(candidates),
        np.array(known),
        np.array(costs),
    )
    return _Offer(trained, field, tuple(whose))


def _stacked(parts: Sequence[Inputs]) -> Inputs:
    found = parts[0]
    for part in parts[1:]:
        found = found.joined(part)
    return found


def _weights(place: Seen, width: int, draws: int) -> Array:
    """Return one over the measurement's variance, a curve counting as one number, (draws, M)."""
    weights = np.zeros(width)
    for reading in place.readings:
        weights[reading.columns] += 1.0 / (reading.se**2 * len(reading.se))
    return np.tile(weights / draws, (draws, 1))


def _nearest(known: Inputs, draws: Inputs) -> Inputs:
    """Return the known points nearest to the middle of the draws, in units of their scatter."""
    points = np.unique(np.column_stack([known.u, known.strengths]), axis=0)
    here = np.column_stack([draws.u, draws.strengths])
    middle, scatter = here.mean(axis=0), here.std(axis=0)
    # What does not vary among the draws is a number of the material, which a run cannot change.
    fixed = scatter < SAME
    points = points[np.all(np.abs(points - middle)[:, fixed] < SAME, axis=1)]
    distance = np.sum(((points - middle)[:, ~fixed] / scatter[~fixed]) ** 2, axis=1)
    chosen = points[np.argsort(distance)[:REPEATS]]
    inputs = known.u.shape[1]
    return Inputs.at(chosen[:, :inputs], chosen[:, inputs:])


def _case(study: Study, offer: _Offer, candidate: int, seed: int) -> CaseSpec:
    one = offer.field.candidates
    stand = offer.stands[candidate]
    return case_at(study, stand, one.u[candidate], one.strengths[candidate], seed)


def _moves(
    problem: Problem,
    offers: Sequence[_Offer],
    chosen: Sequence[Chosen],
    samples: Array,
    rng: np.random.Generator,
) -> Array:
    """Return how far the answers are expected to move once the batch has been run, (K,)."""
    if not chosen:
        return np.zeros(problem.space.size)
    now = log_likelihood(problem, samples)
    ratios = []
    for _ in range(FANTASIES):
        changed: dict[int, TrainedEmulator] = {}
        for number, offer in enumerate(offers):
            rows = [one.candidate for one in chosen if one.field == number]
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
