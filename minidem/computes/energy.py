"""``compute ID GROUP ke``, ``ke/atom`` and ``erotate/sphere``: kinetic energies, J."""

from __future__ import annotations

from dataclasses import dataclass

from minidem.kernels.columns import MASS, OMEGA, RADIUS, VELOCITY
from minidem.world.compute import COMPUTES, Compute
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["ErotateSphere", "Kinetic", "KineticAtom"]


@COMPUTES.register("erotate/sphere")
@dataclass
class ErotateSphere(Compute):
    """Rotational kinetic energy."""

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return the sum of 0.5 * 0.4 m r2 w2."""
        del indices
        who = world.member(self.bit)
        row = world.state.row[: world.state.n][who]
        spin = world.state.spin[: world.state.n][who]
        inertia = 0.4 * row[:, MASS] * row[:, RADIUS] ** 2
        return float(0.5 * (inertia * (spin[:, OMEGA] ** 2).sum(axis=1)).sum())


@COMPUTES.register("ke")
@dataclass
class Kinetic(Compute):
    """Translational kinetic energy of the group."""

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return the sum of 0.5 m v2."""
        del indices
        row = world.state.row[: world.state.n][world.member(self.bit)]
        return float(0.5 * (row[:, MASS] * (row[:, VELOCITY] ** 2).sum(axis=1)).sum())


@COMPUTES.register("ke/atom")
@dataclass
class KineticAtom(Compute):
    """Translational kinetic energy per particle."""

    def per_atom(self, world: World, index: int) -> Floats:
        """Return 0.5 m v2 of particles in the group, 0 for others."""
        del index
        row = world.state.row[: world.state.n]
        found: Floats = 0.5 * row[:, MASS] * (row[:, VELOCITY] ** 2).sum(axis=1)
        return found * world.member(self.bit)
