"""``fix adapt``: particle diameters that follow a script variable while the simulation runs."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from minidem.fixes.body import Adapt
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["Adapter"]

_NEVER = 2**62


@dataclass
class Adapter:
    """Changes diameters between the move and the forces of a step, as LIGGGHTS does.

    Attributes
    ----------
    world : World
        The simulation.
    held : ndarray
        Radius of each particle when the lists were made, by id, m.
    """

    world: World
    held: Floats = field(default_factory=lambda: np.zeros(0))

    @property
    def active(self) -> bool:
        """Whether there is a ``fix adapt``."""
        return bool(self.world.of_kind(Adapt))

    def next_step(self, step: int) -> int:
        """Return the first step after `step` at which diameters change."""
        steps = [(step // fix.every + 1) * fix.every for fix in self._fixes() if fix.every > 0]
        return min(steps, default=_NEVER)

    def _fixes(self) -> list[Adapt]:
        found: list[Adapt] = self.world.of_kind(Adapt)
        return found

    def hold(self) -> None:
        """Remember the radii that the lists are made for."""
        if self.active:
            state = self.world.state
            self.held = np.zeros(state.top_id + 1)
            self.held[state.ids[: state.n]] = state.row[: state.n, 3]

    def apply(self, *, setup: bool) -> None:
        """Set the diameters that are due in this step; densities are kept."""
        for fix in self._fixes():
            if setup or (fix.every > 0 and self.world.step % fix.every == 0):
                self._change(fix)

    def _change(self, fix: Adapt) -> None:
        world, state = self.world, self.world.state
        who = np.flatnonzero(world.member(fix.bit))
        radius = 0.5 * world.interpreter.atom_values(fix.variable)[who]
        if not (np.isfinite(radius).all() and (radius > 0.0).all()):
            worst = radius[~(np.isfinite(radius) & (radius > 0.0))][0]
            msg = (
                f"fix adapt {fix.name}: variable {fix.variable} gives a diameter of "
                f"{2.0 * worst:g} m at step {world.step}; it must be above zero"
            )
            raise ValueError(msg)
        row = state.row
        old = row[who, 3]
        density = row[who, 7] / (4.0 * np.pi / 3.0 * old * old * old)
        row[who, 3] = radius
        row[who, 7] = 4.0 * np.pi / 3.0 * radius * radius * radius * density
        # the half kicks use dt/2m and dt/2I, kept beside the force
        half = 0.5 * world.dt
        state.force[who, 6] = half / row[who, 7]
        state.force[who, 7] = half / 0.4 / (radius * radius * row[who, 7])

    def limits(self) -> Floats:
        """Return how far each particle may move before new lists are needed, squared, m2.

        Half a skin, less what its radius has grown; negative if it has grown by more than that.
        """
        state = self.world.state
        reach = 0.5 * self.world.neighbor.skin
        grown = state.row[: state.n, 3] - self.held[state.ids[: state.n]]
        return np.where(np.abs(grown) > reach, -1.0, (reach - grown) ** 2)

    def lists_hold(self) -> bool:
        """Return True if no particle has moved or grown too far for the lists."""
        state = self.world.state
        moved = ((state.row[: state.n, :3] - state.held[: state.n]) ** 2).sum(axis=1)
        return bool((moved <= self.limits()).all())
