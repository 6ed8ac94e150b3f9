"""``fix ID GROUP buoyancy density RHO level H dim z [region REGION]``: lift in a resting liquid."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from minidem.errors import InputError
from minidem.fixes.forces.body import FORCE_BEFORE, BodyForce
from minidem.fixes.forces.gravity import Gravity
from minidem.kernels.columns import FX, POSITION, POST_VECTOR, RADIUS, three
from minidem.record import record
from minidem.registry import Head
from minidem.words import Words, one_of
from minidem.world.fix import FIXES
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["Buoyancy"]

_AXES = ("x", "y", "z")


@FIXES.register("buoyancy")
@record
class Buoyancy(BodyForce):
    """The weight of the liquid that a sphere displaces.

    Attributes
    ----------
    density : float
        Of the liquid, kg/m3.
    level : float
        Where its surface is, m; zero without the keyword.
    axis : int
        Direction of gravity; -1 until the script gives it.
    """

    density: float = 0.0
    level: float = 0.0
    axis: int = -1

    indices: ClassVar[tuple[int, ...]] = (1, 2, 3)

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Buoyancy:
        """Read the options."""
        made = cls(*head)
        while not words.done():
            key = words.choice(("density", "level", "dim", "region"))
            if key == "density":
                made.density = words.positive()
            elif key == "level":
                made.level = words.positive()
            elif key == "dim":
                made.axis = _AXES.index(words.choice(_AXES, "direction"))
            else:
                made.region = one_of(words.take("a region"), tuple(world.regions), "region")
        if made.axis < 0 or not made.density:
            msg = "fix buoyancy: you have to specify 'dim' and 'density'"
            raise InputError(msg)
        return made

    def check(self, world: World) -> None:
        """Refuse a run without one gravity."""
        super().check(world)
        if len(world.of_kind(Gravity)) != 1:
            msg = "fix buoyancy: need exactly one fix gravity"
            raise InputError(msg)

    def apply(self, world: World) -> None:
        """Add the lift."""
        gravity = world.of_kind(Gravity)[0]
        pull = gravity.numbers[three(POST_VECTOR)]
        if not pull.any() and gravity.pull.varies:
            msg = (
                f"fix buoyancy: what fix gravity {gravity.name} is in the first step is not known "
                "here; give fix gravity before fix buoyancy"
            )
            raise InputError(msg)
        across = np.delete(pull, self.axis)
        if across.any() or not pull[self.axis]:
            msg = f"fix buoyancy: fix gravity direction is not equal to 'dim' {_AXES[self.axis]}"
            raise InputError(msg)
        down = float(np.sign(pull[self.axis]))
        who, state = self.affected(world), world.state
        radius = state.row[who, RADIUS]
        depth = (state.row[who, POSITION][:, self.axis] - self.level) * down
        strength = float(np.sqrt((pull * pull).sum()))
        lift = -down * strength * _immersed(radius, depth) * self.density
        state.force[who, FX + self.axis] += lift
        total = np.zeros(3)
        total[self.axis] = lift.sum()
        self.before[FORCE_BEFORE] = total


def _immersed(radius: Floats, depth: Floats) -> Floats:
    """Return the volumes below the surface of spheres whose centres are at some depth, m3."""
    whole = 4.0 * np.pi / 3.0 * radius * radius * radius
    height = np.maximum(radius - np.abs(depth), 0.0)
    rim = 2.0 * radius * height - height * height
    cap = height * (np.pi / 6.0) * (3.0 * rim + height * height)
    found: Floats = np.where(depth > 0.0, whole - cap, cap)
    return found
