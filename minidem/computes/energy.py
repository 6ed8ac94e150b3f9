"""``compute ID GROUP ke``, ``ke/atom``, ``erotate/sphere``, ``erotate/sphere/atom``, ``pe``, J."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from minidem.errors import InputError
from minidem.kernels.columns import MASS, OMEGA, RADIUS, TOTAL_FORCE, VELOCITY
from minidem.record import record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.compute import COMPUTES, Compute
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["ErotateAtom", "ErotateSphere", "Kinetic", "KineticAtom", "Potential"]


@COMPUTES.register("erotate", "erotate/sphere")
class ErotateSphere(Compute):
    """Rotational kinetic energy."""

    extensive: ClassVar[tuple[bool, bool]] = (True, False)

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return the sum of 0.5 * 0.4 m r2 w2."""
        del indices
        who = world.member(self.bit)
        row = world.state.row[: world.state.n][who]
        spin = world.state.spin[: world.state.n][who]
        inertia = 0.4 * row[:, MASS] * row[:, RADIUS] ** 2
        return float(0.5 * (inertia * (spin[:, OMEGA] ** 2).sum(axis=1)).sum())


@COMPUTES.register("ke")
@record
class Kinetic(Compute):
    """Translational kinetic energy of the group.

    Attributes
    ----------
    ahead : bool
        Whether velocities are those of half a step later (``halfstep``).
    """

    extensive: ClassVar[tuple[bool, bool]] = (True, False)
    ahead: bool = False

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Kinetic:
        """Read ``halfstep``, if it is there."""
        del world
        made = cls(*head)
        if not words.done():
            words.expect("halfstep")
            made.ahead = True
        return made

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return the sum of 0.5 m v2."""
        del indices
        who = world.member(self.bit)
        row = world.state.row[: world.state.n][who]
        mass, velocity = row[:, MASS], row[:, VELOCITY]
        if self.ahead:
            force = world.state.force[: world.state.n, TOTAL_FORCE][who]
            velocity = velocity + 0.5 * world.dt * force / mass[:, None]
        return float(0.5 * (mass * (velocity**2).sum(axis=1)).sum())


@COMPUTES.register("ke/atom")
class KineticAtom(Compute):
    """Translational kinetic energy per particle."""

    def per_atom(self, world: World, index: int) -> Floats:
        """Return 0.5 m v2 of particles in the group, 0 for others."""
        del index
        row = world.state.row[: world.state.n]
        found: Floats = 0.5 * row[:, MASS] * (row[:, VELOCITY] ** 2).sum(axis=1)
        return found * world.member(self.bit)


@COMPUTES.register("erotate/sphere/atom")
class ErotateAtom(Compute):
    """Rotational kinetic energy per particle."""

    def per_atom(self, world: World, index: int) -> Floats:
        """Return 0.5 * 0.4 m r2 w2 of particles in the group, 0 for others."""
        del index
        row, spin = world.state.row[: world.state.n], world.state.spin[: world.state.n]
        found: Floats = 0.2 * row[:, MASS] * row[:, RADIUS] ** 2 * (spin[:, OMEGA] ** 2).sum(axis=1)
        return found * world.member(self.bit)


@COMPUTES.register("pe", "pe/atom")
@record
class Potential(Compute):
    """Potential energy: LIGGGHTS keeps none of granular contacts, only that of some fixes.

    Attributes
    ----------
    fixes : bool
        Whether fixes count that ``fix_modify ID energy yes`` names.
    """

    fixes: bool = True

    extensive: ClassVar[tuple[bool, bool]] = (True, False)

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Potential:
        """Read the contributions; with any given fixes do not count."""
        if head.style == "pe" and head.bit != world.bit("all"):
            msg = "Compute pe must use group all"
            raise InputError(msg)
        made = cls(*head, words.done())
        while not words.done():
            words.choice(("pair", "bond", "angle", "dihedral", "improper", "kspace"))
        return made

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return the energy of the fixes that count."""
        if indices or self.style != "pe":
            return super().value(world, indices)
        counted = sorted(world.energies) if self.fixes else []
        return float(sum(world.fixes[name].value(world, 0) for name in counted))

    def per_atom(self, world: World, index: int) -> Floats:
        """Return 0 for all particles."""
        if index or self.style != "pe/atom":
            return super().per_atom(world, index)
        return np.zeros(world.state.n)
