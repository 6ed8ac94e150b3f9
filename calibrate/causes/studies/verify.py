"""The engine itself at the best values, without and with the cause: what it misses in truth.

Its seeds are those of no other run, and nothing learns from these runs.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final, TypeAlias

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.diagnosis import Diagnosis
from calibrate.inference.problem import Problem, Source
from calibrate.questions.core.emulate import Emulators
from calibrate.questions.core.runs import Runs
from calibrate.questions.joint.check import CheckRow, check_cases, check_rows, runs_at
from calibrate.significance import significant, worst_of
from calibrate.study.model import Study
from liggghts_io import CaseSpec

__all__ = ["SURE", "EngineSays", "Make", "engine_says", "root_mean_square"]

Make: TypeAlias = Callable[[Sequence[CaseSpec], str], Runs]
"""Cases and a label to finished runs."""

SURE: Final = 2.0
"""Error of what was expected, in those of measurement and engine, up to which it is told well."""
VERIFY_SEED: Final = 4_000_000
"""Added to the study's seed; far from those of designs, stages and final checks."""


@dataclass(frozen=True)
class EngineSays:
    """The engine at the best values of a hypothesis.

    Attributes
    ----------
    rows : tuple of CheckRow
        Every target, measured and simulated.
    off : float
        Its largest distance from what was expected of it, in errors of measurement and engine, as
        unlikely as it is among so many numbers.
    unsure : float
        Largest error of what was expected, in the same errors.
    """

    rows: tuple[CheckRow, ...] = ()
    off: float = 0.0
    unsure: float = 0.0

    @property
    def expected(self) -> bool:
        """Whether the engine does what was expected of it, as far as the data can tell."""
        return not significant(self.off)

    @property
    def settled(self) -> bool:
        """Whether it does, and more runs there would tell little."""
        return self.expected and self.unsure <= SURE


def engine_says(
    study: Study,
    found: Diagnosis,
    names: tuple[str, ...],
    emulators: Emulators,
    make: Make,
    label: str,
) -> EngineSays:
    """Run the engine at the best values of a hypothesis and compare every target with it.

    Parameters
    ----------
    study : Study
        With all effects free; it says how many seeds.
    found : Diagnosis
    names : tuple of str
        Members of the hypothesis.
    emulators : Emulators
        They tell how much single runs scatter.
    make : callable
    label : str
        Shown with the progress.
    """
    first = study.run.seed + VERIFY_SEED
    values, strengths = found.best(names)
    problem = switched_on(found, names, strengths)
    fresh = make(check_cases(study, problem, emulators, values[None], first), label)
    rows = check_rows(study, problem, emulators, fresh, values, found.samples(names)[0])
    return EngineSays(rows, *_expected(study, problem, emulators, fresh, values))


def _expected(
    study: Study, problem: Problem, emulators: Emulators, fresh: Runs, values: Array
) -> tuple[float, float]:
    """Return how far the engine is from what was expected at values (K,), and how sure that was.

    The emulators' own error is no excuse here: where it is large, the strength rests on it.
    """
    distances: list[float] = []
    unsure = 0.0
    for stand, place, y in runs_at(study, problem, emulators, fresh, values):
        prediction = place.predict(values[None])
        expected, spread = prediction.mean[0], np.sqrt(prediction.total[0])
        noise = emulators.trained[stand.form.key].emulator.noise
        for reading in place.readings:
            own = y[:, reading.columns]
            own = own[np.isfinite(own).all(axis=1)]
            if len(own):
                error = np.sqrt(reading.se**2 + noise[reading.columns] / len(own))
                distances += list((own.mean(axis=0) - expected[reading.columns]) / error)
                unsure = max(unsure, float((spread[reading.columns] / error).max()))
    return (abs(worst_of(distances)) if distances else 0.0), unsure


def switched_on(found: Diagnosis, names: tuple[str, ...], strengths: Array) -> Problem:
    """Return the base model's problem with causes on, strengths in their units."""
    places = list(found.board.problem.places)
    for one, strength in zip(found.board.members(names), strengths, strict=True):
        for k, column in one.acts:
            sources = list(places[k].strengths)
            sources[column] = Source(None, float(strength), 0.0, one.scale)
            places[k] = replace(places[k], strengths=tuple(sources))
    return replace(found.board.problem, places=tuple(places))


def root_mean_square(rows: Sequence[CheckRow]) -> float:
    """Return the root mean square z of targets of which the engine gave a number; nan of none."""
    squares = [row.z**2 for row in rows if math.isfinite(row.z)]
    return math.sqrt(math.fsum(squares) / len(squares)) if squares else math.nan
