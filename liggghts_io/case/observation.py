"""Measure a run that ended, and store what it says."""

from __future__ import annotations

import math
from pathlib import Path

from liggghts_io.case.attempt import Job
from liggghts_io.case.directory import load_setup, spec_of
from liggghts_io.case.failure import Failure
from liggghts_io.case.inputs import active_effects
from liggghts_io.case.output import COMPLETE, End, log_tail
from liggghts_io.case.results import CaseResult, store_result, store_tables
from liggghts_io.case.spec import CaseSpec, experiment_of
from liggghts_io.errors import CaseError, DamagedFile
from liggghts_io.experiments.setup import Observed, Setup


def _read(spec: CaseSpec, folder: Path, setup: Setup) -> Observed:
    """Return what the instruments showed of a finished run."""
    observed = experiment_of(spec).observe(folder, setup)
    for effect, strength in active_effects(spec).items():
        if effect.read is not None:
            observed = effect.read(observed, strength, setup)
    return observed


def observe_run(job: Job, folder: Path, end: End | None) -> CaseResult:
    """Measure a run that ended and store what it says."""
    output, wall = (end.digest, end.wall_s) if end else ("", 0.0)

    def failed(reason: str) -> CaseResult:
        tail = log_tail(folder)
        return store_result(
            CaseResult(
                job.identity, job.directory, "failed", reason, {}, wall, Failure.PHYSICS, tail,
                output=output,
            )
        )  # fmt: skip

    if end is not None and end.exit != COMPLETE:
        return failed(end.reason)
    try:
        observed = _read(spec_of(job.record, job.directory), folder, load_setup(job.directory))
    except DamagedFile:
        raise
    except CaseError as err:
        return failed(str(err))
    bad = [name for name, value in observed.values.items() if not math.isfinite(value)]
    if bad:
        return failed(f"{', '.join(bad)} is not a finite number")
    tables = store_tables(job.directory, observed.tables)
    values = dict(observed.values)
    return store_result(
        CaseResult(
            job.identity, job.directory, "ok", "", values, wall, tables=tables, output=output
        )
    )
