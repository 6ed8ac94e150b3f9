"""The diagnosis of a study: effect twins, emulators, board, verdict, a check by the engine."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from threadpoolctl import threadpool_limits

from calibrate.causes.candidates import Board
from calibrate.causes.diagnosis import Diagnosis, Options, conclude
from calibrate.causes.studies.from_study import (
    board_of,
    considered,
    groups_of,
    scales_of,
    with_effects,
)
from calibrate.causes.studies.learn import learn_effects
from calibrate.causes.studies.result import StudyDiagnosis
from calibrate.causes.studies.sharpen import BATCH, MORE, outlook_of, sharpening_cases
from calibrate.causes.studies.twins import SCREENED, TWINS, twin_cases
from calibrate.causes.studies.verify import engine_rows
from calibrate.causes.studies.worth import worth_twins
from calibrate.causes.weighing.evidences import weigh_all
from calibrate.emulator.with_effects import WithEffects
from calibrate.errors import CalibrationError
from calibrate.inference.problem import Problem
from calibrate.questions.core.emulate import Emulators, Trained, emulators_of
from calibrate.questions.core.forms import Form, FormKey
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.problem import problem_of
from calibrate.questions.core.runs import CurveReader, Runs, make_runs, read_stored_curve
from calibrate.questions.joint.check import CheckRow
from calibrate.runs.runner import Runner
from calibrate.study.data import StudyData
from liggghts_io import CaseSpec
from liggghts_io.effects import Effect

__all__ = ["diagnose_runs", "first_twins"]

CAUSES: Final = 4
"""Keeps the draws apart from those of other questions with the study's seed."""


def _silent(_line: str) -> None:
    """Say nothing."""


def _unseen(_what: str, _share: float) -> None:
    """Show nothing."""


@dataclass(frozen=True)
class _Work:
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
        Most runs that are added where the evidence hangs on the emulators.
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

    def learn(self, runs: Runs) -> _Learnt:
        """Return emulators of the base model and of what effects add."""
        plain = runs.where([not self.on(spec) for spec in runs.specs])
        base = emulators_of(forms_of(self.data), plain)
        return _Learnt(base, learn_effects(base, self.forms, runs, self.effects))

    def on(self, spec: CaseSpec) -> bool:
        """Whether a run has a candidate effect on."""
        own = self.data.study.effects
        return any(x and not own.get(name) and name not in self.data.study.parameters
                   for name, x in spec.effects.items())  # fmt: skip

    def problem(self, learnt: _Learnt) -> Problem:
        """Return the base model alone."""
        trained = {key: one.emulator for key, one in learnt.base.trained.items()}
        return problem_of(self.data, forms_of(self.data), trained)

    def board(self, learnt: _Learnt) -> Board:
        """Return base model, candidates and data, always with the same draws."""
        return board_of(self.data, learnt.wide, _rng(self.data))


@dataclass(frozen=True)
class _Learnt:
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


def _rng(data: StudyData) -> np.random.Generator:
    return np.random.default_rng([data.study.run.seed, CAUSES])


def first_twins(data: StudyData, base: Runs, twins: int = TWINS) -> list[CaseSpec]:
    """Return the cases that a diagnosis runs first, a few twins of every effect.

    Parameters
    ----------
    data : StudyData
    base : Runs
        Of the joint calibration.
    twins : int
        Most points of each effect in each emulator.

    Raises
    ------
    CalibrationError
        When no effect acts in any experiment of the study.
    """
    names = [effect.name for effect in considered(data.study)]
    if not names:
        msg = (
            f"{data.path}: no effect is left that could be missing; its experiments know none, or "
            "all of them are on already"
        )
        raise CalibrationError(msg)
    effects = data.study.layout.effects
    return twin_cases(forms_of(with_effects(data)), base, effects, names, min(twins, SCREENED))


def diagnose_runs(
    data: StudyData,
    base: Runs,
    runner: Runner,
    *,
    twins: int | None = None,
    more: int | None = None,
    options: Options | None = None,
    read: CurveReader = read_stored_curve,
    tell: Callable[[str], None] = _silent,
    progress: Callable[[str, float], None] = _unseen,
) -> StudyDiagnosis:
    """Say what the calibrated simulation still gets wrong, and which cause fits.

    Parameters
    ----------
    data : StudyData
    base : Runs
        Of the joint calibration; their order decides which of them get twins.
    runner : Runner
        Runs the twins; finished ones are read.
    twins : int, optional
        Most points at which each effect is switched on, in each emulator; the first `SCREENED` of
        them tell whether it can be seen. `TWINS` where it is left out.
    more : int, optional
        Most runs that are added where the evidence of leading causes hangs on the emulators;
        `MORE` where it is left out.
    options : Options, optional
    read : callable
        Reads a curve of a run.
    tell : callable
        Receives a line about each step.
    progress : callable
        See `calibrate.causes.diagnosis.diagnose`.

    Raises
    ------
    CalibrationError
        When no effect can be missing, or too few runs succeeded.
    """
    wider = with_effects(data)
    most = TWINS if twins is None else twins
    added = MORE if more is None else more
    work = _Work(data, wider, forms_of(wider), runner, read, tell, most, added, progress)
    few = work.make(first_twins(data, base, most), "Effects switched on, a few runs of each")
    # Matrices are small and many: threads of the linear algebra only get in each other's way.
    with threadpool_limits(limits=1):
        runs, unseen = _followed(work, base, base.joined(few))
        twinned = len(runs) - len(base)
        runs, learnt, found = _sharpened(work, runs, options)
        before, after = _verified(work, found, learnt)
    sharpened = len(runs) - len(base) - twinned
    return StudyDiagnosis(data, found, before, after, runs, twinned, sharpened, unseen)


def _followed(work: _Work, base: Runs, runs: Runs) -> tuple[Runs, tuple[str, ...]]:
    """Return the runs with more twins of what the data could show, and what they could not."""
    names = [e.name for e in considered(work.data.study) if e.needs_runs]
    kept = worth_twins(work.board(work.learn(runs)), work.data.study.run.seed)
    unseen = tuple(name for name in names if name not in kept)
    if unseen:
        work.tell(
            f"A few runs of each effect show that these data cannot see {', '.join(unseen)}; they "
            "get no more runs"
        )
    specs = twin_cases(work.forms, base, work.effects, kept, work.twins)
    more = work.make(specs, "Effects switched on") if specs else runs
    return runs.joined(more), unseen


def _sharpened(work: _Work, runs: Runs, options: Options | None) -> tuple[Runs, _Learnt, Diagnosis]:
    """Add runs where the evidence of leading causes hangs on the emulators."""
    made = 0
    study = work.data.study
    while True:
        learnt = work.learn(runs)
        rng = _rng(work.data)
        effort = options.effort if options else None
        evidences = weigh_all(work.board(learnt), rng, work.progress, effort)
        found = conclude(
            evidences, study.run.seed, options=options, scales=scales_of(study),
            groups=groups_of(study),
        )  # fmt: skip
        now = outlook_of(found)
        if now.settled or made >= work.more:
            return runs, learnt, found
        count = min(BATCH, work.more - made)
        work.tell(
            f"The log evidence of {now.leaders[0]} is {now.log_ratio:.1f}; with other runs it "
            f"might differ by {now.sway:.1f}: {count} runs are added where that can be narrowed"
        )
        specs = sharpening_cases(
            study,
            work.problem(learnt),
            learnt.base,
            work.forms,
            work.effects,
            runs,
            found,
            now.leaders,
            count,
            made,
        )
        if not specs:
            return runs, learnt, found
        made += len(specs)
        runs = runs.joined(work.make(specs, "Runs where the evidence is uncertain"))


def _verified(
    work: _Work, found: Diagnosis, learnt: _Learnt
) -> tuple[tuple[CheckRow, ...], tuple[CheckRow, ...]]:
    """Return what the engine says at the best values, without and with the leading cause."""
    study, emulators = work.wider.study, learnt.together(work.forms)
    label = "The engine at the best values"
    before = engine_rows(study, found, (), emulators, work.make, label)
    names = found.leading
    if not names:
        return before, ()
    label = f"The engine with {' and '.join(names)}"
    return before, engine_rows(study, found, names, emulators, work.make, label)
