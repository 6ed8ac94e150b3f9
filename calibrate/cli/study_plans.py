"""What a study would do: its own methods are asked, with a runner that knows stored runs only."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np
import pandas as pd

from calibrate.cli.about import engine_in_words
from calibrate.cli.arguments import JOINT, STAGED
from calibrate.cli.diagnose_study import ENGINE_DESIGN
from calibrate.cli.show.progress import planned_runs
from calibrate.diagnose import pipeline
from calibrate.diagnose.from_study import levels_of, problem_of
from calibrate.questions.core.design import first_cases
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.joint.calibration import joint_rng
from calibrate.report.record import start_of
from calibrate.runs.campaign import run_table
from calibrate.runs.executors.run_options import RunOptions
from calibrate.runs.reuse import Levels, with_curves
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
    levels : mapping
        Where the diagnosis reads curves, by experiment and curve.
    asked : list of str
        What was asked for, in words.
    stored : int
        How many of all runs asked for are stored.
    """

    root: Path
    how: RunOptions
    levels: Levels = field(default_factory=dict)
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

    def diagnosis(self, specs: Sequence[CaseSpec]) -> list[CaseResult]:
        """Answer as the runner of a diagnosis does."""
        found = self.results(specs, "diagnosis")
        return [with_curves(r, s, self.levels) for r, s in zip(found, specs, strict=True)]


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
    facts, _, _ = _calibration(data, out, how)
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


def plan_of_diagnosis(
    data: StudyData, out: Path, how: RunOptions, start: Path | None
) -> dict[str, Any]:
    """Return what `diagnose` would do; parameters as `plan_of_study`.

    Raises
    ------
    CalibrationError, CaseError
        For a record to start from that is none, and as `plan_of_study`.
    """
    parameters: Mapping[str, float] | None
    if start is None:
        facts, runner, parameters = _calibration(data, out, how)
    else:
        runner = _StoredOnly(out / RUNS, how, levels_of(data.study))
        facts, parameters = heading(data, out, how), None
        parameters = start_of(start)
    facts["would write"] = [
        *facts.get("would write", [f"{RUNS}/<case id>/"]),
        FIGURE, SECTION, DIAGNOSIS, f"{EXTENDED}/",
    ]  # fmt: skip
    if parameters is None:
        facts["diagnosis"] = "its design follows from the calibration, some two hundred runs"
        return facts
    runner.asked.clear()
    try:
        pipeline.diagnose(
            problem_of(data, parameters),
            runner.diagnosis,
            rng=np.random.default_rng([data.study.run.seed, 3]),
            options=pipeline.Options(design=ENGINE_DESIGN, check_seeds=3, rounds=4),
        )
    except _MissingRuns:
        runner.asked.append("what follows depends on these runs")
    facts["diagnosis"] = runner.asked
    return facts


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


def _calibration(
    data: StudyData, out: Path, how: RunOptions
) -> tuple[dict[str, Any], _StoredOnly, Mapping[str, float] | None]:
    """Return the facts, the runner that was asked, and the parameters if all runs are stored."""
    runner = _StoredOnly(out / RUNS, how, levels_of(data.study))
    parameters = None
    try:
        parameters = calibrate(data, runner.table).parameters
    except _MissingRuns:
        runner.asked.append("the runs of what follows depend on these")
    total = planned_runs(data.study)
    facts = (
        heading(data, out, how)
        | {
            "runs": total,
            "stored": runner.stored,
            "to run": total - runner.stored,
            "calibration": list(runner.asked),
        }
        | _written(())
    )
    return facts, runner, parameters
