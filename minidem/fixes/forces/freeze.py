"""``fix ID GROUP freeze``: no force and no torque acts on the particles of the group."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from minidem.fixes.forces.body import BodyForce
from minidem.world.fix import FIXES
from minidem.world.world import World

__all__ = ["Freeze", "frozen_bit"]


@FIXES.register("freeze")
@dataclass
class Freeze(BodyForce):
    """Particles that stay where they are; contacts treat them as infinitely heavy."""

    kernel: ClassVar[str] = "freeze"
    indices: ClassVar[tuple[int, ...]] = (1, 2, 3)


def frozen_bit(world: World) -> int:
    """Return the group bit of ``fix freeze``, 0 if there is none."""
    return next((freeze.bit for freeze in world.of_kind(Freeze)), 0)
