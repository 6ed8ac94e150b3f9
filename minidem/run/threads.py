"""Threads that share the steps of one simulation.

The run loop cuts every step into as many pieces as there are threads, see
`minidem.kernels.step.team`. The threads of this module help with them; results do not depend on
whether they come to it, because the thread that runs the loop takes what is left.
"""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from minidem.kernels.machine.jit import FREE
from minidem.kernels.step.team import LINE, QUIT, sync_words
from minidem.kernels.tables import Team

__all__ = ["MOST", "Crew"]

MOST = 64
"""Largest number of threads."""


@dataclass
class Crew:
    """The helping threads of a run, and what they share.

    Attributes
    ----------
    threads : int
        Number of threads, that of the run loop included.
    """

    threads: int = 1
    _team: Team = field(default_factory=lambda: _team(1, 0, 0))
    _tasks: list[queue.SimpleQueue[Any]] = field(default_factory=list)

    def call(
        self, help_out: Callable[..., None] | None, tables: tuple[Any, ...],
        work: Callable[[Team], None],
    ) -> None:  # fmt: skip
        """Run the loop while helpers work on its pieces.

        Parameters
        ----------
        help_out : callable or None
            Kernel of a helper, None with one thread.
        tables : tuple
            Its arguments before the last: control, particles, two pair lists, two wall lists,
            meshes, posts, coefficients.
        work : callable
            Runs the loop, with the shared arrays as argument.
        """
        if help_out is None:
            work(self._team)
            return
        rows, meshes = len(tables[1].row), len(tables[4].load)
        if self._team.spill.shape[1] < rows or self._team.load.shape[1] != meshes:
            self._team = _team(self.threads, rows, meshes)
        # words of its own for every call: a helper that comes late finds nothing to do
        team = self._team._replace(sync=np.zeros(sync_words(self.threads), np.int64))
        if FREE:
            self._send((help_out, (*tables, team)))
        try:
            work(team)
        finally:
            team.sync[QUIT] = 1

    def _send(self, task: Any) -> None:
        """Give every helper a task; start the helpers at the first one."""
        if not self._tasks:
            task[1][-1].sync[QUIT] = 1  # loads the machine code, and compiles it once only
            task[0](*task[1])
            task[1][-1].sync[QUIT] = 0
            for _ in range(self.threads - 1):
                tasks: queue.SimpleQueue[Any] = queue.SimpleQueue()
                threading.Thread(target=_help, args=(tasks,), daemon=True).start()
                self._tasks.append(tasks)
        for tasks in self._tasks:
            tasks.put(task)

    def close(self) -> None:
        """Let the helpers end."""
        for tasks in self._tasks:
            tasks.put(None)
        self._tasks.clear()


def _help(tasks: queue.SimpleQueue[Any]) -> None:
    """Work on tasks until None comes."""
    while (task := tasks.get()) is not None:
        help_out, args = task
        if not args[-1].sync[QUIT]:
            help_out(*args)


def _team(threads: int, rows: int, meshes: int) -> Team:
    """Return the shared arrays for particles and meshes."""
    several = threads if threads > 1 else 0
    return Team(
        sync=np.zeros(sync_words(several), np.int64),
        bound=np.zeros(several + 1, np.int64),
        spill=np.zeros((several, rows, 8)),
        load=np.zeros((several, meshes, 8)),
        moved=np.zeros(LINE * several),
    )
