"""``compute ID GROUP stress/atom``, ``temp`` and ``pressure``: virials and temperature."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Final

import numpy as np

from minidem.contact.actions import pair_contacts
from minidem.errors import InputError
from minidem.kernels.columns import MASS, VELOCITY, X, Y, Z
from minidem.registry import Head
from minidem.words import Words
from minidem.world.compute import COMPUTES, Compute
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["Pressure", "StressAtom", "Temperature"]

_PAIRS: Final = ((X, X), (Y, Y), (Z, Z), (X, Y), (X, Z), (Y, Z))
_PARTS: Final = ("ke", "pair", "bond", "angle", "dihedral", "improper", "kspace", "fix", "virial")
_BOLTZMANN: Final = {
    "si": 1.3806504e-23, "cgs": 1.3806504e-16, "lj": 1.0, "micro": 1.3806504e-8,
    "nano": 0.013806503,
}  # fmt: skip
"""As LIGGGHTS has it."""


def _parts(words: Words) -> tuple[bool, bool]:
    """Read the contributions; return whether motion and contacts count."""
    if words.done():
        return True, True
    given = set()
    while not words.done():
        given.add(words.choice(_PARTS))
    return "ke" in given, bool(given & {"pair", "virial"})


def _products(first: Floats, second: Floats) -> Floats:
    """Return the components xx, yy, zz, xy, xz, yz of the products of vectors."""
    return np.stack([first[:, a] * second[:, b] for a, b in _PAIRS], axis=1)


def _motion(world: World) -> Floats:
    """Return mass times the products of velocities, J."""
    row = world.state.row[: world.state.n]
    found: Floats = row[:, MASS, None] * _products(row[:, VELOCITY], row[:, VELOCITY])
    return found


@COMPUTES.register("stress/atom")
@dataclass
class StressAtom(Compute):
    """Stress times volume of each particle, J; walls do not count, as in LIGGGHTS.

    Attributes
    ----------
    moves, touches : bool
        Whether motion and contacts count.
    """

    moves: bool = True
    touches: bool = True

    looks_inside: ClassVar[bool] = True

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> StressAtom:
        """Read the contributions."""
        del world
        return cls(*head, *_parts(words))

    def per_atom(self, world: World, index: int) -> Floats:
        """Return a component xx, yy, zz, xy, xz, yz, from 1."""
        if not 1 <= index <= len(_PAIRS):
            return super().per_atom(world, index)
        n, component = world.state.n, index - 1
        total = np.zeros(n)
        if self.touches:
            found = pair_contacts(world, in_step=True)
            half = 0.5 * _products(found.arm, found.force)[:, component]
            for side in (0, 1):
                total += np.bincount(found.who[:, side], half, minlength=n)
        if self.moves:
            total += _motion(world)[:, component]
        return np.where(world.member(self.bit), -total, 0.0)


@COMPUTES.register("temp")
@dataclass
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
        found: Floats = _motion(world)[world.member(self.bit)].sum(axis=0)
        return found

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return the temperature, K, or a component of the sums of `motion`, J, from 1."""
        sums = self.motion(world).tolist()
        if indices:
            if len(indices) > 1 or indices[0] > len(_PAIRS):
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


@COMPUTES.register("pressure")
@dataclass
class Pressure(Compute):
    """Pressure of the whole box, Pa, from motion and contacts between particles.

    Attributes
    ----------
    temperature : str
        Compute that gives the part of the motion.
    moves, touches : bool
        Whether motion and contacts count.
    """

    temperature: str
    moves: bool = True
    touches: bool = True

    looks_inside: ClassVar[bool] = True

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Pressure:
        """Read the compute of the temperature and the contributions."""
        words.need(1, f"compute ID all {head.style} thermo_temp")
        name = words.take("the ID of a compute temp")
        if not isinstance(world.computes.get(name), Temperature):
            msg = f"compute {head.style}: '{name[:40]}' is no compute temp; 'thermo_temp' is one"
            raise InputError(msg)
        return cls(*head, name, *_parts(words))

    def value(self, world: World, indices: tuple[int, ...]) -> float:
        """Return the pressure, or a component xx, yy, zz, xy, xz, yz, from 1."""
        if len(indices) > 1 or (indices and indices[0] > len(_PAIRS)):
            return super().value(world, indices)
        total = np.zeros(len(_PAIRS))
        if self.touches:
            found = pair_contacts(world, in_step=True)
            total += _products(found.arm, found.force).sum(axis=0)
        heat: Temperature = world.computes[self.temperature]
        # As in LIGGGHTS the scalar takes the motion from the temperature, which is 0 if the run
        # began with less than two particles; the components take it from the particles.
        if self.moves and (indices or heat.freedom(world) > 0):
            total += heat.motion(world)
        parts = total.tolist()
        size = parts[indices[0] - 1] if indices else sum(parts[: len("xyz")]) / 3.0
        return float(size / world.need_box().volume)
