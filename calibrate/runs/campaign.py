"""Run many cases: in parallel, with progress, surviving failures, crashes and interruptions.

Every run is a case directory under one root, so a campaign has no state of its own: started again,
it finds the finished cases and runs the others. Any `concurrent.futures.Executor` will do, a
cluster's too; the default is a fresh process per core.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol, TypeAlias

import pandas as pd

from calibrate.runs.failures import died, failure_lines, refusal, report_bug, stop_if_hopeless
from calibrate.runs.queue import Held, Queue, Stored, nothing
from calibrate.runs.workers import WorkerPool
from liggghts_io import CaseError, CaseResult, CaseSpec, Failure
from liggghts_io.experiments import EXPERIMENTS

__all__ = ["Campaign", "Progress", "ProgressCallback", "run_table"]

Execute: TypeAlias = Callable[[CaseSpec, Path], CaseResult]


class Submits(Protocol):
    """What is needed of a worker: an executor is one, too."""

    def submit(self, fn: Callable[..., Any], /, *args: Any) -> Future[Any]:
        """Start a call."""


@dataclass(frozen=True)
class Progress:
    """State of a campaign.

    Attributes
    ----------
    label : str
    done, total, failed : int
        Runs; `done` counts those that were stored already.
    elapsed_s : float
    left_s : float or None
        Time left; None until a run has ended.
    """

    label: str
    done: int
    total: int
    failed: int
    elapsed_s: float
    left_s: float | None


ProgressCallback: TypeAlias = Callable[[Progress], None]


def _silent(_what: object) -> None:
    """Say nothing."""


class Campaign:
    """Runs cases under a root directory; an instance is a `plan.Runner` and a context manager.

    Several campaigns may work in one directory: a case that another one runs is put off until
    its result is there.

    Parameters
    ----------
    root : Path
        Case directories are made here; nothing is ever deleted.
    execute : callable
        `liggghts_io.execute` or a stand-in of the same interface; must be picklable.
    stored : callable, optional
        Returns the stored result of a case or None, so that finished cases need no worker.
    held : callable, optional
        Says who else runs a case just now, or returns None.
    workers : int
        Processes, 0 for one per core.
    progress : callable
        Called with a `Progress` after each finished run.
    tell : callable
        Receives a line when the campaign waits for another one or tries a run again, and at its
        end the failures.
    executor : Executor, optional
        Used instead of a pool of processes; its owner closes it.
    """

    def __init__(
        self,
        root: Path,
        execute: Execute,
        *,
        stored: Stored = nothing,
        held: Held = nothing,
        workers: int = 0,
        progress: ProgressCallback = _silent,
        tell: Callable[[str], None] = _silent,
        executor: Executor | None = None,
    ) -> None:
        self.root = root
        self.workers = workers or os.cpu_count() or 1
        self._execute = execute
        self._stored = stored
        self._held = held
        self._progress = progress
        self._tell = tell
        self._executor = executor
        self._pool: WorkerPool | None = None

    def __enter__(self) -> Campaign:
        """Return the campaign; leaving the block stops its workers."""
        return self

    def __exit__(self, kind: type[BaseException] | None, *rest: object) -> None:
        """Stop the workers, at once when an error or Ctrl-C ends the block."""
        if self._pool is not None:
            self._pool.close(at_once=kind is not None)
            self._pool = None

    def __call__(self, specs: Sequence[CaseSpec], label: str) -> pd.DataFrame:
        """Run `specs` and return one row per case, in their order, as `results` and `run_table`."""
        return run_table(specs, self.results(specs, label))

    def results(self, specs: Sequence[CaseSpec], label: str) -> list[CaseResult]:
        """Run `specs` and return their results in order.

        Parameters
        ----------
        specs : sequence of CaseSpec
            What to run; a case that is stored already is not run again.
        label : str
            Shown with the progress.

        Raises
        ------
        CaseError
            When a specification is impossible or the engine is missing, at once: that is a
            mistake in the input, not a failed run.
        CalibrationError
            When the disk is full: no run that follows could be stored.
        BugError
            When a run stumbles over a fault of this program.
        KeyboardInterrupt
            Passed on; finished cases are kept and the next call continues.
        """
        self.root.mkdir(parents=True, exist_ok=True)
        results: dict[int, CaseResult] = {}
        for i, spec in enumerate(specs):
            result = self._stored(spec, self.root)
            if result is not None:
                results[i] = result
        todo = [i for i in range(len(specs)) if i not in results]
        started, reused = time.monotonic(), len(results)
        self._show(label, results, len(specs), 0.0, None if todo else 0.0)
        for i, result in self._results(specs, todo):
            results[i] = result
            elapsed = time.monotonic() - started
            fresh = len(results) - reused
            left = elapsed / fresh * (len(specs) - len(results))
            self._show(label, results, len(specs), elapsed, left)
        ordered = [results[i] for i in range(len(specs))]
        for line in failure_lines(run_table(specs, ordered)):
            self._tell(line)
        return ordered

    def _show(
        self,
        label: str,
        results: Mapping[int, CaseResult],
        total: int,
        elapsed: float,
        left: float | None,
    ) -> None:
        failed = sum(result.status != "ok" for result in results.values())
        self._progress(Progress(label, len(results), total, failed, elapsed, left))

    def _results(
        self, specs: Sequence[CaseSpec], todo: Sequence[int]
    ) -> Iterator[tuple[int, CaseResult]]:
        """Yield results as they come; a run that was killed is tried once more, last."""
        queue = Queue(specs, todo, self.root, self._stored, self._held, self._tell)
        free = self._slots() if todo else []
        running: dict[Future[CaseResult], tuple[int, Submits]] = {}
        killed: set[int] = set()
        while queue.waiting or running:
            yield from queue.arrived()
            while free and (index := queue.next()) is not None:
                slot = free.pop()
                future = slot.submit(self._execute, specs[index], self.root)
                running[future] = (index, slot)
            if not running and queue.waiting:
                queue.idle()
            for future in wait(running, queue.patience_s, FIRST_COMPLETED).done:
                index, slot = running.pop(future)
                free.append(slot)
                result = self._outcome(future, specs[index])
                if result.failure == Failure.KILLED and index not in killed:
                    killed.add(index)
                    queue.waiting.append(index)
                    self._tell(f"{result.path}: {result.reason}; it is tried again")
                else:
                    stop_if_hopeless(result, self.root)
                    yield index, result

    def _slots(self) -> list[Submits]:
        if self._executor is not None:
            slots: list[Submits] = [self._executor]
            return slots * self.workers
        if self._pool is None:
            self._pool = WorkerPool(self.workers)
        return list(self._pool.workers)

    def _outcome(self, future: Future[CaseResult], spec: CaseSpec) -> CaseResult:
        try:
            return future.result()
        except CaseError:
            raise
        except BrokenExecutor:
            return died(spec, self.root)
        except Exception as err:
            raise (refusal(err, self.root) or report_bug(err, self.root)) from err


def run_table(specs: Sequence[CaseSpec], results: Sequence[CaseResult]) -> pd.DataFrame:
    """Return runs as a table: the specification, the outcome, then one column per observable.

    Parameters
    ----------
    specs, results : sequences of equal length
        Cases and their outcomes.

    Returns
    -------
    DataFrame
        Columns experiment, particle, surface, scale, seed, engine, the contact parameters, status
        ("ok" or "failed"), failure (class, see `liggghts_io.Failure`), reason, log_tail, wall_s,
        case_id, path, and the observables, nan where a run has none.
    """
    rows = [_row(spec, result) for spec, result in zip(specs, results, strict=True)]
    return pd.DataFrame(rows)


def _row(spec: CaseSpec, result: CaseResult) -> Mapping[str, object]:
    # In the experiment's order: a result that comes from its file has them sorted by name.
    names = [one.name for one in EXPERIMENTS[spec.experiment].observables]
    numbers = {name: result.observables[name] for name in names if name in result.observables}
    return {
        "experiment": spec.experiment,
        "particle": spec.particle.name,
        "surface": spec.surface,
        "scale": spec.scale,
        "seed": spec.seed,
        "engine": spec.engine,
        **spec.parameters,
        "status": result.status,
        "failure": str(result.failure),
        "reason": result.reason,
        "log_tail": result.log_tail,
        "wall_s": result.wall_s,
        "case_id": result.case_id,
        "path": str(result.path),
        **(numbers | dict(result.observables)),
    }
