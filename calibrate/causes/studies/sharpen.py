"""More runs where evidence hangs on the emulators: at the base model and at the leading causes."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from calibrate.causes.diagnosis import Diagnosis
from calibrate.causes.studies.twins import GOLDEN, twin_strengths
from calibrate.causes.sway import sways
from calibrate.inference.problem import Problem
from calibrate.questions.core.emulate import Emulators
from calibrate.questions.core.forms import Form, FormKey
from calibrate.questions.joint.offers import Question, choose_runs
from calibrate.study.model import Study
from liggghts_io import CaseSpec
from liggghts_io.effects import Effect
from liggghts_io.materials import kind_of

__all__ = ["BATCH", "MORE", "Outlook", "outlook_of", "sharpening_cases"]

BATCH: Final = 16
"""Runs that are made before everything is weighed again."""
MORE: Final = 64
"""Most runs of this kind, where nobody asks for another number."""
SHARP: Final = 0.5
"""Sway of a log evidence ratio that is small enough in any case, in nats."""
FIRM: Final = 3.0
CLEAR: Final = 3.0
"""An answer stands that leads by so many nats and so many sways: nothing else is near."""
LEADING: Final = 0.05
"""Probability from which a cause is worth runs."""
MOST_LEADING: Final = 4
"""Causes that share a batch, at most: each run of the base model serves them all."""
LEAST: Final = 0.1
"""Of a usual strength of a twin, below which one tells nothing."""
POINTS_SEED: Final = 2_500_000
"""Seeds of these runs follow the study's after so many; far from those of other questions."""


@dataclass(frozen=True)
class Outlook:
    """What leads, and how firmly.

    Attributes
    ----------
    leaders : tuple of str
        Candidates whose probability matters, the most probable first.
    log_ratio : float
        Log evidence of the first of them against the base model, in nats.
    sway : float
        How much the log evidences of the leaders may differ with other runs, the largest.
    margin : float
        Log of the ratio of the two most probable answers, in nats.
    """

    leaders: tuple[str, ...]
    log_ratio: float
    sway: float
    margin: float

    @property
    def settled(self) -> bool:
        """Whether other runs would hardly give another answer."""
        sharp = self.sway <= SHARP or self.margin >= FIRM + CLEAR * self.sway
        return not self.leaders or sharp


def outlook_of(found: Diagnosis) -> Outlook:
    """Return what leads after the runs that are there, and how firmly."""
    answers = found.verdict.answers
    names = list(answers.inclusion)[:MOST_LEADING]
    leaders = tuple(
        name for k, name in enumerate(names) if k == 0 or answers.inclusion[name] >= LEADING
    )
    spread = sways(found.found, [(name,) for name in leaders], found.seed)
    first, second = sorted([*answers.single.values(), *answers.pairs.values()], reverse=True)[:2]
    return Outlook(
        leaders,
        found.log_ratio(leaders[0]) if leaders else 0.0,
        max(spread.values(), default=0.0),
        math.log(first / max(second, math.ulp(0.0))),
    )


def sharpening_cases(
    study: Study,
    problem: Problem,
    emulators: Emulators,
    wider: Mapping[FormKey, Form],
    effects: Mapping[str, Effect],
    found: Diagnosis,
    names: Sequence[str],
    count: int,
    made: int,
) -> tuple[CaseSpec, ...]:
    """Return the runs that make base model and leading causes more certain for what they cost.

    Each is made without a cause and, where one of the leading causes acts and costs a run, with it.

    Parameters
    ----------
    study : Study
    problem : Problem
        Of the base model alone.
    emulators : Emulators
        Of the base model.
    wider : mapping
        Forms of the study with all effects free.
    effects : mapping
        By name.
    found : Diagnosis
    names : sequence of str
        The causes.
    count : int
        Most runs.
    made : int
        Runs of this kind that were made before; their seeds come first.
    """
    first = study.run.seed + POINTS_SEED + made
    hypotheses: list[tuple[str, ...]] = [(), *((name,) for name in names)]
    questions = [
        Question(problem, found.samples(one)[0], 1.0 / len(hypotheses)) for one in hypotheses
    ]
    rng = np.random.default_rng([found.seed, made])
    plain = choose_runs(study, emulators, questions, count, rng, first).specs
    cases: list[CaseSpec] = []
    leading = {found.board.candidate(name).effect: name for name in reversed(names)}
    for number, spec in enumerate(plain):
        cases.append(spec)
        form = wider[spec.experiment, kind_of(spec.surface)]
        acting = [s for s in form.switches if s.name in leading and effects[s.name].needs_runs]
        if acting:
            switch = acting[number % len(acting)]
            usual = twin_strengths(effects[switch.name], switch, number + 1)[-1]
            strength = _likely(found, leading[switch.name], number, usual)
            cases.append(replace(spec, effects={**spec.effects, switch.name: strength}))
    return tuple(cases[:count])


def _likely(found: Diagnosis, name: str, number: int, usual: float) -> float:
    """Return one of the strengths that a cause probably has, or the usual one where it has none."""
    if found.board.candidate(name).switch:
        return usual
    likely = found.samples((name,))[1][:, 0]
    strength = float(np.quantile(likely, GOLDEN * (number + 1) % 1.0))
    return strength if abs(strength) >= LEAST * abs(usual) else usual
