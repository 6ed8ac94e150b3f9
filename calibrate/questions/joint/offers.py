"""Where runs could be made, and what each would tell the questions that are asked."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.emulator.types import Inputs
from calibrate.inference.discrepancy import discrepancy_probabilities
from calibrate.inference.problem import Place as Seen
from calibrate.inference.problem import Problem
from calibrate.planning.infill import Chosen, Field, best_batch, flattened
from calibrate.questions.core.design import Stand, case_at, stands_of
from calibrate.questions.core.emulate import Emulators, Trained
from calibrate.questions.core.problem import inputs_at, place_name
from calibrate.runs.cost import work_of
from calibrate.study.model import Study
from liggghts_io import CaseSpec

__all__ = ["Choice", "Question", "choose_runs"]

DRAWS: Final = 120
"""Posterior draws per place at which the emulators' error counts."""
CANDIDATES: Final = 60
"""New points per material and emulator that are compared."""
REPEATS: Final = 15
"""Known points per material and emulator, the nearest to the posterior, that may be repeated."""
SAME: Final = 1e-6
"""Part of a range below which two inputs are the same."""


@dataclass(frozen=True, eq=False)
class Question:
    """A posterior that more runs should sharpen.

    Attributes
    ----------
    problem : Problem
    samples : (n, K) float64
        Posterior draws.
    share : float
        How much it counts beside others.
    """

    problem: Problem
    samples: Array
    share: float = 1.0


@dataclass(frozen=True)
class Offer:
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

    def case(self, study: Study, candidate: int, seed: int) -> CaseSpec:
        """Return the case of a candidate."""
        one = self.field.candidates.rows(slice(candidate, candidate + 1))
        return case_at(study, self.stands[candidate], one.u[0], one.strengths[0], seed)


@dataclass(frozen=True)
class Choice:
    """Runs that are worth making.

    Attributes
    ----------
    specs : tuple of CaseSpec
    chosen : tuple of Chosen
        Each with the number of its offer.
    offers : tuple of Offer
        One per emulator.
    """

    specs: tuple[CaseSpec, ...]
    chosen: tuple[Chosen, ...]
    offers: tuple[Offer, ...]


def choose_runs(
    study: Study,
    emulators: Emulators,
    questions: Sequence[Question],
    count: int,
    rng: np.random.Generator,
    first_seed: int,
) -> Choice:
    """Return the runs that sharpen the questions most for what they cost.

    Parameters
    ----------
    study : Study
        With all effects among its parameters that the emulators know.
    emulators : Emulators
    questions : sequence of Question
        Their problems have these emulators.
    count : int
        Most runs.
    rng : numpy Generator
    first_seed : int
        Seed of the first run; the others follow.
    """
    views = [_view(question, rng) for question in questions]
    stands = stands_of(study, {key: one.form for key, one in emulators.trained.items()})
    costs = [work_of(_middle_case(study, stand, first_seed)) for stand in stands]
    offers = []
    for key, trained in emulators.trained.items():
        here = [(s, c) for s, c in zip(stands, costs, strict=True) if s.form.key == key]
        offers.append(_offer(trained, here, views))
    chosen = best_batch([offer.field for offer in offers], count)
    specs = tuple(
        offers[one.field].case(study, one.candidate, first_seed + i) for i, one in enumerate(chosen)
    )
    return Choice(specs, tuple(chosen), tuple(offers))


@dataclass(frozen=True, eq=False)
class _View:
    """A question's places by name, its draws, and points around its posterior."""

    places: dict[str, Seen]
    draws: Array
    wide: Array
    share: float


def _view(question: Question, rng: np.random.Generator) -> _View:
    problem, samples = question.problem, question.samples
    draws = samples[rng.choice(len(samples), size=min(DRAWS, len(samples)), replace=False)]
    wide = problem.space.values_of(flattened(problem.space.units(samples), CANDIDATES, rng))
    return _View({place.name: place for place in problem.places}, draws, wide, question.share)


def _middle_case(study: Study, stand: Stand, seed: int) -> CaseSpec:
    """Return the case in the middle of all ranges, without effects."""
    form = stand.form
    return case_at(study, stand, np.full(len(form.axes), 0.5), np.zeros(len(form.switches)), seed)


def _offer(
    trained: Trained, stands: Sequence[tuple[Stand, float]], views: Sequence[_View]
) -> Offer:
    """Return where the error of one emulator matters and where it can be run, at what cost."""
    at: list[Inputs] = []
    weights: list[Array] = []
    candidates: list[Inputs] = []
    known: list[bool] = []
    costs: list[float] = []
    whose: list[Stand] = []
    for stand, cost in stands:
        for view in views:
            for place in (view.places[place_name(one)] for one in stand.places):
                draws = inputs_at(place, view.draws)
                at.append(draws)
                weights.append(view.share * _weights(place, trained.form.width, view.draws))
                new, old = inputs_at(place, view.wide), _nearest(trained.inputs, draws)
                candidates += [new, old]
                known += [False] * len(new) + [True] * len(old)
        here = len(known) - len(costs)
        costs += [cost] * here
        whose += [stand] * here
    field = Field(
        trained.emulator,
        _stacked(at),
        np.concatenate(weights),
        _stacked(candidates),
        np.array(known),
        np.array(costs),
    )
    return Offer(trained, field, tuple(whose))


def _stacked(parts: Sequence[Inputs]) -> Inputs:
    found = parts[0]
    for part in parts[1:]:
        found = found.joined(part)
    return found


def _weights(place: Seen, width: int, draws: Array) -> Array:
    """Return what a unit of variance counts at posterior draws (n, K), (n, M).

    It is what the logarithm of the variance of measurement and emulator together changes by:
    halving an emulator's variance that is a hundred times the measurement's is worth hardly more
    than halving one that equals it. A curve counts as one number, and a reading that the simulation
    cannot meet hardly counts.
    """
    weights = np.zeros((len(draws), width))
    variance = place.predict(draws).total
    held = 1.0 - discrepancy_probabilities(place, draws)
    for k, reading in enumerate(place.readings):
        total = reading.se**2 + variance[:, reading.columns]
        weights[:, reading.columns] += held[:, k, None] / (total * len(reading.se))
    return weights / len(draws)


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
