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
from calibrate.causes.studies.verify import EngineSays
from calibrate.causes.studies.work import Work, silent, unseen
from calibrate.errors import BugError
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.runs import CurveReader, Runs, read_stored_curve
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
    found = _weighed(_work(data, read, progress), runs, options)
    return StudyDiagnosis(data, found, (), EngineSays(), runs, twins, added, tuple(few))


def diagnose_stored(
    data: StudyData,
    runs: Runs,
    *,
    options: Options | None = None,
    progress: Callable[[str, float], None] = unseen,
) -> StudyDiagnosis:
    """Say what runs that others made say of a study, without the engine's check.

    Parameters
    ----------
    data : StudyData
    runs : Runs
        Of the study without causes and with single ones, see
        `calibrate.questions.core.stored.tabled_runs`.
    options : Options, optional
    progress : callable
        See `calibrate.causes.diagnosis.diagnose`.

    Raises
    ------
    CalibrationError
        When too few of them are without causes.
    """
    work = _work(data, read_stored_curve, progress)
    on = np.array([work.on(spec) for spec in runs.specs])
    counts = {
        one.name: sum(bool(spec.effects.get(one.name)) for spec in runs.specs)
        for one in considered(data.study)
        if one.needs_runs
    }
    few = tuple(name for name, count in counts.items() if count < FEWEST)
    found = _weighed(work, runs, options)
    return StudyDiagnosis(data, found, (), EngineSays(), runs, int(on.sum()), 0, few)


def _work(data: StudyData, read: CurveReader, progress: Callable[[str, float], None]) -> Work:
    wider = with_effects(data)
    return Work(data, wider, forms_of(wider), _nothing, read, silent, 0, 0, progress)


def _weighed(work: Work, runs: Runs, options: Options | None) -> Diagnosis:
    with threadpool_limits(limits=1):
        return work.weighed(work.learn(runs), options)
