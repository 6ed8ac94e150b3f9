"""Boards with exact answers: emulators that are formulas, known without error."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.candidates import Board, Candidate, Measured, board_of_problem
from calibrate.emulator.types import Inputs, Prediction
from calibrate.inference.priors import Prior
from calibrate.inference.problem import Known, Place, Problem, Reading, Source
from calibrate.inference.space import Space, Unknown


@dataclass(frozen=True)
class Formula:
    """An emulator that computes a formula of (u, strengths), with a constant variance."""

    f: Callable[[Array, Array], Array]
    variance: float | Array = 0.0

    def predict(self, inputs: Inputs) -> Prediction:
        """Return the formula's values."""
        mean = self.f(inputs.u, inputs.strengths)
        return Prediction(mean, np.zeros_like(mean) + self.variance, np.zeros((*mean.shape, 0)))


def linear(slopes: Array, signatures: Array, variance: float = 0.0) -> Formula:
    """Return y = slopes u + signatures strength."""
    return Formula(lambda u, s: u @ slopes.T + s @ signatures.T, variance)


def board(
    formula: Formula,
    y: Array,
    se: Array,
    candidates: Sequence[Candidate],
    *,
    priors: Sequence[Prior],
    effects: int,
    repeats: int = 0,
    known: Sequence[Known] = (),
    measured: Mapping[str, Measured] | None = None,
) -> Board:
    """Return a board of one place with a reading per value."""
    readings = tuple(
        Reading(f"y{k}", slice(k, k + 1), np.array([value]), np.array([error]), repeats)
        for k, (value, error) in enumerate(zip(y, se, strict=True))
    )
    unknowns = tuple(Unknown(f"p{k}", "", prior) for k, prior in enumerate(priors))
    sources = tuple(
        Source(k, 0.0, prior.low if prior.bounded else 0.0, prior.high if prior.bounded else 1.0)
        for k, prior in enumerate(priors)
    )
    place = Place("rig", formula, sources, (Source(),) * effects, readings)
    problem = Problem(Space(unknowns), (place,), tuple(known))
    benches = {name: (one,) for name, one in (measured or {}).items()}
    return board_of_problem(problem, candidates, benches, np.random.default_rng(0))
