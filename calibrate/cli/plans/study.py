"""What a study would do: its own methods are asked, with a runner that knows stored runs only."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import pandas as pd

from calibrate.cli.arguments import JOINT, STAGED
from calibrate.cli.joint.first import check_design
from calibrate.cli.kept import outdated_in, replaced_in
from calibrate.cli.show.about import engine_in_words
from calibrate.cli.show.progress import planned_runs
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.stored import tabled_runs
from calibrate.report.ours import refuse_foreign
from calibrate.runs.campaign import run_table
from calibrate.runs.executors.run_options import RunOptions
from calibrate.runs.stored import (
    RECORD,
    REPORT,
    RUNS,
    SAMPLES,
    START,
    TABLE,
    stored_case,
)
from calibrate.study.data import StudyData
from calibrate.study.model import places_of
from liggghts_io import CaseResult, CaseSpec

__all__ = ["JOINT_FILES", "heading", "joint_plan", "plan_of_fit", "plan_of_study", "written"]


JOINT_FILES: Final = (SAMPLES, START)
"""What a joint calibration writes beside the files of every calibration."""
FOLLOWS: Final = "the runs of what follows depend on these"


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
        return heading(data, out, how) | joint_plan(data, out, how) | written(JOINT_FILES)
    facts = _staged_plan(data, out, how)
    if mode == STAGED:
        return facts
    return facts | joint_plan(data, out, how) | written(JOINT_FILES)


def written(files: Sequence[str]) -> dict[str, Any]:
    """Return what a calibration writes, and further files."""
    return {"would write": [f"{RUNS}/<case id>/", TABLE, RECORD, REPORT, *files]}


def joint_plan(data: StudyData, out: Path, how: RunOptions) -> dict[str, Any]:
    """Return what a joint calibration would run; what follows its first design is not known."""
    study = data.study
    stored = how.limited(stored_case)
    unique = {repr(s): s for s in check_design(data, out)}
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


def plan_of_fit(data: StudyData, out: Path, how: RunOptions, table: Path) -> dict[str, Any]:
    """Return what a fit to the runs of a table would do."""
    fitting = tabled_runs(data, forms_of(data), table)
    fit = [f"Fit to the {len(fitting)} runs of {table} that are of this study; nothing is run"]
    files = {"would write": [TABLE, RECORD, REPORT, SAMPLES]}
    return heading(data, out, how) | {"joint calibration": fit} | files


def heading(data: StudyData, out: Path, how: RunOptions) -> dict[str, Any]:
    """Return what a study is and where it works; refuse what `result_directory` does."""
    study = data.study
    refuse_foreign(out)
    there = "exists, is continued" if out.is_dir() else "new"
    if other := replaced_in(out, study.name):
        there = f"has the results of the study '{other}', which are replaced; its runs stay"
    elif why := outdated_in(out, data):
        there = f"has results of other data ({why}), which are made anew or left out"
    return {
        "study": f"{study.title} ({data.path})",
        "directory": f"{out} ({there})",
        "engine": engine_in_words(study.run.engine),
        "scale": study.run.scale,
        **how.facts(),
    }


def _staged_plan(data: StudyData, out: Path, how: RunOptions) -> dict[str, Any]:
    """Return what a calibration by stages would run."""
    runner = _StoredOnly(out / RUNS, how)
    if runner.root.is_dir():
        _calibrate_from_stored(data, runner)
    if not runner.asked:
        runner.asked += _first_of_all(data)
    total = planned_runs(data.study)
    return (
        heading(data, out, how)
        | {
            "runs": total,
            "stored": runner.stored,
            "to run": total - runner.stored,
            "calibration": list(runner.asked),
        }
        | written(())
    )


def _first_of_all(data: StudyData) -> list[str]:
    """Return what is asked for where nothing is stored; numerical libraries take seconds."""
    study = data.study
    stage = study.stages[0]
    places = places_of(study.target_named(name) for name in stage.targets)
    runs = len(places) * (stage.points + stage.repeats)
    return [f"{stage.title}: {runs} runs, 0 of them stored", FOLLOWS]


def _calibrate_from_stored(data: StudyData, runner: _StoredOnly) -> None:
    """Calibrate from stored runs as far as they go."""
    from calibrate.staged.calibration import calibrate

    try:
        calibrate(data, runner.table)
    except _MissingRuns:
        runner.asked.append(FOLLOWS)
