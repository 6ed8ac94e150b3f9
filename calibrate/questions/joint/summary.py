"""What a reader of a joint calibration should know, in sentences."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.inference.posterior import Posterior
from calibrate.inference.problem import Problem
from calibrate.questions.core.problem import readings_left_out
from calibrate.questions.identify import unreachable
from calibrate.questions.joint.check import CheckRow
from calibrate.significance import shown, significant
from calibrate.study.data import StudyData
from liggghts_io.files import shell_word

__all__ = ["sentences_of"]

PRIOR_DRAWS: Final = 4000
LOOSE: Final = 1.5
"""Emulator's variance over the measurement's from which it is worth a word; printed as 2."""


def names_outside(best: Array, posterior: Posterior, level: float) -> tuple[str, ...]:
    """Return the unknowns whose value lies outside their interval.

    Parameters
    ----------
    best : (K,) float64
    posterior : Posterior
    level : float
        Probability of the interval.
    """
    spans = {name: posterior.interval(name, level) for name in posterior.names}
    return tuple(
        name
        for (name, span), value in zip(spans.items(), best, strict=True)
        if not span.low <= value <= span.high
    )


def sentences_of(
    data: StudyData,
    problem: Problem,
    samples: Array,
    undetermined: Sequence[str],
    moved: Sequence[str],
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
    moved : sequence of str
        Unknowns whose 68 % interval the runs of the final check moved away from the value.
    rows : sequence of CheckRow
    ending : str
        Why no more runs were made.
    """
    prior = problem.space.draw(PRIOR_DRAWS, np.random.default_rng(data.study.run.seed))
    every = np.vstack([prior, samples])
    twice = [
        f"{name} is part of the measured curve {curve} and not counted a second time."
        for name, curve in readings_left_out(data.study).items()
    ]
    return (
        *(one.words for one in unreachable(data, problem, every)),
        *_not_met(rows, data.path.name),
        *_missed(rows),
        *undetermined,
        *_moved(moved),
        *_loose(rows),
        *twice,
        ending,
    )


def _not_met(rows: Sequence[CheckRow], study: str) -> list[str]:
    """Say which targets the simulation cannot meet together with the others."""
    found = [f"{row.label} (probability {row.discrepancy:.2f})" for row in rows if not row.met]
    if not found:
        return []
    return [
        f"No values meet everything: the simulation most likely misses {', '.join(found)} for a "
        "reason that is not in it, and the answer rests on the other targets; "
        f"'bulkcal diagnose {shell_word(study)}' looks for the reason."
    ]


def _missed(rows: Sequence[CheckRow]) -> list[str]:
    """Say which targets the engine misses at the values that are given."""
    missed = [
        f"{row.label} ({row.simulated:.4g} for {row.measured:.4g} {row.unit}, z = {shown(row.z)})"
        for row in rows
        if significant(row.z)
    ]
    if not missed:
        return []
    return [f"At these values the engine misses more than the errors explain: {', '.join(missed)}."]


def _moved(names: Sequence[str]) -> list[str]:
    """Say which values the runs of the final check have left outside their 68 % intervals."""
    if not names:
        return []
    return [
        f"{', '.join(names)}: the runs of the final check, made at the values given, moved the "
        "68 % interval away from the value; read the intervals, or give it more runs "
        "([design] runs)."
    ]


def _loose(rows: Sequence[CheckRow]) -> list[str]:
    """Say where the emulators are the weaker part."""
    loose = [
        f"{row.label} ({row.error_ratio:.0f})"
        for row in rows
        if row.error_ratio > LOOSE and row.met
    ]
    if not loose:
        return []
    return [
        "More runs ([design] runs) would narrow the answer: at these values the emulator's "
        f"variance is still above the measurement's, by the factor given: {', '.join(loose)}."
    ]
