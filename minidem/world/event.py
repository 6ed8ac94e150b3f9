"""What happens at the end of certain steps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, Protocol

from minidem.world.world import World

__all__ = ["NEVER", "Event", "Periodic", "next_multiple"]

NEVER: Final = 2**62
"""A step that no run reaches."""


class Event(Protocol):
    """Something that happens at the end of certain steps: output, checks."""

    def next_step(self, step: int) -> int:
        """Return the first step after `step` at which it happens, `NEVER` for none."""

    def act(self, world: World) -> None:
        """Do it, at the end of the present step."""


def next_multiple(step: int, every: int) -> int:
    """Return the first multiple of `every` after a step."""
    return (step // every + 1) * every


@dataclass(frozen=True)
class Periodic:
    """A call every so many steps.

    Attributes
    ----------
    every : int
        Interval in steps.
    call : callable
        What is called.
    """

    every: int
    call: Callable[[], None]

    def next_step(self, step: int) -> int:
        """Return the next multiple of the interval."""
        return next_multiple(step, self.every)

    def act(self, world: World) -> None:
        """Make the call."""
        del world
        self.call()
