"""Runs that an executor has: handed over, landed, lost on the way."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    wait,
)
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final, TypeAlias

from calibrate.errors import CalibrationError
from calibrate.runs.failures import died, executor_gone, refusal, report_bug
from calibrate.runs.queue import Held, Stored
from liggghts_io import CaseError, CaseResult, CaseSpec

__all__ = ["LOOK_S", "LOST_S", "Execute", "Flight"]

Execute: TypeAlias = Callable[[CaseSpec, Path], CaseResult]

LOOK_S: Final = 20.0
"""After so long without news the directories are asked what became of the runs [s]."""
LOST_S: Final = 60.0
"""A run that nobody is at any more, without a result, counts as lost after this time [s]."""
_STUCK_S: Final = 600.0
"""After so long without a start or an end the user is told [s]."""


@dataclass
class _Run:
    """A run that the executor has."""

    index: int
    started: bool = False
    idle_since: float | None = None


@dataclass
class Flight:
    """Runs that an executor has.

    Attributes
    ----------
    executor : Executor
    execute : callable
        What runs a case.
    root : Path
    seats : int
        Runs that it may have at once.
    stored, held : callable
        As `Campaign` takes them.
    tell : callable
        Receives a line when nothing moves.
    look_s, lost_s : float
        See `LOOK_S` and `LOST_S` [s].
    """

    executor: Executor
    execute: Execute
    root: Path
    seats: int
    stored: Stored
    held: Held
    tell: Callable[[str], None]
    look_s: float = LOOK_S
    lost_s: float = LOST_S
    _runs: dict[Future[CaseResult], _Run] = field(default_factory=dict)
    _moved: float = field(default_factory=time.monotonic)
    _looked: float = field(default_factory=time.monotonic)
    _told: bool = False

    def __len__(self) -> int:
        """Return how many runs are under way."""
        return len(self._runs)

    @property
    def free(self) -> int:
        """How many more runs it takes."""
        return self.seats - len(self._runs)

    def start(self, index: int, spec: CaseSpec) -> None:
        """Hand a run to the executor.

        Raises
        ------
        CalibrationError
            If it takes none any more.
        """
        try:
            # Absolute: a worker on another machine works in another directory.
            future = self.executor.submit(self.execute, spec, self.root.resolve())
        except (CalibrationError, CaseError):
            raise
        except (RuntimeError, OSError) as err:  # what executors raise that have ended
            raise executor_gone(err, self.root) from err
        self._runs[future] = _Run(index)

    def landed(
        self, specs: Sequence[CaseSpec], patience_s: float | None
    ) -> Iterator[tuple[int, CaseResult]]:
        """Wait for a moment and yield the runs that have ended.

        Parameters
        ----------
        specs : sequence of CaseSpec
            All cases, by index.
        patience_s : float or None
            Longest wait [s]; None for as long as nothing needs a look.

        Raises
        ------
        CaseError, CalibrationError, BugError
            As `Campaign.results`.
        """
        if not self._runs:
            return
        longest = min(self.look_s, patience_s or self.look_s)
        for future in wait(self._runs, longest, FIRST_COMPLETED).done:
            run = self._runs.pop(future)
            self._moved = time.monotonic()
            yield run.index, self._outcome(future, specs[run.index])
        if time.monotonic() - self._looked >= self.look_s:
            yield from self._look(specs)
            self._looked = time.monotonic()

    def cancel(self) -> None:
        """Take back what has not begun; what is under way ends by itself, or with its worker."""
        for future in self._runs:
            future.cancel()
        self._runs.clear()

    def _outcome(self, future: Future[CaseResult], spec: CaseSpec) -> CaseResult:
        try:
            result = future.result()
        except (CaseError, CalibrationError):
            raise
        except BrokenProcessPool:
            return died(spec, self.root)
        except BrokenExecutor as err:
            return died(spec, self.root, str(err))
        except CancelledError:
            return died(spec, self.root, "the executor gave this run up")
        except Exception as err:
            raise (refusal(err, self.root) or report_bug(err, self.root)) from err
        return replace(result, path=self.root / result.path.name)

    def _look(self, specs: Sequence[CaseSpec]) -> Iterator[tuple[int, CaseResult]]:
        """Ask the directories about runs of which the executor says nothing."""
        for future, run in list(self._runs.items()):
            result = self._found(run, specs[run.index])
            if result is not None and not future.done():
                self._runs.pop(future)
                future.cancel()
                self._moved = time.monotonic()
                yield run.index, result
        waiting = sum(not run.started for run in self._runs.values())
        if waiting == len(self._runs) > 0 and time.monotonic() - self._moved > _STUCK_S:
            if not self._told:
                self.tell(
                    f"{waiting} runs are with the executor and none has started for "
                    f"{_STUCK_S / 60.0:g} min; are its workers there, or its jobs in the queue?"
                )
            self._told = True

    def _found(self, run: _Run, spec: CaseSpec) -> CaseResult | None:
        """Return the stored result of a run, or that it was lost; None while it may go on."""
        result = self.stored(spec, self.root)
        if result is not None:  # its message did not arrive
            return result
        if self.held(spec, self.root) is not None:
            run.started, run.idle_since = True, None
            return None
        now = time.monotonic()
        run.idle_since = run.idle_since or now
        if run.started and now - run.idle_since >= self.lost_s:
            return died(spec, self.root, "the executor lost this run")
        return None
