"""Springs between groups and points, and from particles to where they were.

``fix ID GROUP spring tether K X Y Z R0``, ``spring couple GROUP2 K X Y Z R0`` and
``spring/self K [xyz]``.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import sqrt
from typing import Any, ClassVar

import numpy as np

from minidem.errors import InputError
from minidem.fixes.forces.body import BodyForce
from minidem.kernels.columns import MASS, TOTAL_FORCE
from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.fix import FIXES
from minidem.world.momentum import group_mass
from minidem.world.state import Floats
from minidem.world.values.by_id import ById, places, warn_of_joined
from minidem.world.world import World

__all__ = ["SelfSpring", "Spring"]

_LEAST = 1.0e-10  # m, length of a spring by which forces are divided
_AXES = ("xyz", "xy", "xz", "yz", "x", "y", "z")
_UNKNOWN = (0.0, 0.0, 0.0)  # as in LIGGGHTS, for particles that come later


def _place(words: Words) -> tuple[Floats, Floats]:
    """Read three coordinates, NULL for those that do not count; return them and which count."""
    place, counts = np.zeros(3), np.ones(3)
    for d in range(3):
        if words.peek() == "NULL":
            words.take("NULL")
            counts[d] = 0.0
        else:
            place[d] = words.number()
    return place, counts


@FIXES.register("spring")
@record
class Spring(BodyForce):
    """A spring between the centre of mass of a group and a point, or that of another group.

    Attributes
    ----------
    other : int
        Bit of the other group; 0 for a point.
    stiffness : float
        N/m.
    place, counts : ndarray, shape (3,)
        The point, or what is between the groups at rest, m; which of its components count.
    rest : float
        Length at which it does not pull, m.
    masses : list of float
        Of the groups at the start of the run, kg.
    energy : float
        J.
    pull : ndarray, shape (4,)
        Force on the group and its size, negative when the spring is too short, N.
    """

    other: int = 0
    stiffness: float = 0.0
    place: Floats = field(default_factory=lambda: np.zeros(3))
    counts: Floats = field(default_factory=lambda: np.ones(3))
    rest: float = 0.0
    masses: list[float] = field(default_factory=lambda: [0.0, 0.0])
    energy: float = 0.0
    pull: Floats = field(default_factory=lambda: np.zeros(4))

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Spring:
        """Read what it holds and how."""
        words.need(6, "fix ID GROUP spring tether K X Y Z R0")
        made = cls(*head)
        if words.choice(("tether", "couple"), "style") == "couple":
            made.other = world.bit(words.take("a group"))
            if made.other == made.bit:
                msg = "fix spring couple: the two groups are the same"
                raise InputError(msg)
        made.stiffness = words.number()
        made.place, made.counts = _place(words)
        made.rest = words.number()
        if made.rest < 0.0:
            msg = f"fix spring: the length at rest {made.rest:g} is negative"
            raise InputError(msg)
        return made

    def setup(self, world: World) -> None:
        """Weigh the groups."""
        self.masses = [group_mass(world, bit) if bit else 1.0 for bit in (self.bit, self.other)]
        if not min(self.masses) > 0.0:
            msg = f"fix {self.name} (spring): a group without particles has no centre of mass"
            raise InputError(msg)

    def apply(self, world: World) -> None:
        """Pull both ends."""
        ends = [self._centre(world, self.bit, self.masses[0])]
        if self.other:
            ends.append(self._centre(world, self.other, self.masses[1]))
            span = ends[1] - ends[0] - self.place
        else:
            span = ends[0] - self.place
        x, y, z = (span * self.counts).tolist()
        length = max(sqrt(x * x + y * y + z * z), _LEAST)
        stretch = length - self.rest
        pull = self.stiffness * np.array([x, y, z]) * stretch / length
        size = float(np.sqrt((pull * pull).sum()))
        self.energy = 0.5 * self.stiffness * stretch * stretch
        self.pull = np.append(pull if self.other else -pull, -size if stretch < 0.0 else size)
        self._push(world, self.bit, (pull if self.other else -pull) / self.masses[0])
        if self.other:
            self._push(world, self.other, -pull / self.masses[1])

    def _centre(self, world: World, bit: int, mass: float) -> Floats:
        """Return the centre of mass of a group, m."""
        who = world.member(bit)
        weight = world.state.row[: world.state.n, MASS][who, None]
        found: Floats = (world.unwrapped()[who] * weight).sum(axis=0) / mass
        return found

    def _push(self, world: World, bit: int, acceleration: Floats) -> None:
        """Add a force to each particle of a group, by its mass."""
        who = np.flatnonzero(world.member(bit))
        mass = world.state.row[who, MASS]
        world.state.force[who, TOTAL_FORCE] += mass[:, None] * acceleration

    def value(self, world: World, index: int) -> float:
        """Return the energy (0), the force (1-3) and its size (4)."""
        if not 0 <= index <= len(self.pull):
            return super().value(world, index)
        return self.energy if index == 0 else float(self.pull[index - 1])


@FIXES.register("spring/self")
@record
class SelfSpring(BodyForce):
    """A spring from each particle to where it was when the fix was made.

    Attributes
    ----------
    stiffness : float
        N/m.
    counts : ndarray, shape (3,)
        Which directions count.
    origin : ById
        Places then, without wrapping, m.
    energy : float
        Of all springs, J.
    newest : int
        The highest id when it was looked for particles that came later, -1: it has been said.
    """

    stiffness: float = 0.0
    counts: Floats = field(default_factory=lambda: np.ones(3))
    origin: ById = field(default_factory=lambda: ById(_UNKNOWN))
    energy: float = 0.0
    newest: int = 0

    indices: ClassVar[tuple[int, ...]] = (0,)

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> SelfSpring:
        """Read the stiffness, and note where the particles are."""
        words.need(1, "fix ID GROUP spring/self K [xyz]")
        made = cls(*head, stiffness=words.positive())
        if not words.done():
            axes = words.choice(_AXES, "directions")
            made.counts = np.array([float(axis in axes) for axis in "xyz"])
        made.origin.keep(world, places(world, made.bit))
        return made

    def setup(self, world: World) -> None:
        """Warn of particles that have come into the group since."""
        self._look(world)

    def _look(self, world: World) -> None:
        """Warn of particles that came later, once a run."""
        told = warn_of_joined(world, f"fix {self.name} (spring/self)", self.bit, self.origin)
        self.newest = -1 if told else world.state.top_id

    def apply(self, world: World) -> None:
        """Pull the particles back; those that came later to the origin of the coordinates."""
        if 0 <= self.newest < world.state.top_id:
            self._look(world)
        who = self.affected(world)
        span = (world.unwrapped()[who] - self.origin.seen(world)[who]) * self.counts
        world.state.force[who, TOTAL_FORCE] -= self.stiffness * span
        self.energy = 0.5 * self.stiffness * float((span * span).sum())

    def potential(self, world: World) -> float:
        """Return the energy of the springs, J."""
        del world
        return self.energy

    def ids_changed(self, new: Mapping[int, int]) -> None:
        """Follow particles that have got new ids."""
        self.origin.ids_changed(new)

    def particles_copied(self, steps: Sequence[int]) -> None:
        """Give copies of particles the same values."""
        self.origin.copied(steps)

    def state(self) -> dict[str, Any]:
        """Return the places of rest."""
        return self.origin.state()

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Take the places of rest from a restart file."""
        self.origin.restore(saved)
