"""Run many cases: in parallel, with progress, surviving failures, crashes and interruptions.

Every run is a case directory under one root, so a campaign has no state of its own: started again,
it finds the finished cases and runs the others. Any `concurrent.futures.Executor` will do, a
cluster's too; the default is a pool of fresh processes, one per core.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

import pandas as pd

from calibrate.runs.workers import WorkerPool
from liggghts_io import CaseError, CaseResult, CaseSpec

__all__ = ["Campaign", "Progress", "ProgressCallback", "run_table"]

Execute: TypeAlias = Callable[[CaseSpec, Path], CaseResult]
Stored: TypeAlias = Callable[[CaseSpec, Path], CaseResult | None]


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


def _silent(progress: Progress) -> None:
    del progress


class Campaign:
    """Runs cases under a root directory; an instance is a `plan.Runner` and a context manager.

    Parameters
    ----------
    root : Path
        Case directories are made here; nothing is ever deleted.
    execute : callable
        `liggghts_io.execute` or a stand-in of the same interface; must be picklable.
    stored : callable, optional
        Returns the stored result of a case or None, so that finished cases need no worker.
    workers : int
        Processes, 0 for one per core.
    progress : callable
        Called with a `Progress` after each finished run.
    executor : Executor, optional
        Used instead of a pool of processes; its owner closes it.
    """

    def __init__(
        self,
        root: Path,
        execute: Execute,
        *,
        stored: Stored | None = None,
        workers: int = 0,
        progress: ProgressCallback = _silent,
        executor: Executor | None = None,
    ) -> None:
        self.root = root
        self.workers = workers or os.cpu_count() or 1
        self._execute = execute
        self._stored = stored
        self._progress = progress
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
        """Run `specs` and return one row per case, in their order.

        Parameters
        ----------
        specs : sequence of CaseSpec
            What to run; a case that is stored already is not run again.
        label : str
            Shown with the progress.

        Returns
        -------
        DataFrame
            See `run_table`.

        Raises
        ------
        CaseError
            When a specification is impossible or the engine is missing, at once: that is a
            mistake in the input, not a failed run.
        KeyboardInterrupt
            Passed on; finished cases are kept and the next call continues.
        """
        self.root.mkdir(parents=True, exist_ok=True)
        results: dict[int, CaseResult] = {}
        for i, spec in enumerate(specs):
            result = self._stored(spec, self.root) if self._stored else None
            if result is not None:
                results[i] = result
        todo = [i for i in range(len(specs)) if i not in results]
        started, reused = time.monotonic(), len(results)
        self._tell(label, results, len(specs), 0.0, None if todo else 0.0)
        for i, result in self._results(specs, todo):
            results[i] = result
            elapsed = time.monotonic() - started
            fresh = len(results) - reused
            left = elapsed / fresh * (len(specs) - len(results))
            self._tell(label, results, len(specs), elapsed, left)
        return run_table(specs, [results[i] for i in range(len(specs))])

    def _tell(
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
        self, specs: Sequence[CaseSpec], todo: list[int]
    ) -> Iterator[tuple[int, CaseResult]]:
        if self._executor is not None:
            yield from self._drain(self._executor, specs, todo)
            return
        while todo:
            if self._pool is None:
                self._pool = WorkerPool(self.workers)
            yield from self._drain(self._pool.executor, specs, todo)
            if todo:  # the pool broke; the runs that were under way come first in `todo`
                self._pool.close(at_once=True)
                self._pool = None
                for index in todo[: self.workers]:
                    yield index, self._alone(specs[index])
                del todo[: self.workers]

    def _drain(
        self, pool: Executor, specs: Sequence[CaseSpec], todo: list[int]
    ) -> Iterator[tuple[int, CaseResult]]:
        """Yield results and take them off `todo`; stop early when the pool breaks.

        Only as many runs as workers are handed out at a time, so that a broken pool leaves few
        suspects.
        """
        running: dict[Future[CaseResult], int] = {}
        waiting = list(todo)
        try:
            while waiting or running:
                while waiting and len(running) < self.workers:
                    index = waiting.pop(0)
                    running[pool.submit(self._execute, specs[index], self.root)] = index
                for future in wait(running, return_when=FIRST_COMPLETED).done:
                    result = _outcome(future, specs[running[future]], self.root)
                    index = running.pop(future)
                    todo.remove(index)
                    yield index, result
        except BrokenProcessPool:
            suspects = sorted(running.values())
            todo[:] = suspects + [i for i in todo if i not in suspects]

    def _alone(self, spec: CaseSpec) -> CaseResult:
        """Run a suspect in a pool of its own; if that breaks too, the case is to blame."""
        pool = WorkerPool(1)
        try:
            return _outcome(pool.executor.submit(self._execute, spec, self.root), spec, self.root)
        except BrokenProcessPool:
            reason = "the worker process died twice in this run (killed, or out of memory)"
            return CaseResult("", self.root, "failed", reason, {}, 0.0)
        finally:
            pool.close(at_once=False)


def _outcome(future: Future[CaseResult], spec: CaseSpec, root: Path) -> CaseResult:
    try:
        return future.result()
    except (BrokenProcessPool, CaseError):
        raise
    except Exception as err:
        reason = f"{type(err).__name__}: {err} (in {spec.experiment} on {spec.surface})"
        return CaseResult("", root, "failed", reason, {}, 0.0)


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
        ("ok" or "failed"), reason, wall_s, case_id, path, and the observables, nan where a run
        has none.
    """
    rows = [_row(spec, result) for spec, result in zip(specs, results, strict=True)]
    return pd.DataFrame(rows)


def _row(spec: CaseSpec, result: CaseResult) -> Mapping[str, object]:
    return {
        "experiment": spec.experiment,
        "particle": spec.particle.name,
        "surface": spec.surface,
        "scale": spec.scale,
        "seed": spec.seed,
        "engine": spec.engine,
        **spec.parameters,
        "status": result.status,
        "reason": result.reason,
        "wall_s": result.wall_s,
        "case_id": result.case_id,
        "path": str(result.path),
        **result.observables,
    }
