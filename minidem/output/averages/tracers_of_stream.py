"""``fix property/atom/tracer/stream``: the first particles of a stream behind a step."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from minidem.errors import InputError
from minidem.fixes.insert import Insert
from minidem.output.averages.tracers import Marks
from minidem.record import record
from minidem.registry import Head
from minidem.words import Words, one_of
from minidem.world.fix import FIXES
from minidem.world.state import Ints
from minidem.world.values.by_id import ById
from minidem.world.values.named import need_map
from minidem.world.world import World

__all__ = ["StreamTracer"]

_KEYS: Final = ("mark_step", "insert_stream", "n_tracer", "every")
_USAGE: Final = (
    "fix ID GROUP property/atom/tracer/stream mark_step S n_tracer N insert_stream ID every E"
)
_STREAM: Final = "insert/stream"


@FIXES.register("property/atom/tracer/stream")
@record
class StreamTracer(Marks):
    """Marks the first particles of a stream that pass its face from a step on.

    They are marked where they are put in, by the step at which they will pass. As in LIGGGHTS the
    next ones are sought in the same packet only if their step comes before the next packet.

    Attributes
    ----------
    stream : str
        The fix that inserts.
    first : int
        Step from which on particles are marked.
    number : int
        How many are marked.
    every : int
        Steps until as many are marked again; 0 for once.
    left : int
        How many are still to be marked.
    """

    stream: str = ""
    first: int = 0
    number: int = 0
    every: int = 0
    left: int = 0

    def check(self, world: World) -> None:
        """Refuse a run in which LIGGGHTS could not find the particles."""
        super().check(world)
        need_map(world, f"fix {self.style}")

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> StreamTracer:
        """Read which particles are marked."""
        words.need(2 * len(_KEYS), _USAGE)
        made = cls(*head, ById((0.0,)))
        given = set()
        while not words.done():
            key = words.choice(_KEYS)
            given.add(key)
            if key == "mark_step":
                made.first = words.interval(least=0)
            elif key == "n_tracer":
                made.left = made.number = words.interval(least=0)
            elif key == "insert_stream":
                made.stream = _stream(world, words.take("a fix"))
            elif words.peek() == "once":
                words.expect("once")
            else:
                made.every = words.interval()
        for key in _KEYS:
            if key not in given:
                msg = f"fix {head.style}: expected '{key}'"
                raise InputError(msg)
        return made

    def particles_inserted(
        self, world: World, insert: str, rows: slice, passes: Ints, following: int
    ) -> None:
        """Mark those of a packet that are the first to pass."""
        if insert != self.stream:
            return
        order = np.argsort(passes, kind="stable")
        order = order[world.member(self.bit)[rows][order]]
        steps, at, new = passes[order], 0, []
        while not self._is_over():
            at = max(at, int(np.searchsorted(steps, self.first)))
            taken = order[at : at + self.left]
            new += taken.tolist()
            at += len(taken)
            self.left -= len(taken)
            if self.left or not self.every:
                break
            self.first += self.every
            self.left = self.number
            if self.first >= following:
                break
        self.mark(world, rows.start + np.array(new, np.int64))

    def _is_over(self) -> bool:
        return self.left == 0 and not self.every

    def state(self) -> dict[str, Any]:
        """Return the marks, and what is still to be marked."""
        return super().state() | {"first": self.first, "left": self.left}

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Take the marks from a restart file."""
        super().restore(saved)
        self.first = int(saved.get("first", self.first))
        self.left = int(saved.get("left", self.left))


def _stream(world: World, name: str) -> str:
    """Return the name of a fix that inserts a stream."""
    streams = [fix.name for fix in world.of_kind(Insert) if fix.style == _STREAM]
    if not streams:
        msg = f"insert_stream {name[:40]}: no fix {_STREAM} stands above it"
        raise InputError(msg)
    return one_of(name, streams, f"fix {_STREAM}")
