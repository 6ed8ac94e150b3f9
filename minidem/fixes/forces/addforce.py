"""``fix ID GROUP addforce FX FY FZ [region REGION] [energy v_NAME]`` and ``setforce``.

Components are numbers or variables ``v_NAME``, of style equal or atom; ``setforce`` takes NULL for
a component that it leaves as it is.
"""

from __future__ import annotations

from typing import ClassVar, Self

import numpy as np

from minidem.errors import InputError
from minidem.fixes.forces.body import ENERGY, FORCE_BEFORE, BodyForce
from minidem.kernels.columns import FX, POST_VECTOR, TOTAL_FORCE, three
from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words, number, one_of
from minidem.world.fix import FIXES
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["AddForce", "GivenForce", "SetForce"]


@record
class GivenForce(BodyForce):
    """A force whose components the script gives; constants are ``POST_VECTOR`` of `numbers`, N.

    Attributes
    ----------
    variables : list
        Names of the variables that give the components, None for constants.
    """

    variables: list[str | None] = field(default_factory=lambda: [None, None, None])

    null: ClassVar[bool] = False
    """Whether NULL leaves a component as it is."""
    keywords: ClassVar[tuple[str, ...]] = ("region",)

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Self:
        """Read three components and options."""
        words.need(3, f"fix ID GROUP {head.style} FX FY FZ [region REGION]")
        made = cls(*head)
        made.components = 0
        for c in range(3):
            word = words.take("a component")
            if word == "NULL" and cls.null:
                continue
            made.components |= 1 << c
            if word.startswith("v_"):
                made.variables[c] = word[2:]
            else:
                made.numbers[POST_VECTOR + c] = number(word, head.style)
        while not words.done():
            made.read_option(world, words.choice(cls.keywords), words)
        return made

    def read_option(self, world: World, key: str, words: Words) -> None:
        """Read the value of an option."""
        del key
        regions = tuple(world.regions)
        self.region = one_of(words.take("a region"), regions, f"region of fix {self.style}")

    def variables_asked(self) -> tuple[str, ...]:
        """Return the names of the variables that it asks in a run."""
        return tuple(name for name in self.variables if name)

    def in_python(self) -> bool:
        """Return True if there is a variable or a region."""
        return bool(self.region) or any(self.variables)

    def apply(self, world: World) -> None:
        """Work out the components and change the force."""
        who, force = self.affected(world), world.state.force
        wanted = [self.component(world, c)[who] for c in range(3)]
        self.note_energy(world)
        self.before[FORCE_BEFORE] = force[who, TOTAL_FORCE].sum(axis=0)
        for c in range(3):
            if self.components & 1 << c:
                force[who, FX + c] = self.changed(force[who, FX + c], wanted[c])

    def component(self, world: World, c: int) -> Floats:
        """Return one component for every particle, shape (n,), N."""
        name = self.variables[c]
        if name is None:
            return np.full(world.state.n, self.numbers[POST_VECTOR + c])
        values: Floats = world.interpreter.atom_values(name)
        return values

    def note_energy(self, world: World) -> None:
        """Keep the potential energy of this step, if the script gives it."""

    def changed(self, present: Floats, wanted: Floats) -> Floats:
        """Return a component of the force after this fix."""
        raise NotImplementedError


@FIXES.register("setforce")
class SetForce(GivenForce):
    """A force instead of the one that was there."""

    kernel: ClassVar[str] = "setforce"
    indices: ClassVar[tuple[int, ...]] = (1, 2, 3)
    sets: ClassVar[bool] = True
    null: ClassVar[bool] = True

    def changed(self, present: Floats, wanted: Floats) -> Floats:
        """Return the force of this fix."""
        del present
        return wanted


@FIXES.register("addforce")
@record
class AddForce(GivenForce):
    """A force on top of the one that was there.

    Attributes
    ----------
    energy : str
        Atom-style variable that gives the potential energy, J; empty for none.
    """

    energy: str = ""

    kernel: ClassVar[str] = "addforce"
    indices: ClassVar[tuple[int, ...]] = (0, 1, 2, 3)
    keywords: ClassVar[tuple[str, ...]] = ("region", "energy")
    energetic: ClassVar[bool] = True

    def read_option(self, world: World, key: str, words: Words) -> None:
        """Read ``region ID`` or ``energy v_NAME``."""
        if key == "region":
            super().read_option(world, key, words)
            return
        self.energy = words.variable()
        if not any(self.variables):
            msg = "Cannot use variable energy with constant force in fix addforce"
            raise InputError(msg)

    def variables_asked(self) -> tuple[str, ...]:
        """Return also the one that gives the energy."""
        return (*super().variables_asked(), *filter(None, [self.energy]))

    def changed(self, present: Floats, wanted: Floats) -> Floats:
        """Return the sum."""
        return present + wanted

    def note_energy(self, world: World) -> None:
        """Keep the potential energy that the script's variable gives."""
        if self.energy:
            who = self.affected(world)
            self.before[ENERGY] = world.interpreter.atom_values(self.energy)[who].sum()

    def potential(self, world: World) -> float:
        """Return the potential energy, J; of a constant force from the origin."""
        if any(self.variables):
            return super().potential(world)
        where = world.unwrapped()[self.affected(world)]
        return float(-(where @ self.numbers[three(POST_VECTOR)]).sum())
