"""What a diagnosis would do, from the runs that are stored."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from calibrate.causes.studies.from_study import considered, with_effects
from calibrate.causes.studies.further.ranking import FURTHER
from calibrate.causes.studies.sharpen import MORE
from calibrate.causes.studies.study_diagnosis import first_twins
from calibrate.causes.studies.twins import SCREENED, TWINS, twin_cases
from calibrate.cli.diagnose_study import base_runs_stored
from calibrate.cli.plans.study import JOINT_FILES, heading, joint_plan, written
from calibrate.cli.show.waiting import clock
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.runs import Runs
from calibrate.questions.core.stored import tabled_runs
from calibrate.runs.executors.run_options import RunOptions
from calibrate.runs.stored import DIAGNOSIS, EXTENDED, FIGURE, REPORT, RUNS, SECTION, stored_case
from calibrate.study.data import StudyData

__all__ = ["plan_of_diagnosis", "plan_of_tables"]


def plan_of_diagnosis(
    data: StudyData, out: Path, how: RunOptions, twins: int | None, more: int | None,
    further: int | None,
) -> dict[str, Any]:  # fmt: skip
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
        before = list(written(JOINT_FILES)["would write"])
        if "stages" in record and record.get("study_sha256") == data.sha256:
            facts["first"] = "the joint calibration is made, beside that by stages"
        else:
            facts["first"] = "the joint calibration is made, there is none that fits"
        facts |= joint_plan(data, out, how)
    given = ((twins, TWINS), (more, MORE), (further, FURTHER))
    asked = [usual if said is None else said for said, usual in given]
    facts["diagnosis"] = _runs(data, out, how, base, *asked)
    files = [FIGURE, SECTION, DIAGNOSIS, f"{EXTENDED}/", f"a section in {REPORT}"]
    facts["would write"] = [*(before or [f"{RUNS}/<case id>/"]), *files]
    return facts


def plan_of_tables(
    data: StudyData, out: Path, tables: Sequence[Path], how: RunOptions, *, check: bool = False
) -> dict[str, Any]:
    """Return what `diagnose` would do with the runs of tables, and the engine if it is asked.

    Raises
    ------
    CalibrationError
        For a file that is no such table, and runs of another study.
    """
    runs = tabled_runs(data, forms_of(with_effects(data)), *tables)
    files = [FIGURE, SECTION, DIAGNOSIS, f"{EXTENDED}/"]
    if (out / REPORT).exists():
        files.append(f"a section in {REPORT}")
    names = " and ".join(map(str, tables))
    told = f"the {len(runs)} runs of {names} that fit the study are used"
    lines = [f"no run; {told}"]
    if check:
        checks, pace = _checks(data), float(runs.table["wall_s"].median())
        left = clock(pace * checks / (how.workers or os.cpu_count() or 1))
        lines = [told, f"the engine at the best values: up to {checks} runs, about {left} at most"]
        files.insert(0, f"{RUNS}/<case id>/")
    return {**heading(data, out, how), "diagnosis": lines, "would write": files}


def _checks(data: StudyData) -> int:
    """Return how often the engine is run at the best values, at most."""
    return 2 * len(data.study.places) * data.study.design.check_seeds


def _runs(
    data: StudyData, out: Path, how: RunOptions, base: Runs | None, twins: int, more: int,
    further: int,
) -> list[str]:  # fmt: skip
    """Return what a diagnosis would run, and how long that takes."""
    checks = _checks(data)
    wider = with_effects(data)
    effects = data.study.layout.effects
    forms = forms_of(wider)
    asked = [s for form in forms.values() for s in form.switches]
    switches = sum(effects[s.name].needs_runs for s in asked)
    open_ = f"further experiments, where it stays open which cause it is: up to {further}"
    if base is None:
        return [
            f"A few runs of each effect: about {min(twins, SCREENED) * switches}, after that",
            f"more of those that can be seen: up to {twins * switches} in all",
            f"where evidence or strength of leading causes is uncertain: up to {more} each",
            f"the engine at the best values: up to {checks}",
            open_,
        ]
    first = first_twins(data, base, twins)
    names = [e.name for e in considered(data.study)]
    every = twin_cases(forms, base, effects, names, twins)
    stored = how.limited(stored_case)
    missing = [spec for spec in every if stored(spec, out / RUNS) is None]
    early = sum(stored(spec, out / RUNS) is not None for spec in first)
    pace = float(base.table["wall_s"].median()) / (how.workers or os.cpu_count() or 1)
    left = clock(pace * (len(missing) + 2 * more + checks + further))
    return [
        f"{len(base)} runs of the joint calibration are used",
        f"A few runs of each effect: {len(first)} runs, {early} of them stored",
        f"more of those that can be seen: up to {len(every)} runs in all, "
        f"{len(every) - len(missing)} of them stored",
        f"where evidence or strength of leading causes is uncertain: up to {more} each",
        f"the engine at the best values: up to {checks}",
        open_,
        f"about {left} of running at most, and some minutes of computing",
    ]
