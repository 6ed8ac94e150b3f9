"""What a diagnosis would do: the methods are asked, with a runner that knows stored runs only."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from calibrate.cli.diagnose_study import ENGINE_DESIGN
from calibrate.cli.plans.study import MissingRuns, StoredOnly, heading, plan_of_stages
from calibrate.diagnose import pipeline
from calibrate.diagnose.from_study import levels_of, problem_of
from calibrate.report.record import start_of
from calibrate.runs.executors.run_options import RunOptions
from calibrate.runs.reuse import with_curves
from calibrate.runs.stored import DIAGNOSIS, EXTENDED, FIGURE, RUNS, SECTION
from calibrate.study.data import StudyData
from liggghts_io import CaseResult, CaseSpec

__all__ = ["plan_of_diagnosis"]


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
        facts, runner, parameters = plan_of_stages(data, out, how)
    else:
        runner = StoredOnly(out / RUNS, how)
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
    levels = levels_of(data.study)

    def results(specs: Sequence[CaseSpec]) -> list[CaseResult]:
        found = runner.results(specs, "diagnosis")
        return [with_curves(r, s, levels) for r, s in zip(found, specs, strict=True)]

    try:
        pipeline.diagnose(
            problem_of(data, parameters),
            results,
            rng=np.random.default_rng([data.study.run.seed, 3]),
            options=pipeline.Options(design=ENGINE_DESIGN, check_seeds=3, rounds=4),
        )
    except MissingRuns:
        runner.asked.append("what follows depends on these runs")
    facts["diagnosis"] = runner.asked
    return facts
