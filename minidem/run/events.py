"""What happens at the end of certain steps."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from minidem.fixes.body import CheckTimestep
from minidem.fixes.check_timestep import critical_fractions
from minidem.run.restart import write_restart
from minidem.script import inside
from minidem.world.world import World

if TYPE_CHECKING:
    from minidem.run.engine import Engine

__all__ = ["Event", "RestartEvent", "ThermoEvent", "check_events"]


class Event(Protocol):
    """Something that happens at the end of certain steps: output, checks."""

    def next_step(self, step: int) -> int:
        """Return the first step after `step` at which it happens."""

    def act(self, world: World, step: int) -> None:
        """Do it."""


@dataclass
class ThermoEvent:
    """A line of thermo output."""

    engine: Engine

    def next_step(self, step: int) -> int:
        """Return the next multiple of the thermo interval."""
        every = self.engine.world.thermo.every
        return (step // every + 1) * every

    def act(self, world: World, step: int) -> None:
        """Write a line."""
        del world, step
        self.engine.thermo_line()


@dataclass
class RestartEvent:
    """A restart file."""

    engine: Engine
    every: int
    path: str

    def next_step(self, step: int) -> int:
        """Return the next multiple of the interval."""
        return (step // self.every + 1) * self.every

    def act(self, world: World, step: int) -> None:
        """Write a restart file."""
        write_restart(self.engine, inside(world.root, self.path.replace("*", str(step), 1)))


def check_events(world: World) -> list[Event]:
    """Return the end-of-step events of check/timestep/gran fixes."""
    return [_Check(fix) for fix in world.of_kind(CheckTimestep)]


@dataclass
class _Check:
    fix: CheckTimestep

    def next_step(self, step: int) -> int:
        """Return the next multiple of its interval."""
        return (step // self.fix.every + 1) * self.fix.every

    def act(self, world: World, step: int) -> None:
        """Compare the time step with the critical ones."""
        del step
        self.fix.values = critical_fractions(world)
