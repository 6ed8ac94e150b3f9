"""``compute ID GROUP toy/speed``: ``c_ID`` is the largest speed, and the speed of each particle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from minidem.world.compute import COMPUTES, Compute
from minidem.world.state import Floats
from minidem.world.world import World


@COMPUTES.register("toy/speed")
@dataclass
class Speed(Compute):
    """Speed in m/s."""

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return the largest speed of the group."""
        return float(self.per_atom(world, 0).max(initial=0.0))

    def per_atom(self, world: World, index: int) -> Floats:
        """Return the speed of each particle of the group, 0 for the others."""
        velocity = world.state.row[: world.state.n, 4:7]
        return np.sqrt((velocity**2).sum(axis=1)) * world.member(self.bit)
