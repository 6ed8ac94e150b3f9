"""What happens at the end of certain steps."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, Protocol

from minidem.record import record
from minidem.world.settings import Schedule
from minidem.world.world import World

__all__ = ["NEVER", "Event", "Scheduled", "next_multiple"]

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


@record(frozen=True)
class Scheduled:
    """A call at the steps of a schedule.

    Attributes
    ----------
    schedule : Schedule
        When.
    what : str
        The command that says when, for messages.
    call : callable
        What is called.
    """

    schedule: Schedule
    what: str
    call: Callable[[], None]

    def plan(self, world: World) -> None:
        """Find out when the next call is, if a variable says so."""
        self.schedule.plan(world.interpreter.value, world.step, self.what)

    def next_step(self, step: int) -> int:
        """Return the step of the next call."""
        return self.schedule.next_step(step)

    def act(self, world: World) -> None:
        """Make the call."""
        self.call()
        self.plan(world)
