"""What a diagnosis has at hand: its study, what runs the cases, what is learnt of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from calibrate.causes.candidates import Board
from calibrate.causes.diagnosis import Diagnosis, Options, conclude
from calibrate.causes.studies.feasible import measured_unknowns
from calibrate.causes.studies.from_study import board_of, groups_of, scales_of
from calibrate.causes.studies.learn import learn_effects
from calibrate.causes.weighing.weigh_all import weigh_all
from calibrate.emulator.with_effects import WithEffects
from calibrate.inference.problem import Problem
from calibrate.questions.core.emulate import Emulators, Trained, emulators_of
from calibrate.questions.core.forms import Form, FormKey
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.problem import problem_of
from calibrate.questions.core.runs import CurveReader, Runs, make_runs
from calibrate.runs.runner import Runner
from calibrate.study.data import StudyData
from liggghts_io import CaseSpec
from liggghts_io.effects import Effect

__all__ = ["Learnt", "Work", "silent", "unseen"]

CAUSES: Final = 4
"""Keeps the draws apart from those of other questions with the study's seed."""


def silent(_line: str) -> None:
    """Say nothing."""


def unseen(_what: str, _share: float) -> None:
    """Show nothing."""


@dataclass(frozen=True)
class Learnt:
    """Emulators of the base model, and with what effects add.

    Attributes
    ----------
    base : Emulators
    wide : dict
        By form.
    """

    base: Emulators
    wide: dict[FormKey, WithEffects]

    def together(self, forms: dict[FormKey, Form]) -> Emulators:
        """Return those of the base model, with forms that place runs with effects on, too."""
        base = self.base.trained
        return Emulators(
            {k: Trained(forms[k], one.emulator, one.inputs) for k, one in base.items()}
        )


@dataclass(frozen=True)
class Work:
    """A diagnosis under way.

    Attributes
    ----------
    data : StudyData
    wider : StudyData
        The study with all effects free.
    forms : dict
        Of the wider study.
    runner : Runner
    read : CurveReader
    tell : callable
    twins : int
        Most points at which each effect is switched on, in each emulator.
    more : int
        Most runs that are added where evidence or strength hangs on the emulators.
    progress : callable
        Told what is weighed, and the fraction done.
    """

    data: StudyData
    wider: StudyData
    forms: dict[FormKey, Form]
    runner: Runner
    read: CurveReader
    tell: Callable[[str], None]
    twins: int
    more: int
    progress: Callable[[str, float], None]

    def make(self, specs: Sequence[CaseSpec], label: str) -> Runs:
        """Run cases."""
        return make_runs(specs, label, self.runner, self.forms, self.read)

    @property
    def effects(self) -> dict[str, Effect]:
        """All effects of the study by name."""
        return self.data.study.layout.effects

    def learn(self, runs: Runs) -> Learnt:
        """Return emulators of the base model and of what effects add, see `learn_effects`."""
        plain = runs.where([not self.on(spec) for spec in runs.specs])
        base = emulators_of(forms_of(self.data), plain)
        return Learnt(base, learn_effects(base, self.forms, runs, self.effects))

    def on(self, spec: CaseSpec) -> bool:
        """Whether a run has a candidate effect on."""
        own = self.data.study.effects
        return any(x and not own.get(name) and name not in self.data.study.parameters
                   for name, x in spec.effects.items())  # fmt: skip

    def problem(self, learnt: Learnt) -> Problem:
        """Return the base model alone."""
        trained = {key: one.emulator for key, one in learnt.base.trained.items()}
        return problem_of(self.data, forms_of(self.data), trained)

    def board(self, learnt: Learnt) -> Board:
        """Return base model, candidates and data, always with the same draws."""
        return board_of(self.data, learnt.wide, self.draws())

    def draws(self) -> np.random.Generator:
        """Return the beginning of the random numbers of a diagnosis."""
        return np.random.default_rng([self.data.study.run.seed, CAUSES])

    def weighed(self, learnt: Learnt, options: Options | None) -> Diagnosis:
        """Return the diagnosis from what was learnt."""
        study = self.data.study
        effort = options.effort if options else None
        found = weigh_all(self.board(learnt), self.draws(), self.progress, effort)
        return conclude(
            found, study.run.seed, options=options, scales=scales_of(study),
            groups=groups_of(study), feasible=measured_unknowns(study),
        )  # fmt: skip
