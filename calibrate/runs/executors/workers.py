"""Worker processes that leave nobody behind, and of which each death costs one run only."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from functools import partial
from multiprocessing.process import BaseProcess
from typing import Any

from calibrate.runs.executors.sized import SizedExecutor

__all__ = ["Worker", "WorkerPool", "end_with_parent", "interrupts_later"]


class Worker:
    """One process that runs one case at a time.

    A pool of one process each, since a pool of several ends all of them when one dies: runs that
    did nothing wrong would be lost, and nobody could say which one was to blame.
    """

    def __init__(self) -> None:
        self._executor = _fresh()

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Start a call; a process that has died since its last one is replaced first.

        Parameters
        ----------
        function : callable
            Picklable, as are its arguments.
        *arguments : Any

        Returns
        -------
        Future
            Raises `BrokenProcessPool` when the process dies in this call.
        """
        with interrupts_later():
            try:
                return self._executor.submit(function, *arguments)
            except BrokenProcessPool:
                self._executor.shutdown(wait=False)
                self._executor = _fresh()
                return self._executor.submit(function, *arguments)

    def shutdown(self) -> None:
        """Wait for the call under way, then end the process."""
        self._executor.shutdown(wait=True, cancel_futures=True)


class WorkerPool(SizedExecutor):
    """Fresh processes for runs of an engine.

    Workers are spawned, not forked: they share no state with this process, and numba's threads do
    not survive a fork. They leave Ctrl-C to the parent and end when the parent is gone, even when
    it was killed.

    Parameters
    ----------
    workers : int
        Number of processes.
    """

    def __init__(self, workers: int) -> None:
        self._others = set(multiprocessing.active_children())
        self._processes = [Worker() for _ in range(workers)]
        self._calls: dict[Worker, set[Future[Any]]] = {one: set() for one in self._processes}

    @property
    def workers(self) -> int:
        """How many runs it takes at once."""
        return len(self._processes)

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Start a call in the process that has least to do.

        Parameters
        ----------
        fn : callable
            Picklable, as are its arguments.
        *args, **kwargs : Any

        Returns
        -------
        Future
            Raises `BrokenProcessPool` when the process dies in this call.
        """
        least = min(self._processes, key=self._load)
        future = least.submit(partial(fn, **kwargs) if kwargs else fn, *args)
        self._calls[least].add(future)
        return future

    def _load(self, worker: Worker) -> int:
        """Return how many calls a process has before it."""
        self._calls[worker] = {one for one in self._calls[worker] if not one.done()}
        return len(self._calls[worker])

    def close(self, *, at_once: bool) -> None:
        """Stop the workers; `at_once` stops runs under way, whose cases count as not done."""
        if at_once:
            for child in set(multiprocessing.active_children()) - self._others:
                child.kill()  # a stopped process would not see SIGTERM
        for worker in self._processes:
            worker.shutdown()


def _fresh() -> ProcessPoolExecutor:
    context = multiprocessing.get_context("spawn")
    return ProcessPoolExecutor(1, mp_context=context, initializer=_prepare)


@contextlib.contextmanager
def interrupts_later() -> Iterator[None]:
    """Hold Ctrl-C back while a process or thread is started, which inherits that for good.

    A worker that is still importing would otherwise answer Ctrl-C with a traceback.
    """
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _prepare() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    end_with_parent()


def end_with_parent() -> None:
    """Let this process end when the one that started it is gone, even when that was killed."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_end_with, args=(parent,), daemon=True).start()


def _end_with(parent: BaseProcess) -> None:
    parent.join()
    os._exit(1)
