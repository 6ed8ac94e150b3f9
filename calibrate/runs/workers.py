"""A pool of worker processes that leaves no process behind, whatever happens."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from concurrent.futures import ProcessPoolExecutor
from multiprocessing.process import BaseProcess

__all__ = ["WorkerPool"]


class WorkerPool:
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
        context = multiprocessing.get_context("spawn")
        self.executor = ProcessPoolExecutor(workers, mp_context=context, initializer=_prepare)

    def close(self, *, at_once: bool) -> None:
        """Stop the workers.

        Parameters
        ----------
        at_once : bool
            Stop runs under way as well; their cases simply count as not done.
        """
        if at_once:
            for child in set(multiprocessing.active_children()) - self._others:
                child.terminate()
        self.executor.shutdown(wait=True, cancel_futures=True)


def _prepare() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_end_with, args=(parent,), daemon=True).start()


def _end_with(parent: BaseProcess) -> None:
    parent.join()
    os._exit(1)
