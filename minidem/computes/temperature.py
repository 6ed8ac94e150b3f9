"""``compute ID GROUP temp``: what motion says of the temperature."""

from __future__ import annotations

from typing import ClassVar, Final

import numpy as np

from minidem.kernels.columns import MASS, VELOCITY, X, Y, Z
from minidem.record import record
from minidem.words import Words
from minidem.world.compute import COMPUTES, Compute
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["COMPONENTS", "Temperature", "motion_of", "products"]

COMPONENTS: Final = ((X, X), (Y, Y), (Z, Z), (X, Y), (X, Z), (Y, Z))
"""Components xx, yy, zz, xy, xz, yz of a symmetric tensor."""
_BOLTZMANN: Final = {
    "si": 1.3806504e-23, "cgs": 1.3806504e-16, "lj": 1.0, "micro": 1.3806504e-8,
    "nano": 0.013806503,
}  # fmt: skip
"""As LIGGGHTS has it."""


def products(first: Floats, second: Floats) -> Floats:
    """Return the components xx, yy, zz, xy, xz, yz of the products of vectors."""
    return np.stack([first[:, a] * second[:, b] for a, b in COMPONENTS], axis=1)


def motion_of(world: World) -> Floats:
    """Return mass times the products of velocities, J."""
    row = world.state.row[: world.state.n]
    found: Floats = row[:, MASS, None] * products(row[:, VELOCITY], row[:, VELOCITY])
    return found


@COMPUTES.register("temp")
@record
class Temperature(Compute):
    """Temperature of the translational motion, K.

    Attributes
    ----------
    extra : int
        Degrees of freedom taken off.
    dynamic : bool
        Whether particles are counted whenever it is asked for, not only at the start of a run.
    counted : int
        Number of particles when the run began; -1 before the first.
    """

    extra: int = 3
    dynamic: bool = False
    counted: int = -1

    extensive: ClassVar[tuple[bool, bool]] = (False, True)

    def start(self, world: World) -> None:
        """Count the particles."""
        self.counted = int(np.count_nonzero(world.member(self.bit)))

    def freedom(self, world: World) -> int:
        """Return the number of degrees of freedom."""
        if self.dynamic or self.counted < 0:
            self.start(world)
        return len("xyz") * self.counted - self.extra

    def motion(self, world: World) -> Floats:
        """Return the sums of mass times products of velocities, J, shape (6,)."""
        found: Floats = motion_of(world)[world.member(self.bit)].sum(axis=0)
        return found

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return the temperature, K, or a component of the sums of `motion`, J, from 1."""
        sums = self.motion(world).tolist()
        if indices:
            if len(indices) > 1 or indices[0] > len(COMPONENTS):
                return super().value(world, indices)
            return float(sums[indices[0] - 1])
        freedom = self.freedom(world)
        scale = freedom * _BOLTZMANN[world.materials.units]
        return sum(sums[: len("xyz")]) / scale if freedom > 0 else 0.0

    def modify(self, key: str, words: Words) -> None:
        """Read a value of ``compute_modify``."""
        if key == "extra":
            self.extra = words.integer()
        elif key == "dynamic":
            self.dynamic = words.yes_no()
        else:
            super().modify(key, words)
