"""``fix ID GROUP momentum N linear X Y Z angular``: takes drift and turning away."""

from __future__ import annotations

import numpy as np

from minidem.errors import InputError, NoParticlesError
from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.fix import FIXES, Fix
from minidem.world.momentum import group_mass, remove_drift, remove_turning
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["Momentum"]


@FIXES.register("momentum")
@record
class Momentum(Fix):
    """The motion of a group as a whole is taken away every some steps.

    Attributes
    ----------
    every : int
        Steps.
    axes : ndarray, shape (3,)
        1 for directions in which the drift is taken away, else 0.
    angular : bool
        Whether turning is taken away.
    mass : float
        Of the group at the start of the run, kg.
    """

    every: int = 1
    axes: Floats = field(default_factory=lambda: np.zeros(3))
    angular: bool = False
    mass: float = 0.0

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Momentum:
        """Read the interval, ``linear X Y Z`` and ``angular``."""
        words.need(1, "fix ID GROUP momentum N linear 1 1 1 angular")
        made = cls(*head, words.interval())
        if words.done():
            msg = "fix momentum: give 'linear X Y Z' with 0 or 1, 'angular', or both"
            raise InputError(msg)
        while not words.done():
            if words.choice(("linear", "angular")) == "angular":
                made.angular = True
            else:
                made.axes = np.array([float(words.choice(("0", "1"))) for _ in range(3)])
        if not world.member(made.bit).any():
            msg = "Fix momentum group has no atoms; put it behind the commands that make them"
            raise NoParticlesError(msg)
        return made

    def setup(self, world: World) -> None:
        """Weigh the group; as in LIGGGHTS particles that come in the run are not weighed."""
        self.mass = group_mass(world, self.bit)

    def next_step(self, step: int) -> int:
        """Return the next multiple of the interval."""
        return (step // self.every + 1) * self.every

    def act(self, world: World) -> None:
        """Take the motion away."""
        if self.axes.any():
            remove_drift(world, self.bit, self.mass, self.axes)
        if self.angular:
            remove_turning(world, self.bit, self.mass)
