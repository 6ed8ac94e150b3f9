"""``fix ID GROUP toy/spring K X Y Z``: a spring of stiffness K, N/m, from each particle to a point.

``f_ID[1]`` is the elastic energy, J, ``f_ID[2]`` the number of steps that the spring has acted.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from minidem.fixes.forces.body import BodyForce
from minidem.registry import Head
from minidem.words import Words
from minidem.world.fix import FIXES
from minidem.world.state import Floats
from minidem.world.world import World


@FIXES.register("toy/spring")
@dataclass(kw_only=True)
class Spring(BodyForce):
    """A spring to a point."""

    stiffness: float
    point: Floats
    steps: int = 0

    # the words of the script

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Spring:
        """Read stiffness and point."""
        words.need(4, "fix ID GROUP toy/spring K X Y Z")
        return cls(*head, stiffness=words.positive(), point=np.array(words.numbers(3)))

    # in every step, after the contacts

    def apply(self, world: World) -> None:
        """Pull the particles of the group to the point."""
        who, state = self.affected(world), world.state
        state.force[who, :3] -= self.stiffness * (state.row[who, :3] - self.point)

    # at the end of every step

    def next_step(self, step: int) -> int:
        """Act after each step."""
        return step + 1

    def act(self, world: World) -> None:
        """Count."""
        self.steps += 1

    # what the script may ask: f_ID[1], f_ID[2]

    def value(self, world: World, index: int) -> float:
        """Return energy or steps."""
        if index == 1:
            away = world.state.row[self.affected(world), :3] - self.point
            return float(0.5 * self.stiffness * (away**2).sum())
        if index == 2:
            return float(self.steps)
        return super().value(world, index)

    # what a restart file keeps

    def state(self) -> dict[str, Any]:
        """Return the counter."""
        return {"steps": self.steps}

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Take the counter."""
        self.steps = int(saved["steps"])

    # unfix

    def remove(self, world: World) -> None:
        """Say goodbye."""
        world.log(f"spring {self.name} lets go after {self.steps} steps")
