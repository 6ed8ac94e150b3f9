"""What a reader of a joint calibration should know, in sentences."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.inference.problem import Problem
from calibrate.questions.core.problem import readings_left_out
from calibrate.questions.identify import unreachable
from calibrate.questions.joint.check import CheckRow
from calibrate.significance import significant
from calibrate.study.data import StudyData

__all__ = ["sentences_of"]

PRIOR_DRAWS: Final = 4000


def sentences_of(
    data: StudyData,
    problem: Problem,
    samples: Array,
    undetermined: Sequence[str],
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
    undetermined : sequence of str
        What is said of unknowns that the data do not determine.
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
        if significant(row.z)
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
        *undetermined,
        *loose,
        *twice,
        ending,
    )
