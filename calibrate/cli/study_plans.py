"""What a study would do: its own methods are asked, with a runner that knows stored runs only."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import pandas as pd

from calibrate.causes.studies.from_study import considered, with_effects
from calibrate.causes.studies.study_diagnosis import first_twins
from calibrate.causes.studies.twins import SCREENED, twin_cases
from calibrate.cli.about import engine_in_words
from calibrate.cli.arguments import JOINT, STAGED
from calibrate.cli.diagnose_study import base_runs_stored
from calibrate.cli.show.progress import planned_runs
from calibrate.cli.show.waiting import clock
from calibrate.questions.core.design import first_cases
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.runs import Runs
from calibrate.questions.joint.calibration import joint_rng
from calibrate.runs.campaign import run_table
from calibrate.runs.executors.run_options import RunOptions
from calibrate.runs.stored import (
    DIAGNOSIS,
    EXTENDED,
    FIGURE,
    RECORD,
    REPORT,
    RUNS,
    SAMPLES,
    SECTION,
    START,
    TABLE,
    stored_case,
)
from calibrate.staged.calibration import calibrate
from calibrate.study.data import StudyData
from liggghts_io import CaseResult, CaseSpec

__all__ = ["heading", "plan_of_diagnosis", "plan_of_study"]


JOINT_FILES: Final = (SAMPLES, START)
"""What a joint calibration writes beside the files of every calibration."""


class _MissingRuns(Exception):  # noqa: N818 - not an error: here the plan ends
    """A method asks for runs that are not stored."""


@dataclass
class _StoredOnly:
    """Answers from stored runs, and remembers what it was asked.

    Attributes
    ----------
    root : Path
        Directory of the case directories.
    how : RunOptions
        Its time limit says which time-outs stand.
    asked : list of str
        What was asked for, in words.
    stored : int
        How many of all runs asked for are stored.
    """

    root: Path
    how: RunOptions
    asked: list[str] = field(default_factory=list)
    stored: int = 0

    def results(self, specs: Sequence[CaseSpec], label: str) -> list[CaseResult]:
        """Return the stored results of all cases, or end the plan."""
        unique = list({repr(spec): spec for spec in specs}.values())
        stored = self.how.limited(stored_case)
        known = {repr(spec): stored(spec, self.root) for spec in unique}
        found = {key: result for key, result in known.items() if result is not None}
        self.stored += len(found)
        self.asked.append(f"{label}: {len(unique)} runs, {len(found)} of them stored")
        if len(found) < len(unique):
            raise _MissingRuns
        return [found[repr(spec)] for spec in specs]

    def table(self, specs: Sequence[CaseSpec], label: str) -> pd.DataFrame:
        """Answer as a campaign does."""
        return run_table(specs, self.results(specs, label))


def plan_of_study(data: StudyData, out: Path, how: RunOptions, mode: str) -> dict[str, Any]:
    """Return what `calibrate` would do.

    Parameters
    ----------
    data : StudyData
    out : Path
        Directory of the result, which need not be there.
    how : RunOptions
        What would run the cases.
    mode : {"staged", "joint", "both"}

    Raises
    ------
    CaseError
        If a case of the study cannot be described.
    """
    if mode == JOINT:
        return heading(data, out, how) | _joint(data, out, how) | _written(JOINT_FILES)
    facts = _calibration(data, out, how)
    if mode == STAGED:
        return facts
    return facts | _joint(data, out, how) | _written(JOINT_FILES)


def _written(files: Sequence[str]) -> dict[str, Any]:
    return {"would write": [f"{RUNS}/<case id>/", TABLE, RECORD, REPORT, *files]}


def _joint(data: StudyData, out: Path, how: RunOptions) -> dict[str, Any]:
    """Return what a joint calibration would run; what follows its first design is not known."""
    study = data.study
    stored = how.limited(stored_case)
    unique = {repr(s): s for s in first_cases(study, forms_of(data), joint_rng(data))}
    known = sum(stored(spec, out / RUNS) is not None for spec in unique.values())
    check = len(study.places) * (study.design.check_seeds + study.design.check_draws)
    budget = max(study.design.runs, len(unique))
    return {
        "joint runs at most": budget,
        "joint calibration": [
            f"First design: {len(unique)} runs, {known} of them stored",
            f"then batches where the answer is uncertain, up to {budget} runs in all; fewer when "
            "the answer is settled",
            f"Final check: {check} runs beside these, again after every correction",
            "finished runs that are there, of stages for example, are used as well",
        ],
    }


def plan_of_diagnosis(data: StudyData, out: Path, how: RunOptions, twins: int) -> dict[str, Any]:
    """Return what `diagnose` would do; parameters as `plan_of_study` and `diagnose_runs`.

    Raises
    ------
    CalibrationError, CaseError
        For a record that was changed, and as `plan_of_study`.
    """
    base, record = base_runs_stored(data, out)
    facts = heading(data, out, how)
    before: list[str] = []
    if base is None:
        before = list(_written(JOINT_FILES)["would write"])
        if "stages" in record and record.get("study_sha256") == data.sha256:
            facts["first"] = "the joint calibration is made, beside that by stages"
        else:
            facts["first"] = "the joint calibration is made, there is none that fits"
        facts |= _joint(data, out, how)
    facts["diagnosis"] = _twins(data, out, how, base, twins)
    files = [FIGURE, SECTION, DIAGNOSIS, f"{EXTENDED}/", f"a section in {REPORT}"]
    facts["would write"] = [*(before or [f"{RUNS}/<case id>/"]), *files]
    return facts


def _twins(data: StudyData, out: Path, how: RunOptions, base: Runs | None, twins: int) -> list[str]:
    """Return what a diagnosis would run, and how long that takes."""
    checks = 2 * len(data.study.places) * data.study.design.check_seeds
    wider = with_effects(data)
    switches = sum(len(form.switches) for form in forms_of(wider).values())
    if base is None:
        return [
            f"A few runs of each effect: about {min(twins, SCREENED) * switches}, after that",
            f"more of those that can be seen: up to {twins * switches} in all",
            f"the engine at the best values: up to {checks}",
        ]
    first = first_twins(data, base, twins)
    every = twin_cases(forms_of(wider), base, [e.name for e in considered(data.study)], twins)
    stored = how.limited(stored_case)
    missing = [spec for spec in every if stored(spec, out / RUNS) is None]
    early = sum(stored(spec, out / RUNS) is not None for spec in first)
    pace = float(base.table["wall_s"].median()) / (how.workers or os.cpu_count() or 1)
    return [
        f"{len(base)} runs of the joint calibration are used",
        f"A few runs of each effect: {len(first)} runs, {early} of them stored",
        f"more of those that can be seen: up to {len(every)} runs in all, "
        f"{len(every) - len(missing)} of them stored",
        f"the engine at the best values: up to {checks}",
        f"about {clock(pace * (len(missing) + checks))} of running at most, and some minutes of "
        "computing",
    ]


def heading(data: StudyData, out: Path, how: RunOptions) -> dict[str, Any]:
    """Return what a study is and where it works."""
    study = data.study
    return {
        "study": f"{study.title} ({data.path})",
        "directory": f"{out} ({'exists, is continued' if out.is_dir() else 'new'})",
        "engine": engine_in_words(study.run.engine),
        "scale": study.run.scale,
        **how.facts(),
    }


def _calibration(data: StudyData, out: Path, how: RunOptions) -> dict[str, Any]:
    """Return what a calibration by stages would run."""
    runner = _StoredOnly(out / RUNS, how)
    try:
        calibrate(data, runner.table)
    except _MissingRuns:
        runner.asked.append("the runs of what follows depend on these")
    total = planned_runs(data.study)
    return (
        heading(data, out, how)
        | {
            "runs": total,
            "stored": runner.stored,
            "to run": total - runner.stored,
            "calibration": list(runner.asked),
        }
        | _written(())
    )
