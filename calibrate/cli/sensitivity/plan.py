"""What a sensitivity study would run, and how long that takes."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from calibrate.cli.plans.study import heading
from calibrate.cli.show.waiting import clock
from calibrate.questions.sensitivity.study import Asked, plan_of
from calibrate.runs.cost import cost_of
from calibrate.runs.executors.run_options import RunOptions
from calibrate.runs.stored import RUNS, SENSITIVITY, SENSITIVITY_PAGE, stored_case
from calibrate.study.data import StudyData
from liggghts_io import CaseResult, CaseSpec
from liggghts_io.case.spec import script_of
from liggghts_io.measure.schedule import load_of

__all__ = ["plan_of_sensitivity"]


def plan_of_sensitivity(
    data: StudyData,
    out: Path,
    how: RunOptions,
    asked: Asked,
    tell: Callable[[str], None] = lambda _line: None,
) -> dict[str, Any]:
    """Return what `sensitivity` would do.

    Parameters
    ----------
    data : StudyData
    out : Path
        Directory of the result, which need not be there.
    how : RunOptions
    asked : Asked
    tell : callable
        Receives a line before each run that is timed.

    Raises
    ------
    CalibrationError, CaseError
        For a baseline that cannot be used, or a case that cannot be described.
    """
    plan = plan_of(data, asked, alone=not (out / RUNS).is_dir())
    stored = how.limited(stored_case)
    results = {repr(spec): stored(spec, out / RUNS) for spec in plan.specs}
    missing = [spec for spec in plan.specs if results[repr(spec)] is None]
    done = [(spec, one) for spec in plan.specs if (one := results[repr(spec)])]
    workers = how.workers or os.cpu_count() or 1
    seconds = _seconds(data, done, missing, tell) / workers
    ready = sum(results[repr(spec)] is not None for spec in plan.design)
    return {
        **heading(data, out, how),
        "baseline": [f"{data.study.label(*key)} = {v:g}" for key, v in plan.baseline.items()],
        "one at a time": f"{len(plan.singles)} runs: {asked.levels} values of each parameter and "
        f"the baseline, {asked.seeds} seeds",
        "Sobol indices": f"{len(plan.design)} runs of the first design of a joint calibration, "
        f"{ready} of them stored; others of this study that are there "
        "are used as well",
        "to run": len(missing),
        "time": f"about {clock(seconds)}" if math.isfinite(seconds) else "not known",
        "would write": [f"{RUNS}/<case id>/", SENSITIVITY, SENSITIVITY_PAGE],
    }


def _seconds(
    data: StudyData,
    done: Sequence[tuple[CaseSpec, CaseResult]],
    missing: Sequence[CaseSpec],
    tell: Callable[[str], None],
) -> float:
    """Return about how long the missing runs take on one core [s].

    A run takes as long as its steps: stiffer grains need more of them. What a step takes is known
    from stored runs of the same grains and experiment; without them, one small case is run.
    """
    taken: dict[tuple[str, str, str], list[float]] = {}
    for spec, result in done:
        taken.setdefault(_kind(spec), []).append(result.wall_s / _steps(spec))
    pace = {kind: float(np.median(each)) for kind, each in taken.items()}
    if any(_kind(spec) not in pace for spec in missing):
        study = data.study
        for place, one in zip(study.places, cost_of(study, 1, tell=tell).places, strict=True):
            name = study.material_named(place.material).bulk.name
            kind = place.experiment, study.surface_named(place.surface).kind, name
            pace.setdefault(kind, one.run_s / one.steps)
    return math.fsum(pace[_kind(spec)] * _steps(spec) for spec in missing)


def _kind(spec: CaseSpec) -> tuple[str, str, str]:
    return spec.experiment, spec.surface, spec.particle.name


def _steps(spec: CaseSpec) -> float:
    return max(float(load_of(script_of(spec)).steps), 1.0)
