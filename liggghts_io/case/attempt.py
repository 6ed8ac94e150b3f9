"""One run of the engine: in a fresh folder, which becomes the output when the engine has ended."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from liggghts_io.case.directory import OUTPUT, checked_files
from liggghts_io.case.failure import EngineStopped, Failure
from liggghts_io.case.mark import completed_step
from liggghts_io.case.output import (
    COMPLETE,
    End,
    check_complete,
    digests,
    finish,
    log_tail,
    new_attempt,
    progress_of,
    shown,
    verify,
)
from liggghts_io.case.runner import Progress, run_engine
from liggghts_io.errors import DamagedFile
from liggghts_io.measure.dumps import SCRIPT


@dataclass(frozen=True)
class Job:
    """A case directory whose lock is held and whose record is intact.

    Attributes
    ----------
    directory : Path
    record : Mapping[str, Any]
        As `load_record` returned it.
    """

    directory: Path
    record: Mapping[str, Any]

    @property
    def identity(self) -> str:
        """Case id."""
        return str(self.record["case_id"])

    @property
    def engine(self) -> str:
        """Name of the engine."""
        return str(self.record["inputs"]["spec"]["engine"])


def intact_end(job: Job) -> End | None:
    """Return how the run ended that is stored in full but was not measured, None if none is."""
    try:
        return verify(job.directory / OUTPUT, job.identity)
    except DamagedFile:
        return None


def run_attempt(job: Job, progress: Progress | None, limit_s: float | None) -> End:
    """Run the engine in a fresh folder, which becomes the output when the engine has ended.

    Raises
    ------
    EngineStopped
        If the run does not count: the engine was killed, ran out of time or of disk.
    """
    attempt = new_attempt(job.directory, checked_files(job.directory, job.record))
    started = time.perf_counter()
    how, reason = COMPLETE, ""
    try:
        run_engine(attempt, SCRIPT, job.engine, progress, limit_s)
        _check_ended(attempt, job.identity)
    except EngineStopped as err:
        if err.failure != Failure.PHYSICS:
            raise EngineStopped(err.failure, str(err), log_tail(attempt)) from err
        how, reason = "failed", str(err)
    done, steps = progress_of(attempt, job.identity)
    end = End(
        case_id=job.identity,
        engine=job.record["inputs"]["code"]["engine"],
        exit=how,
        reason=reason,
        step=steps if how == COMPLETE else done,
        steps=steps,
        wall_s=time.perf_counter() - started,
        files=digests(attempt),
    )
    finish(attempt, end)
    return end


def _check_ended(attempt: Path, identity: str) -> None:
    """Refuse a run that an engine ended without an error and without completing it."""
    done, steps = progress_of(attempt, identity)
    if completed_step(shown(attempt), identity) != steps:
        reason = f"the engine was stopped at step {done} of {steps}"
        raise EngineStopped(Failure.KILLED, reason)
    try:
        check_complete(attempt, identity)
    except DamagedFile as err:  # LIGGGHTS does not notice when a write fails
        raise EngineStopped(Failure.DISK, f"{err} (was the disk full?)") from err
