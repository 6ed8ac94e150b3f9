"""Runs that wait for a worker, or for another campaign that is at them already."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TypeAlias

from liggghts_io import CaseResult, CaseSpec

__all__ = ["POLL_S", "Held", "Queue", "Stored", "nothing"]

Stored: TypeAlias = Callable[[CaseSpec, Path], CaseResult | None]
Held: TypeAlias = Callable[[CaseSpec, Path], str | None]

POLL_S = 0.1
"""How often cases that others hold are looked at [s]; small beside any run."""
_QUIET_S = 1.0
"""So long nothing is said about waiting [s]."""


def nothing(_spec: CaseSpec, _root: Path) -> None:
    """Return None: no result is stored, nobody holds the case."""


class Queue:
    """Runs that wait.

    Parameters
    ----------
    specs : sequence of CaseSpec
    waiting : sequence of int
        Which of them have no result yet.
    root : Path
    stored, held : callable
        As `Campaign` takes them.
    tell : callable
        Receives a line when there is nothing to do but wait.
    """

    def __init__(
        self,
        specs: Sequence[CaseSpec],
        waiting: Sequence[int],
        root: Path,
        stored: Stored,
        held: Held,
        tell: Callable[[str], None],
    ) -> None:
        self.waiting = list(waiting)
        self._specs = specs
        self._root = root
        self._stored, self._held, self._tell = stored, held, tell
        self._holders: dict[int, str] = {}
        self._idle_since: float | None = None
        self._told: set[str] = set()

    def next(self) -> int | None:
        """Take the first run that nobody else is at; None when there is none."""
        for index in self.waiting:
            holder = self._held(self._specs[index], self._root)
            if holder is None:
                self.waiting.remove(index)
                self._holders.pop(index, None)
                self._idle_since = None
                return index
            self._holders[index] = holder
        return None

    def arrived(self) -> Iterator[tuple[int, CaseResult]]:
        """Take the runs that others have finished, with their results."""
        for index in list(self._holders):
            result = self._stored(self._specs[index], self._root)
            if result is not None:
                self.waiting.remove(index)
                del self._holders[index]
                self._idle_since = None
                yield index, result

    @property
    def patience_s(self) -> float | None:
        """How long to wait for a worker before looking here again; None: until one is done."""
        return POLL_S if self._holders else None

    def idle(self) -> None:
        """Wait a moment for the others, and say for whom when it takes long."""
        now = time.monotonic()
        self._idle_since = self._idle_since or now
        if now - self._idle_since > _QUIET_S:
            for holder in sorted(set(self._holders.values()) - self._told):
                self._tell(f"waiting for {holder}")
                self._told.add(holder)
        time.sleep(POLL_S)
