"""The diagnosis of a study: effect twins, emulators, board, verdict, a check by the engine."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from threadpoolctl import threadpool_limits

from calibrate.causes.diagnosis import Diagnosis, Options
from calibrate.causes.studies.from_study import considered, with_effects
from calibrate.causes.studies.further.ranking import try_further
from calibrate.causes.studies.further.registry import entries_of
from calibrate.causes.studies.near import Near, near_cases, nearer
from calibrate.causes.studies.result import StudyDiagnosis
from calibrate.causes.studies.sharpen import BATCH, MORE, outlook_of, sharpening_cases
from calibrate.causes.studies.twins import SCREENED, TWINS, twin_cases
from calibrate.causes.studies.verify import EngineSays, engine_says
from calibrate.causes.studies.work import Learnt, Work, silent, unseen
from calibrate.causes.studies.worth import worth_twins
from calibrate.errors import CalibrationError
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.runs import CurveReader, Runs, read_stored_curve
from calibrate.questions.joint.check import CheckRow
from calibrate.runs.runner import Runner
from calibrate.study.data import StudyData
from liggghts_io import CaseSpec

__all__ = ["diagnose_runs", "first_twins"]


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
    further: int = 0,
    options: Options | None = None,
    read: CurveReader = read_stored_curve,
    tell: Callable[[str], None] = silent,
    progress: Callable[[str, float], None] = unseen,
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
        Most runs added where the evidence of leading causes hangs on the emulators, and as many
        near the strength of one with which the engine does something else than was expected;
        `MORE` where it is left out.
    further : int
        Most runs of further experiments, which tell what to try next where that is open.
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
        When no effect can be missing, too few runs succeeded, or an entry is wrong.
    """
    entries = entries_of(data) if further else {}
    most, added = TWINS if twins is None else twins, MORE if more is None else more
    wider = with_effects(data)
    work = Work(data, wider, forms_of(wider), runner, read, tell, most, added, progress)
    few = work.make(first_twins(data, base, most), "Effects switched on, a few runs of each")
    # Matrices are small and many: threads of the linear algebra only get in each other's way.
    with threadpool_limits(limits=1):
        runs, blind = _followed(work, base, base.joined(few))
        twinned = len(runs) - len(base)
        runs, learnt, found = _sharpened(work, runs, options)
        runs, found, after = _confirmed(work, base, runs, learnt, found, options)
        before = _without(work, found, learnt)
        tried = try_further(data.study, found, base, runner, entries, further, tell)
    found, added = replace(found, prospect=tried.prospect), len(runs) - len(base) - twinned
    return StudyDiagnosis(data, found, before, after, runs, twinned, added, blind, tried.runs)


def _without(work: Work, found: Diagnosis, learnt: Learnt) -> tuple[CheckRow, ...]:
    """Return what the engine says at the best values without any cause."""
    together, label = learnt.together(work.forms), "The engine at the best values"
    return engine_says(work.wider.study, found, (), together, work.make, label).rows


def _followed(work: Work, base: Runs, runs: Runs) -> tuple[Runs, tuple[str, ...]]:
    """Return the runs with more twins of what the data could show, and what they could not."""
    names = [e.name for e in considered(work.data.study) if e.needs_runs]
    kept = worth_twins(work.board(work.learn(runs)), work.data.study.run.seed)
    blind = tuple(name for name in names if name not in kept)
    if blind:
        work.tell(
            f"A few runs of each effect show that these data cannot see {', '.join(blind)}; they "
            "get no more runs"
        )
    specs = twin_cases(work.forms, base, work.effects, kept, work.twins)
    more = work.make(specs, "Effects switched on") if specs else runs
    return runs.joined(more), blind


def _sharpened(work: Work, runs: Runs, options: Options | None) -> tuple[Runs, Learnt, Diagnosis]:
    """Add runs where the evidence of leading causes hangs on the emulators."""
    made = 0
    study = work.data.study
    while True:
        learnt = work.learn(runs)
        found = work.weighed(learnt, options)
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
            found,
            now.leaders,
            count,
            made,
        )
        if not specs:
            return runs, learnt, found
        made += len(specs)
        runs = runs.joined(work.make(specs, "Runs where the evidence is uncertain"))


def _confirmed(
    work: Work,
    base: Runs,
    runs: Runs,
    learnt: Learnt,
    found: Diagnosis,
    options: Options | None,
) -> tuple[Runs, Diagnosis, EngineSays]:
    """Ask the engine with the leading cause, and look near its strength until it is told."""
    study, emulators = work.wider.study, learnt.together(work.forms)
    near: dict[str, Near] = {}
    left = work.more
    while True:
        names = found.leading
        if not names:
            return runs, found, EngineSays()
        label = f"The engine with {' and '.join(names)}"
        says = engine_says(study, found, names, emulators, work.make, label)
        closer = nearer(found, near, work.effects)
        specs = near_cases(work.data.study, work.forms, base, found, closer, left)
        if says.settled or not specs:
            return runs, found, says
        why = (
            f"what is expected of the engine is known to {says.unsure:.1f} standard errors only"
            if says.expected
            else f"the engine is {says.off:.1f} standard errors from what was expected of it"
        )
        work.tell(
            f"With {' and '.join(names)} {why}: {len(specs)} runs are added near the strength found"
        )
        left, near = left - len(specs), closer
        runs = runs.joined(work.make(specs, "Runs near the strength found"))
        found = work.weighed(work.learn(runs), options)
