"""Run cases: under the lock, in a folder of their own, measured, stored."""

from __future__ import annotations

import shutil
import time
import traceback
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from liggghts_io.case.attempt import Job, intact_end, run_attempt
from liggghts_io.case.directory import (
    OUTPUT,
    RESULT,
    checked_files,
    code_today,
    is_written,
    load_record,
    other_parts,
    spec_of,
    write_files,
)
from liggghts_io.case.failure import EngineStopped, Failure, failure_of, said_plainly
from liggghts_io.case.liggghts import find_liggghts
from liggghts_io.case.lock import Tell, locked
from liggghts_io.case.observation import observe_run
from liggghts_io.case.output import clear_leftovers, find_run
from liggghts_io.case.results import CaseResult, final_result, store_result, stored_result
from liggghts_io.case.runner import Progress
from liggghts_io.case.spec import CaseSpec, describe
from liggghts_io.effects import check_engine
from liggghts_io.errors import CaseError, DamagedFile, DiskFull
from liggghts_io.files import write_text

TRACEBACK: Final = "traceback.txt"


def run_case(
    directory: Path,
    engine: str = "",
    progress: Progress | None = None,
    *,
    again: bool = False,
    tell: Tell | None = None,
) -> CaseResult:
    """Run a case directory as it stands and store its result.

    Parameters
    ----------
    directory : Path
        As `write_case` left it.
    engine : str
        Empty for the engine that the case was generated for. A case that was never run and is no
        part of a campaign is recorded anew for another one.
    progress : callable, optional
        Called with the steps done and the steps in all.
    again : bool
        Run also when a result is stored.
    tell : callable, optional
        Receives a line when another process is waited for, a stored result is taken, or the case
        is recorded anew.

    Returns
    -------
    CaseResult
        With status "failed", the class of the failure and the reason when the engine did not
        complete or an observable is not determined.

    Raises
    ------
    CaseError
        If the directory holds no intact case, its script or a mesh was changed, it was made by
        another version, or the engine is not installed or lacks an effect.
    """
    load_record(directory)  # before a lock file appears in a directory that holds no case
    with locked(directory, tell):
        job = _for_engine(Job(directory, load_record(directory)), engine, tell)
        _check_code(job.record, directory)
        checked_files(directory, job.record)
        stored = None if again else final_result(directory, job.identity)
        if stored is not None:
            if tell is not None:
                tell("this case has been run: the stored result is shown; --again runs it again")
            return stored
        return _run(job, progress, again=again)


def post_case(directory: Path, tell: Tell | None = None) -> CaseResult:
    """Compute the observables again from what the engine wrote, and store them.

    Parameters
    ----------
    directory : Path
        With a finished run, also one started by hand.
    tell : callable, optional
        Receives a line when another process is waited for.

    Raises
    ------
    CaseError
        If the directory holds no intact case, was made by another version, or holds no run that
        completed and is intact; it says how far the run got or which file was changed.
    """
    load_record(directory)
    with locked(directory, tell):
        job = Job(directory, load_record(directory))
        _check_code(job.record, directory)
        checked_files(directory, job.record)
        folder, end = find_run(directory, job.identity, job.engine)
        return observe_run(job, folder, end)


def execute(
    spec: CaseSpec, root: Path, tell: Tell | None = None, *, limit_s: float | None = None
) -> CaseResult:
    """Write, run and measure a case in `root/<case id>`, or return the stored result.

    Safe to call from the workers of a process pool, from several campaigns at once and on a
    shared file system with locks: a case is run by one process at a time, and the others take its
    result.

    Parameters
    ----------
    spec : CaseSpec
    root : Path
    tell : callable, optional
        Receives a line when another process is waited for.
    limit_s : float, optional
        Wall-clock limit of the engine [s]. A run that takes longer is stopped and fails with the
        class "time", which stands until a longer limit is given, or none.

    Raises
    ------
    CaseError
        If the spec cannot be turned into a script, the engine is not installed, or nothing can be
        written under `root`.
    """
    case = describe(spec)
    directory = root / case.identity
    stored = stored_result(root, case.identity, limit_s)
    if stored is not None:
        return stored
    try:
        with locked(directory, tell):
            stored = stored_result(root, case.identity, limit_s)
            if stored is not None:  # another process ran it meanwhile
                return stored
            if not is_written(case, directory):
                write_files(case, directory)
            job = Job(directory, load_record(directory))
            return _run(job, None, again=False, limit_s=limit_s)
    except DiskFull as err:
        return CaseResult(case.identity, directory, "failed", str(err), {}, 0.0, Failure.DISK)


def _for_engine(job: Job, engine: str, tell: Tell | None) -> Job:
    """Return a case recorded for an engine; refuse where results would lose their case."""
    spec = spec_of(job.record, job.directory)
    check_engine(spec.effects, engine or spec.engine, str(job.directory))
    if engine in ("", spec.engine):
        return job
    in_campaign = job.directory.resolve().name == job.identity
    ran = any((job.directory / name).exists() for name in (OUTPUT, RESULT))
    if in_campaign or ran:
        what = "belongs to a campaign" if in_campaign else f"has results of {spec.engine}"
        msg = (
            f"{job.directory}: {what}; for {engine} make a case of its own with "
            f"'bulkcal generate ... --engine {engine} --out OTHER'"
        )
        raise CaseError(msg)
    if engine == "liggghts" and find_liggghts() is None:
        msg = "liggghts not found: install it (Debian package liggghts) or set BULKCAL_LIGGGHTS"
        raise CaseError(msg)
    _check_code(job.record, job.directory)
    checked_files(job.directory, job.record)
    write_files(describe(replace(spec, engine=engine)), job.directory)
    if tell is not None:
        tell(f"{job.directory}: was generated for {spec.engine}; now recorded for {engine}")
    return Job(job.directory, load_record(job.directory))


def _run(
    job: Job, progress: Progress | None, *, again: bool, limit_s: float | None = None
) -> CaseResult:
    """Run and measure a case; what goes wrong becomes a result with its class."""
    started = time.perf_counter()
    (job.directory / TRACEBACK).unlink(missing_ok=True)  # of an earlier run
    try:
        end = None if again else intact_end(job)
        if end is None:
            end = run_attempt(job, progress, limit_s)
        return observe_run(job, job.directory / OUTPUT, end)
    except DamagedFile as err:  # as the engine left it: nothing that another look could mend
        shutil.rmtree(job.directory / OUTPUT, ignore_errors=True)
        stopped = EngineStopped(Failure.DISK, f"{err} (was the disk full?)")
    except CaseError:  # nothing ran
        clear_leftovers(job.directory)
        raise
    except EngineStopped as err:
        stopped = err
    except Exception as err:
        stopped = _classified(err, job.directory)
    if stopped.failure == Failure.DISK:
        clear_leftovers(job.directory)  # an attempt would keep the disk full
    wall = time.perf_counter() - started
    result = CaseResult(
        job.identity, job.directory, "failed", str(stopped), {}, wall, stopped.failure,
        stopped.log_tail,
    )  # fmt: skip
    return _keep(result)


def _classified(error: Exception, directory: Path) -> EngineStopped:
    """Return what an unexpected error means; a fault of this program leaves its traceback."""
    failure = failure_of(error)
    if failure is not None:
        return EngineStopped(failure, said_plainly(error))
    with suppress(OSError):
        write_text(directory / TRACEBACK, traceback.format_exc())
    reason = (
        f"{type(error).__name__}: {error}; this is a fault of bulkcal, please report it with "
        f"{directory / TRACEBACK}"
    )
    return EngineStopped(Failure.BUG, reason)


def _keep(result: CaseResult) -> CaseResult:
    """Store a result that does not stand, unless one that stands is there."""
    if final_result(result.path, result.case_id) is None:
        with suppress(OSError):  # the disk may be full, which is what the result says
            store_result(result)
    return result


def _check_code(record: Mapping[str, Any], directory: Path) -> None:
    """Refuse a case that other code made.

    Raises
    ------
    CaseError
        Naming what differs.
    """
    today = code_today(record, directory)
    stored = record["inputs"]["code"]
    parts = other_parts(record, today)
    if parts:
        differ = ", ".join(
            f"{part}: {stored.get(part, 'none')[:24]}, now {today[part][:24]}" for part in parts
        )
        msg = (
            f"{directory}: made by another version of bulkcal or of the engine ({differ}); "
            "generate the case again into another directory"
        )
        raise CaseError(msg)
