"""``fix ID GROUP massflow/mesh/sieve ... sieveSize D sieveSpacing S sieveStiffness K``: a sieve.

A counter that lets a particle pass with a probability, that of meeting a hole without touching its
rim, and pushes it back otherwise.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import pi
from typing import Any, ClassVar, Self

import numpy as np

from minidem.errors import InputError
from minidem.fixes.flow.massflow import MassFlow
from minidem.fixes.forces.body import BodyForce
from minidem.insertion.seeds import ParkMiller
from minidem.kernels.columns import COUNTED, POSITION, RADIUS, TOTAL_FORCE, VELOCITY, A
from minidem.kernels.contact.triangle import closest
from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.fix import FIXES
from minidem.world.state import Ints
from minidem.world.world import World

__all__ = ["Sieve"]

_SEED = 15485863  # of LIGGGHTS
_NUMBERS = ("sieveSize", "sieveSpacing", "sieveStiffness")
_PASSES = 0  # mark of a particle that may pass; 1 + t of one that triangle t pushes


@FIXES.register("massflow/mesh/sieve")
@record
class Sieve(MassFlow, BodyForce):
    """A mesh that lets particles pass by chance.

    Attributes
    ----------
    given : dict of str to float
        Size of the holes, m, their distance, m, stiffness, N/m, and damping, kg/s.
    marks : dict of int to int
        Id of a particle that has touched the mesh to what became of it.
    random : ParkMiller
        Throws the coins.
    """

    given: dict[str, float] = field(default_factory=lambda: {"sieveDamping": 0.0})
    marks: dict[int, int] = field(default_factory=dict)
    random: ParkMiller = field(default_factory=lambda: ParkMiller(_SEED))

    keywords: ClassVar[tuple[str, ...]] = (
        *MassFlow.keywords, *_NUMBERS, "sieveDamping", "sieveMultiSphereCanPass",
    )  # fmt: skip

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Self:
        """Read the counter and the sieve."""
        made = super().read(world, head, words)
        for key in _NUMBERS:
            if made.given.get(key, -1.0) < 0.0:
                msg = f"massflow/mesh/sieve: '{key}' is not given, or less than zero"
                raise InputError(msg)
        return made

    def read_option(self, world: World, key: str, words: Words) -> None:
        """Read the value of one keyword."""
        if key in (*_NUMBERS, "sieveDamping"):
            self.given[key] = words.number()
        elif key != "sieveMultiSphereCanPass":
            super().read_option(world, key, words)

    def apply(self, world: World) -> None:
        """Push back the particles that touch the mesh and may not pass."""
        if world.step == world.begin_step:
            return  # LIGGGHTS does not at the setup of a run
        for t in range(*world.meshes.span(self.mesh)):
            self._touch(world, t)

    def _touch(self, world: World, t: int) -> None:
        """Go through the particles at one triangle."""
        state, table = world.state, world.meshes.table
        touching = set()
        for i in self._near(world, t).tolist():
            place, radius = state.row[i, POSITION], float(state.row[i, RADIUS])
            found = closest(table, t, *place.tolist())
            deep = found.distance - radius
            if deep > 0.0:
                continue
            number = int(state.ids[i])
            touching.add(number)
            if number not in self.marks:
                self.marks[number] = self._thrown(radius, t)
            if self.marks[number] != _PASSES:
                to_mesh = -np.array([found.dx, found.dy, found.dz]) / radius
                speed = float(state.row[i, VELOCITY] @ to_mesh)
                push = self.given["sieveDamping"] * speed - self.given["sieveStiffness"] * deep
                state.force[i, TOTAL_FORCE] -= max(push, 0.0) * to_mesh
        for number in [one for one, mark in self.marks.items() if mark == 1 + t]:
            if number not in touching:
                del self.marks[number]

    def _near(self, world: World, t: int) -> Ints:
        """Return the particles that may touch a triangle, in the order of output."""
        state, table = world.state, world.meshes.table
        row = state.row[: state.n]
        gap = (row[:, POSITION] - table.node[t, A]) @ table.normal[t]
        chosen = world.member(self.bit) & (np.abs(gap) <= row[:, RADIUS])
        marker = state.marker[world.flows.index(self.name), : state.n]
        chosen &= marker != COUNTED
        low, high = table.node[t].min(axis=0), table.node[t].max(axis=0)
        who = np.flatnonzero(chosen)
        reach, place = row[who, RADIUS, None], row[who, POSITION]
        held = ((place >= low - reach) & (place <= high + reach)).all(axis=1)
        who = who[held]
        found: Ints = who[np.argsort(state.rank[who], kind="stable")]
        return found

    def _thrown(self, radius: float, t: int) -> int:
        """Throw a coin; return the mark of a particle that touches triangle t first."""
        free, spacing = self.given["sieveSize"] - 2.0 * radius, self.given["sieveSpacing"]
        chance = free * free * (0.25 * pi) / (spacing * spacing) if free > 0.0 else 0.0
        return _PASSES if self.random.uniform() < chance else 1 + t

    def ids_changed(self, new: Mapping[int, int]) -> None:
        """Follow particles that have got new ids."""
        super().ids_changed(new)
        self.marks = {new[one]: mark for one, mark in self.marks.items() if one in new}

    def state(self) -> dict[str, Any]:
        """Return counters, marks and the generator."""
        marks = [[number, mark] for number, mark in self.marks.items()]
        return super().state() | {"marks": marks, "random": self.random.state.tolist()}

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Take them from a restart file."""
        super().restore(saved)
        self.marks = {int(number): int(mark) for number, mark in saved.get("marks", ())}
        self.random.state[:] = saved.get("random", self.random.state)
