"""The diagnosis once more from runs that are there: of another study, of further measurements."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import pandas as pd
from threadpoolctl import threadpool_limits

from calibrate.causes.diagnosis import Options
from calibrate.causes.studies.from_study import with_effects
from calibrate.causes.studies.near import Near
from calibrate.causes.studies.result import StudyDiagnosis
from calibrate.causes.studies.verify import EngineSays
from calibrate.causes.studies.work import Work, silent, unseen
from calibrate.errors import BugError
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.runs import CurveReader, Runs, read_stored_curve
from calibrate.study.data import StudyData
from liggghts_io import CaseSpec

__all__ = ["diagnose_again"]


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
    near: Mapping[str, Near] | None = None,
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
    near : mapping, optional
        About which strength effects were learnt, by effect.
    options : Options, optional
    read : callable
        Reads a curve of a run.
    progress : callable
        See `calibrate.causes.diagnosis.diagnose`.
    """
    wider = with_effects(data)
    work = Work(data, wider, forms_of(wider), _nothing, read, silent, 0, 0, progress)
    with threadpool_limits(limits=1):
        found = work.weighed(work.learn(runs, near), options)
    return StudyDiagnosis(data, found, (), EngineSays(), runs, twins, added, tuple(few), near or {})
