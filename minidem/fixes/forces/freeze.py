"""``fix ID GROUP freeze``: no force and no torque acts on the particles of the group."""

from __future__ import annotations

from typing import ClassVar

from minidem.errors import InputError
from minidem.fixes.forces.body import BodyForce
from minidem.world.fix import FIXES
from minidem.world.world import World

__all__ = ["Freeze", "frozen_bit"]


@FIXES.register("freeze")
class Freeze(BodyForce):
    """Particles that stay where they are; contacts treat them as infinitely heavy."""

    kernel: ClassVar[str] = "freeze"
    indices: ClassVar[tuple[int, ...]] = (1, 2, 3)
    sets: ClassVar[bool] = True

    def check(self, world: World) -> None:
        """Refuse a second one."""
        super().check(world)
        if len(world.of_kind(Freeze)) > 1:
            msg = "More than one fix freeze; put all particles to be frozen into one group"
            raise InputError(msg)


def frozen_bit(world: World) -> int:
    """Return the group bit of ``fix freeze``, 0 if there is none."""
    return next((freeze.bit for freeze in world.of_kind(Freeze)), 0)
