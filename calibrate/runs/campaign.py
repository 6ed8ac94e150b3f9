"""Run many cases: in parallel, with progress, surviving failures, crashes and interruptions.

Every run is a case directory under one root, so a campaign has no state of its own: started again,
it finds the finished cases and runs the others. Any `concurrent.futures.Executor` will do, a
cluster's too; the default is a fresh process per core.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

import pandas as pd

from calibrate.runs.executors.workers import WorkerPool
from calibrate.runs.failures import failure_lines, stop_if_hopeless
from calibrate.runs.flight import Execute, Flight
from calibrate.runs.presence import Plan, present
from calibrate.runs.queue import Held, Queue, Stored, nothing
from liggghts_io import CaseResult, CaseSpec, Failure, experiment_of

__all__ = ["Campaign", "Progress", "ProgressCallback", "run_table"]


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
    """Runs cases under a root directory; an instance is a `Runner` and a context manager.

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
        Used instead of a pool of processes, for `workers` runs at once; its owner closes it.
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
        self._flight: Flight | None = None

    def __enter__(self) -> Campaign:
        """Return the campaign; leaving the block stops its workers and takes back its runs."""
        return self

    def __exit__(self, kind: type[BaseException] | None, *rest: object) -> None:
        """Stop the workers, at once when an error or Ctrl-C ends the block."""
        if self._flight is not None:
            self._flight.cancel()
            self._flight = None
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
            When the disk is full, since no run that follows could be stored, and when the executor
            takes no more runs.
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
        self._run(specs, todo, results, label)
        ordered = [results[i] for i in range(len(specs))]
        for line in failure_lines(run_table(specs, ordered)):
            self._tell(line)
        return ordered

    def _run(
        self,
        specs: Sequence[CaseSpec],
        todo: Sequence[int],
        results: dict[int, CaseResult],
        label: str,
    ) -> None:
        """Run what is missing and add it to the results, showing the progress."""
        started, reused = time.monotonic(), len(results)
        failed = sum(result.status != "ok" for result in results.values())
        total = len(specs)
        self._progress(Progress(label, reused, total, failed, 0.0, None if todo else 0.0))
        if not todo:
            return
        plan = Plan(label, total, reused, failed, reused, self.workers, time.time())
        with present(self.root, plan) as presence:
            for i, result in self._results(specs, todo):
                results[i] = result
                failed += result.status != "ok"
                elapsed, done = time.monotonic() - started, len(results)
                left = elapsed / (done - reused) * (total - done)
                self._progress(Progress(label, done, total, failed, elapsed, left))
                presence.update(done, failed)

    def _results(
        self, specs: Sequence[CaseSpec], todo: Sequence[int]
    ) -> Iterator[tuple[int, CaseResult]]:
        """Yield results as they come; a run that was killed is tried once more, last."""
        queue = Queue(specs, todo, self.root, self._stored, self._held, self._tell)
        flight = self._flight = self._new_flight()
        killed: set[int] = set()
        while queue.waiting or flight:
            yield from queue.arrived()
            while flight.free and (index := queue.next()) is not None:
                flight.start(index, specs[index])
            if not flight and queue.waiting:
                queue.idle()
            for index, result in flight.landed(specs, queue.patience_s):
                if result.failure == Failure.KILLED and index not in killed:
                    killed.add(index)
                    queue.waiting.append(index)
                    self._tell(f"{result.path}: {result.reason}; it is tried again")
                else:
                    stop_if_hopeless(result, self.root)
                    yield index, result

    def _new_flight(self) -> Flight:
        executor = self._executor
        if executor is None:
            executor = self._pool = self._pool or WorkerPool(self.workers)
        return Flight(
            executor, self._execute, self.root, self.workers, self._stored, self._held, self._tell
        )


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
    names = [one.name for one in experiment_of(spec).observables]
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
