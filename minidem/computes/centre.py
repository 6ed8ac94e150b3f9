"""``compute ID GROUP com`` and ``gyration``: where the group is, m."""

from __future__ import annotations

from typing import Final

import numpy as np

from minidem.kernels.columns import MASS, X, Y, Z
from minidem.world.compute import COMPUTES, Compute
from minidem.world.momentum import centre_of_mass
from minidem.world.world import World

__all__ = ["Centre", "Gyration"]

_PAIRS: Final = ((X, X), (Y, Y), (Z, Z), (X, Y), (X, Z), (Y, Z))


@COMPUTES.register("com")
class Centre(Compute):
    """Centre of mass of the group."""

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return one coordinate, index from 1."""
        if len(indices) != 1 or not 1 <= indices[0] <= len("xyz"):
            return super().value(world, indices)
        member = world.member(self.bit)
        weight = world.state.row[: world.state.n][member][:, [MASS]]
        return float(centre_of_mass(weight, world.unwrapped()[member])[indices[0] - 1])


@COMPUTES.register("gyration")
class Gyration(Compute):
    """Radius of gyration of the group, m, and its squared tensor, m2."""

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return the radius, or a component xx, yy, zz, xy, xz, yz, from 1."""
        member = world.member(self.bit)
        mass = world.state.row[: world.state.n, MASS][member]
        at = world.unwrapped()[member]
        if not len(mass):
            return 0.0
        apart = at - (mass[:, None] * at).sum(axis=0) / mass.sum()
        if not indices:
            return float(np.sqrt((mass * (apart**2).sum(axis=1)).sum() / mass.sum()))
        if len(indices) > 1 or indices[0] > len(_PAIRS):
            return super().value(world, indices)
        a, b = _PAIRS[indices[0] - 1]
        return float((mass * apart[:, a] * apart[:, b]).sum() / mass.sum())
