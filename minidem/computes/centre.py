"""``compute ID GROUP com``: centre of mass, m."""

from __future__ import annotations

from dataclasses import dataclass

from minidem.kernels.columns import MASS, X
from minidem.world.compute import COMPUTES, Compute
from minidem.world.world import World

__all__ = ["Centre"]


@COMPUTES.register("com")
@dataclass
class Centre(Compute):
    """Centre of mass of the group."""

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return one coordinate, index from 1."""
        if len(indices) != 1 or not 1 <= indices[0] <= len("xyz"):
            return super().value(world, indices)
        row = world.state.row[: world.state.n][world.member(self.bit)]
        if not len(row):
            return 0.0
        axis = indices[0] - 1
        return float((row[:, MASS] * row[:, X + axis]).sum() / row[:, MASS].sum())
