"""``fix ID GROUP nve/sphere``: moves the particles of the group."""

from __future__ import annotations

from dataclasses import dataclass

from minidem.world.fix import FIXES, Fix
from minidem.world.world import World

__all__ = ["Integrate", "nve_bit"]


@FIXES.register("nve/sphere")
@dataclass
class Integrate(Fix):
    """Velocity Verlet; the kernels do it for all groups at once, see `nve_bit`."""


def nve_bit(world: World) -> int:
    """Return the group bits that are integrated, 0 if there is no integrator."""
    found = 0
    for fix in world.of_kind(Integrate):
        found |= fix.bit
    return found
