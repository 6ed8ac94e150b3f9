"""``compute ID GROUP ke``, ``ke/atom``, ``erotate/sphere``, ``erotate/sphere/atom``, ``pe``, J."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from minidem.kernels.columns import MASS, OMEGA, RADIUS, VELOCITY
from minidem.registry import Head
from minidem.words import Words
from minidem.world.compute import COMPUTES, Compute
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["ErotateAtom", "ErotateSphere", "Kinetic", "KineticAtom", "Potential"]


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


@COMPUTES.register("erotate/sphere/atom")
@dataclass
class ErotateAtom(Compute):
    """Rotational kinetic energy per particle."""

    def per_atom(self, world: World, index: int) -> Floats:
        """Return 0.5 * 0.4 m r2 w2 of particles in the group, 0 for others."""
        del index
        row, spin = world.state.row[: world.state.n], world.state.spin[: world.state.n]
        found: Floats = 0.2 * row[:, MASS] * row[:, RADIUS] ** 2 * (spin[:, OMEGA] ** 2).sum(axis=1)
        return found * world.member(self.bit)


@COMPUTES.register("pe", "pe/atom")
@dataclass
class Potential(Compute):
    """Potential energy: none, since LIGGGHTS keeps none of granular contacts."""

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Potential:
        """Read the contributions, all of them 0."""
        del world
        while not words.done():
            words.choice(("pair", "bond", "angle", "dihedral", "improper", "kspace"))
        return cls(*head)

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return 0."""
        if indices or self.style != "pe":
            return super().value(world, indices)
        return 0.0

    def per_atom(self, world: World, index: int) -> Floats:
        """Return 0 for all particles."""
        if index or self.style != "pe/atom":
            return super().per_atom(world, index)
        return np.zeros(world.state.n)
