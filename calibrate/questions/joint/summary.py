"""What a reader of a joint calibration should know, in sentences."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.inference.problem import Problem
from calibrate.inference.space import Space
from calibrate.questions.core.problem import readings_left_out
from calibrate.questions.identify import VAGUE, unreachable
from calibrate.questions.joint.check import CheckRow
from calibrate.questions.words import undetermined_words
from calibrate.study.data import StudyData

__all__ = ["sentences_of", "undetermined"]

MISSED: Final = 2.0
"""Standard errors of both from which a target is said to be missed."""
PRIOR_DRAWS: Final = 4000


def undetermined(space: Space, samples: Array) -> tuple[str, ...]:
    """Return the unknowns of which the data leave the prior nearly as it was.

    Parameters
    ----------
    space : Space
    samples : (n, K) float64
    """
    before = space.units(space.draw(PRIOR_DRAWS, np.random.default_rng(0))).std(axis=0)
    after = space.units(samples).std(axis=0)
    count = len(space.unknowns)
    return tuple(space.names[k] for k in space.asked if k < count and after[k] > VAGUE * before[k])


def sentences_of(
    data: StudyData,
    problem: Problem,
    samples: Array,
    vague: Sequence[str],
    rows: Sequence[CheckRow],
    ending: str,
) -> tuple[str, ...]:
    """Return what a reader should know, most important first.

    Parameters
    ----------
    data : StudyData
    problem : Problem
    samples : (n, K) float64
        Posterior draws.
    vague : sequence of str
        Unknowns that are not determined.
    rows : sequence of CheckRow
    ending : str
        Why no more runs were made.
    """
    prior = problem.space.draw(PRIOR_DRAWS, np.random.default_rng(data.study.run.seed))
    every = np.vstack([prior, samples])
    missed = [
        f"The engine at the optimum misses {row.label} by {abs(row.z):.1f} standard errors of "
        f"measurement and simulation: {row.simulated:.4g} for {row.measured:.4g} {row.unit}."
        for row in rows
        if abs(row.z) > MISSED
    ]
    loose = [
        f"{row.label}: the emulator's variance at the optimum is still {row.error_ratio:.2g} of "
        "the measurement's; more runs ([design] runs) would narrow the answer."
        for row in rows
        if row.error_ratio > 1.0
    ]
    twice = [
        f"{name} is part of the measured curve {curve} and not counted a second time."
        for name, curve in readings_left_out(data.study).items()
    ]
    return (
        *(one.words for one in unreachable(data, problem, every)),
        *missed,
        *(undetermined_words(name) for name in vague),
        *loose,
        *twice,
        ending,
    )
