"""Threads that share the steps of one simulation.

The run loop cuts every step into as many pieces as there are threads, see
`minidem.kernels.step.team`. The threads of this module help with them; results do not depend on
whether they come to it, because the thread that runs the loop takes what is left.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from minidem.kernels.machine.cache import FREE
from minidem.kernels.scene import Tables
from minidem.kernels.step.team import LINE, QUIT, sync_words
from minidem.kernels.tables import Team
from minidem.record import field, record
from minidem.world.aligned import aligned_zeros

if TYPE_CHECKING:
    import queue

__all__ = ["MOST", "Crew"]

MOST = 64
"""Largest number of threads."""


@record
class Crew:
    """The helping threads of a run, and what they share.

    Attributes
    ----------
    threads : int
        Number of threads, that of the run loop included.
    team : Team
        What they share; made larger when it is too small.
    """

    threads: int = 1
    team: Team = field(default_factory=lambda: _team(1, 0, 0))
    _tasks: list[queue.SimpleQueue[Any]] = field(default_factory=list)

    def call(
        self, help_out: Callable[..., None] | None, advance: Callable[..., None], tables: Tables
    ) -> None:
        """Run the loop while helpers work on its pieces.

        Parameters
        ----------
        help_out : callable or None
            Kernel of a helper, None with one thread.
        advance : callable
            Kernel of the run loop.
        tables : Tables
            The argument of both, with the `team` of this crew.
        """
        if help_out is None:
            advance(tables)
            return
        rows, meshes = len(tables.parts.row), len(tables.first.walls.load)
        if self.team.spill.shape[1] < rows or self.team.load.shape[1] != meshes:
            self.team = _team(self.threads, rows, meshes)
        # words of its own for every call: a helper that comes late finds nothing to do
        sync = np.zeros(sync_words(self.threads), np.int64)
        tables = tables._replace(team=self.team._replace(sync=sync))
        if FREE:
            self._send(help_out, tables)
        try:
            advance(tables)
        finally:
            sync[QUIT] = 1

    def _send(self, help_out: Callable[..., None], tables: Tables) -> None:
        """Give every helper a task; start the helpers at the first one."""
        import queue  # few runs have helpers

        if not self._tasks:
            sync = tables.team.sync
            sync[QUIT] = 1  # loads the machine code, and compiles it once only
            help_out(tables)
            sync[QUIT] = 0
            for _ in range(self.threads - 1):
                tasks: queue.SimpleQueue[Any] = queue.SimpleQueue()
                threading.Thread(target=_help, args=(tasks,), daemon=True).start()
                self._tasks.append(tasks)
        for tasks in self._tasks:
            tasks.put((help_out, tables))

    def close(self) -> None:
        """Let the helpers end."""
        for tasks in self._tasks:
            tasks.put(None)
        self._tasks.clear()


def _help(tasks: queue.SimpleQueue[Any]) -> None:
    """Work on tasks until None comes."""
    while (task := tasks.get()) is not None:
        help_out, tables = task
        if not tables.team.sync[QUIT]:
            help_out(tables)


def _team(threads: int, rows: int, meshes: int) -> Team:
    """Return the shared arrays for particles and meshes."""
    several = threads if threads > 1 else 0
    return Team(
        sync=np.zeros(sync_words(several), np.int64),
        bound=np.zeros(several + 1, np.int64),
        spill=aligned_zeros((several, rows, 8)),
        load=np.zeros((several, meshes, 8)),
        moved=np.zeros(LINE * several),
    )
