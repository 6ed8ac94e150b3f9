"""The diagnosis from runs that are there: of a table, or once more of further measurements."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pandas as pd
from threadpoolctl import threadpool_limits

from calibrate.causes.diagnosis import Diagnosis, Options
from calibrate.causes.studies.from_study import considered, with_effects
from calibrate.causes.studies.result import StudyDiagnosis
from calibrate.causes.studies.twins import FEWEST
from calibrate.causes.studies.verify import EngineSays, engine_says
from calibrate.causes.studies.work import Learnt, Work, silent, unseen
from calibrate.errors import BugError
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.runs import CurveReader, Runs, read_stored_curve
from calibrate.questions.joint.check import CheckRow
from calibrate.runs.runner import Runner
from calibrate.study.data import StudyData
from liggghts_io import CaseSpec

__all__ = ["diagnose_again", "diagnose_stored"]


def _nothing(specs: Sequence[CaseSpec], _label: str) -> pd.DataFrame:
    msg = f"a diagnosis from {len(specs)} runs that are there asked for more"
    raise BugError(msg)


def diagnose_again(
    data: StudyData,
    runs: Runs,
    *,
    twins: int,
    added: int,
    few: Sequence[str] = (),
    options: Options | None = None,
    read: CurveReader = read_stored_curve,
    progress: Callable[[str, float], None] = unseen,
) -> StudyDiagnosis:
    """Say what the same runs say of a study, without any new run and without the engine's check.

    Parameters
    ----------
    data : StudyData
        The study with other knowledge; what is simulated and free must be the same.
    runs : Runs
        All runs behind the emulators of an earlier diagnosis, in its order.
    twins, added : int
        How many of them have an effect on, and were added where evidence was uncertain.
    few : sequence of str
        Effects that got few runs.
    options : Options, optional
    read : callable
        Reads a curve of a run.
    progress : callable
        See `calibrate.causes.diagnosis.diagnose`.
    """
    found, _ = _weighed(_work(data, read, progress), runs, options)
    return StudyDiagnosis(data, found, (), EngineSays(), runs, twins, added, tuple(few))


def diagnose_stored(
    data: StudyData,
    runs: Runs,
    *,
    checker: Runner | None = None,
    options: Options | None = None,
    progress: Callable[[str, float], None] = unseen,
) -> StudyDiagnosis:
    """Say what runs that others made say of a study, and what the engine says if it is asked.

    Parameters
    ----------
    data : StudyData
    runs : Runs
        Of the study without causes and with single ones, see
        `calibrate.questions.core.stored.tabled_runs`.
    checker : Runner, optional
        Runs the engine at the best values, without and with the leading cause; nothing learns from
        that. Left out, nothing is run.
    options : Options, optional
    progress : callable
        See `calibrate.causes.diagnosis.diagnose`.

    Raises
    ------
    CalibrationError
        When too few of them are without causes.
    """
    work = _work(data, read_stored_curve, progress, checker or _nothing)
    on = np.array([work.on(spec) for spec in runs.specs])
    counts = {
        one.name: sum(bool(spec.effects.get(one.name)) for spec in runs.specs)
        for one in considered(data.study)
        if one.needs_runs
    }
    few = tuple(name for name, count in counts.items() if count < FEWEST)
    found, learnt = _weighed(work, runs, options)
    before, after = _asked(work, found, learnt) if checker else ((), EngineSays())
    return StudyDiagnosis(data, found, before, after, runs, int(on.sum()), 0, few)


def _asked(work: Work, found: Diagnosis, learnt: Learnt) -> tuple[tuple[CheckRow, ...], EngineSays]:
    """Return what the engine says at the best values, without and with the leading cause."""
    study, emulators, names = work.wider.study, learnt.together(work.forms), found.leading
    label = "The engine at the best values"
    before = engine_says(study, found, (), emulators, work.make, label).rows
    if not names:
        return before, EngineSays()
    label = f"The engine with {' and '.join(names)}"
    return before, engine_says(study, found, names, emulators, work.make, label)


def _work(
    data: StudyData,
    read: CurveReader,
    progress: Callable[[str, float], None],
    runner: Runner = _nothing,
) -> Work:
    wider = with_effects(data)
    return Work(data, wider, forms_of(wider), runner, read, silent, 0, 0, progress)


def _weighed(work: Work, runs: Runs, options: Options | None) -> tuple[Diagnosis, Learnt]:
    with threadpool_limits(limits=1):
        learnt = work.learn(runs)
        return work.weighed(learnt, options), learnt
