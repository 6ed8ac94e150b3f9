"""Why a run gave no numbers, in classes that say what to do about it."""

from __future__ import annotations

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
