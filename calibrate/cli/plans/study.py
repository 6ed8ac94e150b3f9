"""What a study would do: its own methods are asked, with a runner that knows stored runs only."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import pandas as pd

from calibrate.cli.about import engine_in_words
from calibrate.cli.arguments import JOINT, STAGED
from calibrate.cli.show.progress import planned_runs
from calibrate.questions.core.design import first_cases, joint_rng
from calibrate.questions.core.from_study import forms_of
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

__all__ = ["MissingRuns", "StoredOnly", "heading", "plan_of_stages", "plan_of_study", "written"]


JOINT_FILES: Final = (SAMPLES, START)
"""What a joint calibration writes beside the files of every calibration."""
FOLLOWS: Final = "the runs of what follows depend on these"


class MissingRuns(Exception):  # noqa: N818 - not an error: here the plan ends
    """A method asks for runs that are not stored."""


@dataclass
class StoredOnly:
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
            raise MissingRuns
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
        return heading(data, out, how) | _joint(data, out, how) | written(JOINT_FILES)
    facts, _, _ = plan_of_stages(data, out, how)
    if mode == STAGED:
        return facts
    return facts | _joint(data, out, how) | written(JOINT_FILES)


def written(files: Sequence[str]) -> dict[str, Any]:
    """Return what a calibration writes, and further files."""
    return {"would write": [f"{RUNS}/<case id>/", TABLE, RECORD, REPORT, *files]}


def _joint(data: StudyData, out: Path, how: RunOptions) -> dict[str, Any]:
    """Return what a joint calibration would run; what follows its first design is not known."""
    study = data.study
    stored = how.limited(stored_case)
    unique = {repr(s): s for s in first_cases(study, forms_of(data), joint_rng(study))}
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


def plan_of_stages(
    data: StudyData, out: Path, how: RunOptions
) -> tuple[dict[str, Any], StoredOnly, Mapping[str, float] | None]:
    """Return the facts, the runner that was asked, and the parameters if all runs are stored.

    Parameters
    ----------
    data : StudyData
    out : Path
        Directory of the result, which need not be there.
    how : RunOptions
        What would run the cases.
    """
    runner = StoredOnly(out / RUNS, how)
    parameters = _calibrated(data, runner) if runner.root.is_dir() else None
    if not runner.asked:
        runner.asked += _first_of_all(data)
    total = planned_runs(data.study)
    facts = (
        heading(data, out, how)
        | {
            "runs": total,
            "stored": runner.stored,
            "to run": total - runner.stored,
            "calibration": list(runner.asked),
        }
        | written(())
    )
    return facts, runner, parameters


def _first_of_all(data: StudyData) -> list[str]:
    """Return what is asked for where nothing is stored; numerical libraries take seconds."""
    study = data.study
    stage = study.stages[0]
    places = places_of(study.target_named(name) for name in stage.targets)
    runs = len(places) * (stage.points + stage.repeats)
    return [f"{stage.title}: {runs} runs, 0 of them stored", FOLLOWS]


def _calibrated(data: StudyData, runner: StoredOnly) -> Mapping[str, float] | None:
    """Calibrate from stored runs as far as they go; the parameters if all are there."""
    from calibrate.staged.calibration import calibrate

    try:
        return calibrate(data, runner.table).parameters
    except MissingRuns:
        runner.asked.append(FOLLOWS)
        return None
