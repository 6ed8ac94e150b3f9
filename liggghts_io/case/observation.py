"""Measure a run that ended, and store what it says."""

from __future__ import annotations

import math
from pathlib import Path

from liggghts_io.case.attempt import Job
from liggghts_io.case.directory import load_setup, spec_of
from liggghts_io.case.failure import Failure
from liggghts_io.case.output import COMPLETE, End, log_tail
from liggghts_io.case.results import CaseResult, store_result, store_tables
from liggghts_io.case.spec import experiment_of
from liggghts_io.errors import CaseError, DamagedFile


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
    experiment = experiment_of(spec_of(job.record, job.directory))
    try:
        observed = experiment.observe(folder, load_setup(job.directory))
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
