"""``fix ID GROUP adapt N atom diameter v_NAME``: diameters that follow a script variable.

They change between the move and the forces of a step, as in LIGGGHTS.
"""

from __future__ import annotations

import numpy as np

from minidem.errors import InputError
from minidem.fixes.integrate import group_bits
from minidem.kernels.columns import HALF_KICK, HALF_TURN, MASS, POSITION, RADIUS
from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.event import NEVER, next_multiple
from minidem.world.fix import FIXES, Fix
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["Adapt", "Adapter"]


@FIXES.register("adapt")
@record
class Adapt(Fix):
    """Diameters of a group.

    Attributes
    ----------
    every : int
        Interval in steps, 0: at the start of a run.
    variable : str
        Atom-style variable that gives the diameters, m.
    """

    every: int
    variable: str

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Adapt:
        """Read interval and variable."""
        del world
        words.need(4, "fix ID GROUP adapt N atom diameter v_NAME")
        every = words.interval(least=0)
        words.choice(("atom",), "target")
        words.choice(("diameter",), "quantity")
        made = cls(*head, every, words.variable())
        while not words.done():
            words.choice(("reset", "scale"))
            words.yes_no()  # they concern pair coefficients only
        return made

    def variables_asked(self) -> tuple[str, ...]:
        """Return the names of the variables that it asks in a run."""
        return (self.variable,)

    def due(self, step: int) -> bool:
        """Return True if diameters change in a step of a run."""
        return self.every > 0 and step % self.every == 0

    def change(self, world: World) -> None:
        """Set the diameters; densities are kept.

        Raises
        ------
        InputError
            If a diameter is not above zero.
        """
        state = world.state
        who = np.flatnonzero(world.member(self.bit))
        radius = 0.5 * world.interpreter.atom_values(self.variable)[who]
        if not (np.isfinite(radius).all() and (radius > 0.0).all()):
            worst = radius[~(np.isfinite(radius) & (radius > 0.0))][0]
            msg = (
                f"fix adapt {self.name}: variable {self.variable} gives a diameter of "
                f"{2.0 * worst:g} m at step {world.step}; it must be above zero"
            )
            raise InputError(msg)
        row = state.row
        old = row[who, RADIUS]
        density = row[who, MASS] / (4.0 * np.pi / 3.0 * old * old * old)
        row[who, RADIUS] = radius
        row[who, MASS] = 4.0 * np.pi / 3.0 * radius * radius * radius * density
        # the half kicks use dt/2m and dt/2I, kept beside the force
        half = 0.5 * world.dt
        state.force[who, HALF_KICK] = half / row[who, MASS]
        state.force[who, HALF_TURN] = half / 0.4 / (radius * radius * row[who, MASS])
        unforced, unturned, _ = group_bits(world)
        state.force[: state.n][world.member(unforced), HALF_KICK] = 0.0
        state.force[: state.n][world.member(unturned), HALF_TURN] = 0.0


@record
class Adapter:
    """What all ``fix adapt`` of a world mean for the run loop.

    Attributes
    ----------
    world : World
        The simulation.
    held : ndarray
        Radius of each particle when the lists were made, by id, m.
    active : bool
        Whether there is a ``fix adapt``.
    """

    world: World
    held: Floats = field(default_factory=lambda: np.zeros(0))
    active: bool = field(init=False)

    def __post_init__(self) -> None:
        """Look whether there is something to do."""
        self.active = bool(self.world.of_kind(Adapt))

    def next_step(self, step: int) -> int:
        """Return the first step after `step` at which diameters change."""
        fixes = [fix for fix in self.world.of_kind(Adapt) if fix.every > 0]
        return min((next_multiple(step, fix.every) for fix in fixes), default=NEVER)

    def hold(self) -> None:
        """Remember the radii that the lists are made for."""
        if self.active:
            state = self.world.state
            self.held = np.zeros(state.top_id + 1)
            self.held[state.ids[: state.n]] = state.row[: state.n, RADIUS]

    def apply(self, *, setup: bool) -> None:
        """Set the diameters that are due in this step; densities are kept."""
        for fix in self.world.of_kind(Adapt):
            if setup or fix.due(self.world.step):
                fix.change(self.world)

    def limits(self) -> Floats:
        """Return how far each particle may move before new lists are needed, squared, m2.

        Half a skin, less what its radius has grown; negative if it has grown by more than that.
        """
        state = self.world.state
        reach = 0.5 * self.world.neighbor.skin
        grown = state.row[: state.n, RADIUS] - self.held[state.ids[: state.n]]
        return np.where(np.abs(grown) > reach, -1.0, (reach - grown) ** 2)

    def lists_hold(self) -> bool:
        """Return True if no particle has moved or grown too far for the lists."""
        state = self.world.state
        moved = ((state.row[: state.n, POSITION] - state.held[: state.n]) ** 2).sum(axis=1)
        return bool((moved <= self.limits()).all())
