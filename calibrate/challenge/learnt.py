"""The design of a suite: runs of its study without causes and with each, and what they teach."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from scipy.stats import qmc

from calibrate.causes.candidates import Board, Candidate
from calibrate.causes.studies.from_study import (
    board_of,
    candidates_of,
    considered,
    with_effects,
)
from calibrate.causes.studies.learn import learn_effects
from calibrate.causes.studies.twins import twin_cases
from calibrate.challenge.rules import Rules
from calibrate.emulator.with_effects import WithEffects
from calibrate.questions.core.design import case_at, stands_of
from calibrate.questions.core.emulate import Emulators, emulators_of
from calibrate.questions.core.forms import Form, FormKey
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.runs import Runs
from calibrate.questions.core.stored import tabled_runs
from calibrate.study.data import StudyData, load_data
from liggghts_io import CaseSpec

__all__ = ["Learnt", "base_cases", "cause_cases", "learn", "learnt_of"]

POINTS: Final = 320
FEW_POINTS: Final = 192
"""Points of an emulator of more than three inputs, and of three or fewer."""
SEEDS: Final = 1000
"""Seeds apart of two experiments."""
FIRST_SEED: Final = 1_000_000


def base_cases(data: StudyData) -> list[CaseSpec]:
    """Return the runs without causes, space-filling over all ranges, experiments side by side."""
    found: list[tuple[float, int, CaseSpec]] = []
    for number, stand in enumerate(stands_of(data.study, forms_of(data))):
        inputs = len(stand.form.axes)
        count = POINTS if inputs > 3 else FEW_POINTS
        rng = np.random.default_rng([data.study.run.seed, number])
        points = qmc.Sobol(inputs, rng=rng).random(512)[:count]
        for k, u in enumerate(points):
            seed = FIRST_SEED + SEEDS * number + k
            found.append((k / count, number, case_at(data.study, stand, u, np.zeros(0), seed)))
    return [spec for *_, spec in sorted(found, key=lambda one: one[:2])]


def cause_cases(data: StudyData, base: Runs, count: int) -> list[CaseSpec]:
    """Return the twins of runs, so many of each cause in each experiment."""
    names = [effect.name for effect in considered(data.study)]
    effects = data.study.layout.effects
    return twin_cases(forms_of(with_effects(data)), base, effects, names, count)


@dataclass(frozen=True)
class Learnt:
    """What the design teaches; the same for all studies of a suite.

    Attributes
    ----------
    base : Emulators
    wide : dict
        With causes, by form.
    candidates : tuple of Candidate
    forms : dict
        What the emulators are of: everything that the suite's own study measures.
    """

    base: Emulators
    wide: dict[FormKey, WithEffects]
    candidates: tuple[Candidate, ...]
    forms: dict[FormKey, Form]

    def board(self, data: StudyData) -> Board:
        """Return the board of one study."""
        rng = np.random.default_rng(data.study.run.seed)
        return board_of(data, self.wide, rng, self.forms)


def learnt_of(rules: Rules, folder: Path) -> tuple[StudyData, Learnt]:
    """Return the study of a suite, and what its design teaches.

    Parameters
    ----------
    rules : Rules
    folder : Path
        Of the rules; study and table of runs lie there.

    Raises
    ------
    CalibrationError
        If one is missing or broken.
    """
    data = load_data(folder / rules.study)
    runs = tabled_runs(data, forms_of(with_effects(data)), *(folder / one for one in rules.tables))
    return data, learn(data, runs)


def learn(data: StudyData, runs: Runs) -> Learnt:
    """Train on the runs of a design.

    Parameters
    ----------
    data : StudyData
        The study of the suite.
    runs : Runs
        Without causes and with one each.
    """
    wider = forms_of(with_effects(data))
    plain = runs.where([not _on(spec) for spec in runs.specs])
    base = emulators_of(forms_of(data), plain)
    effects = data.study.layout.effects
    wide = learn_effects(base, wider, runs, effects)
    return Learnt(base, wide, candidates_of(data.study, wider), wider)


def _on(spec: CaseSpec) -> bool:
    return any(spec.effects.values())
