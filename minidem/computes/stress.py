"""``compute ID GROUP stress/atom`` and ``pressure``: virials."""

from __future__ import annotations

from typing import ClassVar, Final

import numpy as np

from minidem.computes.temperature import COMPONENTS, Temperature, motion_of, products
from minidem.contact.actions import pair_contacts
from minidem.errors import InputError
from minidem.record import record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.compute import COMPUTES, Compute
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["Pressure", "StressAtom"]

_PARTS: Final = ("ke", "pair", "bond", "angle", "dihedral", "improper", "kspace", "fix", "virial")


def _parts(words: Words) -> tuple[bool, bool]:
    """Read the contributions; return whether motion and contacts count."""
    if words.done():
        return True, True
    given = set()
    while not words.done():
        given.add(words.choice(_PARTS))
    return "ke" in given, bool(given & {"pair", "virial"})


@COMPUTES.register("stress/atom")
@record
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
        if not 1 <= index <= len(COMPONENTS):
            return super().per_atom(world, index)
        n, component = world.state.n, index - 1
        total = np.zeros(n)
        if self.touches:
            found = pair_contacts(world, in_step=True)
            half = 0.5 * products(found.arm, found.force)[:, component]
            for side in (0, 1):
                total += np.bincount(found.who[:, side], half, minlength=n)
        if self.moves:
            total += motion_of(world)[:, component]
        return np.where(world.member(self.bit), -total, 0.0)


@COMPUTES.register("pressure")
@record
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
        if len(indices) > 1 or (indices and indices[0] > len(COMPONENTS)):
            return super().value(world, indices)
        total = np.zeros(len(COMPONENTS))
        if self.touches:
            found = pair_contacts(world, in_step=True)
            total += products(found.arm, found.force).sum(axis=0)
        heat: Temperature = world.computes[self.temperature]
        # As in LIGGGHTS the scalar takes the motion from the temperature, which is 0 if the run
        # began with less than two particles; the components take it from the particles.
        if self.moves and (indices or heat.freedom(world) > 0):
            total += heat.motion(world)
        parts = total.tolist()
        size = parts[indices[0] - 1] if indices else sum(parts[: len("xyz")]) / 3.0
        return float(size / world.need_box().volume)
