"""Why a run gave no numbers, in classes that say what to do about it."""

from __future__ import annotations

import errno
from enum import StrEnum
from typing import Final


class Failure(StrEnum):
    """Class of a failure.

    `PHYSICS` comes again whenever the case is run: it is a result, stored and reused. `KILLED`,
    `TIME` and `DISK` say something about the machine on that day: such a case counts as not run.
    """

    MISTAKE = "mistake"
    """The user's: raised as `CaseError` before anything runs, never stored."""
    PHYSICS = "physics"
    """The engine stopped with a reason, or the run does not determine an observable."""
    KILLED = "killed"
    """A signal, memory that ran out, a worker that died."""
    TIME = "time"
    """The run took longer than its limit."""
    DISK = "disk"
    """The disk was full, or a file could not be written or is incomplete."""
    BUG = "bug"
    """Anything else: a fault of this program, to be reported with its traceback."""


RETRYABLE: Final = (Failure.KILLED, Failure.TIME, Failure.DISK)
"""What the next campaign tries again."""

_DISK_ERRORS: Final = frozenset(
    {errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.ESTALE, errno.EROFS}
)


class EngineStopped(RuntimeError):  # noqa: N818 - it is a result of a run, not a fault of ours
    """The engine started and did not complete: data, not a fault of the caller.

    Parameters
    ----------
    failure : Failure
    reason : str
    log_tail : str
        Last lines of its log.
    """

    def __init__(self, failure: Failure, reason: str, log_tail: str = "") -> None:
        super().__init__(reason)
        self.failure = failure
        self.log_tail = log_tail


def out_of_time(engine: str, limit_s: float | None) -> EngineStopped:
    """Return what to raise for a run that took longer than it may."""
    reason = f"{engine} was stopped after {limit_s or 0.0:g} s, the limit of a run"
    return EngineStopped(Failure.TIME, reason)


def failure_of(error: BaseException) -> Failure | None:
    """Return the class of an error that the machine caused, also of one that wraps it.

    Returns
    -------
    Failure or None
        `DISK` or `KILLED`; None where neither the disk nor the memory is to blame.
    """
    seen: set[int] = set()
    link: BaseException | None = error
    while link is not None and id(link) not in seen:
        seen.add(id(link))
        if isinstance(link, OSError) and link.errno in _DISK_ERRORS:
            return Failure.DISK
        if isinstance(link, MemoryError):
            return Failure.KILLED
        link = link.__cause__ or link.__context__
    return None


def said_plainly(error: Exception) -> str:
    """Return the message of an error; Python's own for a full memory is empty."""
    if isinstance(error, MemoryError):
        return "memory ran out"
    if isinstance(error, OSError) and error.strerror:
        return f"{error.strerror}: {error.filename}" if error.filename else error.strerror
    return str(error)
