"""Failed runs in words, and the two failures after which going on makes no sense."""

from __future__ import annotations

import errno
import os
import traceback
from collections import Counter
from pathlib import Path

import pandas as pd

from calibrate.errors import BugError, CalibrationError
from liggghts_io import CaseResult, CaseSpec, Failure, case_id
from liggghts_io.case.failure import failure_of
from liggghts_io.files import write_text

__all__ = [
    "TRACEBACK",
    "died",
    "executor_gone",
    "failure_lines",
    "full_disk",
    "refusal",
    "report_bug",
    "stop_if_hopeless",
]

TRACEBACK = "traceback.txt"
_TRIED_AGAIN = {
    Failure.KILLED: "was killed",
    Failure.DISK: "ran out of disk",
}
_DENIED = (errno.EACCES, errno.EPERM, errno.ENAMETOOLONG, errno.ENOTDIR)
_LIMITS = {
    errno.EMFILE: "raise the limit of open files (ulimit -n)",
    errno.ENFILE: "end other programs",
    errno.EAGAIN: "raise the limit of processes (ulimit -u)",
    errno.ENOMEM: "end other programs, or give the machine more memory",
}
"""What to do where the system gives a process no more of something."""


def failure_lines(runs: pd.DataFrame) -> list[str]:
    """Return what to tell about the failed runs of a table; nothing when none failed.

    Parameters
    ----------
    runs : DataFrame
        As `campaign.run_table` makes it.

    Returns
    -------
    list of str
        How many runs failed, by class, then one line per class and reason with an example, and
        what to do about those that need not fail again.
    """
    failed = runs[runs["status"] != "ok"]
    if failed.empty:
        return []
    classes = Counter(failed["failure"])
    counts = ", ".join(f"{count} {name}" for name, count in classes.most_common())
    lines = [f"{len(failed)} of {len(runs)} runs failed: {counts}"]
    for (name, reason), rows in failed.groupby(["failure", "reason"], sort=False):
        first = rows.iloc[0]
        where = f"{first['experiment']} on {first['surface']}, seed {first['seed']}"
        many = f"{len(rows)} runs, first " if len(rows) > 1 else ""
        lines.append(f"  {name}: {reason} ({many}{where}: {first['path']})")
    again = [one for one in _TRIED_AGAIN if one in classes]
    if again:
        words = " or ".join(_TRIED_AGAIN[one] for one in again)
        lines.append(f"  start the same command again to try again what {words}")
    if Failure.TIME in classes:
        lines.append("  what ran out of time runs again with a longer --time-limit")
    return lines


def died(spec: CaseSpec, root: Path, reason: str = "") -> CaseResult:
    """Return the result of a run whose process did not live to tell.

    Parameters
    ----------
    spec : CaseSpec
    root : Path
        Holds its case directory.
    reason : str
        What the executor says about it.
    """
    identity = case_id(spec)
    why = reason or "the process of this run was killed, or ran out of memory"
    return CaseResult(identity, root / identity, "failed", why, {}, 0.0, Failure.KILLED)


def executor_gone(error: BaseException, root: Path) -> CalibrationError:
    """Return the error that ends a campaign whose executor takes no more runs.

    Parameters
    ----------
    error : BaseException
    root : Path
        Directory of the cases.
    """
    why = str(error) or type(error).__name__
    number = error.errno if isinstance(error, OSError) else None
    remedy = _LIMITS.get(number or 0, "see that its workers are there")
    return CalibrationError(
        f"what should run the cases takes no more of them ({why}). Finished runs are kept in "
        f"{root}: {remedy}, then start the same command again"
    )


def refusal(error: BaseException, place: Path) -> CalibrationError | None:
    """Return what to raise for an error that the machine is to blame for, else None.

    Parameters
    ----------
    error : BaseException
    place : Path
        Directory of the work.
    """
    failure = failure_of(error)
    if failure == Failure.DISK:
        return full_disk(place, str(error))
    if failure is not None:
        return CalibrationError(f"memory ran out ({error}); use fewer --workers")
    number = error.errno if isinstance(error, OSError) else None
    if number in _DENIED:
        msg = f"{place}: cannot be written ({error}); mend that, or choose another --out"
        return CalibrationError(msg)
    if number in _LIMITS:
        return CalibrationError(f"{error}: {_LIMITS[number]}, or use fewer --workers")
    return None


def full_disk(place: Path, reason: str) -> CalibrationError:
    """Return the error that ends work for want of space.

    Parameters
    ----------
    place : Path
        Directory on the disk.
    reason : str
        What could not be written.
    """
    limited = os.strerror(errno.EFBIG) in reason
    remedy = "raise the limit of the size of files (ulimit -f)" if limited else "free some space"
    return CalibrationError(
        f"{place}: the disk is full or does not take what is written ({reason}). Finished runs "
        f"are kept: {remedy}, then start the same command again"
    )


def report_bug(error: BaseException, folder: Path) -> BugError:
    """Write the traceback of an unexpected error and return what to raise instead.

    Parameters
    ----------
    error : BaseException
    folder : Path
        Where the file goes.
    """
    text = "".join(traceback.format_exception(error))
    evidence = f"the file {folder / TRACEBACK}"
    try:
        write_text(folder / TRACEBACK, text)
    except OSError:
        evidence = f"this:\n{text}"
    return BugError(
        f"{type(error).__name__}: {error}. This is a fault of bulkcal, not of your study; finished "
        f"runs are kept. Please report it with {evidence}"
    )


def stop_if_hopeless(result: CaseResult, root: Path) -> None:
    """Raise when a failure concerns every run that would follow.

    Raises
    ------
    CalibrationError
        When the disk is full.
    BugError
        When the run stumbled over a fault of this program.
    """
    if result.failure == Failure.DISK:
        raise full_disk(root, result.reason)
    if result.failure == Failure.BUG:
        msg = f"{result.reason}. Finished runs are kept"
        raise BugError(msg)
