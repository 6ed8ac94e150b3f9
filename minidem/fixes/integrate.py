"""``fix ID GROUP nve/sphere``, ``nve``, ``nve/noforce`` and ``nve/limit``: move particles."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from minidem.errors import InputError
from minidem.record import record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.fix import FIXES, Fix
from minidem.world.world import World

__all__ = ["Integrate", "LimitedSpeed", "group_bits", "nve_bit", "speed_limit"]


@FIXES.register("nve/sphere")
class Integrate(Fix):
    """Velocity Verlet; the kernels do it for all groups at once, see `group_bits`."""

    forced: ClassVar[bool] = True
    """Whether forces change the velocity."""
    turned: ClassVar[bool] = True
    """Whether torques change the spin."""

    def check(self, world: World) -> None:
        """Refuse particles that two fixes would move twice a step."""
        fixes = world.of_kind(Integrate)
        if fixes[0] is not self or len(fixes) == 1:
            return
        twice = sum(world.member(fix.bit).astype(int) for fix in fixes) > 1
        if np.any(twice):
            who = int(world.state.ids[int(np.argmax(twice))])
            msg = (
                f"particle {who} is in the groups of two of the fixes "
                f"{', '.join(fix.name for fix in fixes)}, and would move twice a step; use groups "
                "that do not overlap, or unfix one of them"
            )
            raise InputError(msg)


@FIXES.register("nve")
class WithoutSpin(Integrate):
    """As `Integrate`; spins stay as they are."""

    turned: ClassVar[bool] = False


@FIXES.register("nve/noforce")
class WithoutForce(WithoutSpin):
    """Particles that fly on at their velocity, whatever pushes them."""

    forced: ClassVar[bool] = False


@FIXES.register("nve/limit")
@record
class LimitedSpeed(WithoutSpin):
    """As `WithoutSpin`, and no particle goes farther than a given way in a step.

    Attributes
    ----------
    way : float
        m, or in radii.
    of_radius : bool
        Whether it is in radii.
    """

    way: float = 0.0
    of_radius: bool = False

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> LimitedSpeed:
        """Read ``radius_ratio VALUE`` or ``absolute VALUE``."""
        del world
        words.need(2, "fix ID GROUP nve/limit radius_ratio VALUE")
        of_radius = words.choice(("radius_ratio", "absolute"), "limit") == "radius_ratio"
        return cls(*head, words.number(), of_radius)

    def check(self, world: World) -> None:
        """Refuse two different limits."""
        super().check(world)
        limits = {(fix.way, fix.of_radius) for fix in world.of_kind(LimitedSpeed)}
        if len(limits) > 1:
            msg = "fixes nve/limit with different limits are not supported; use one of them"
            raise InputError(msg)


def nve_bit(world: World) -> int:
    """Return the group bits that are integrated, 0 if there is no integrator."""
    found = 0
    for fix in world.of_kind(Integrate):
        found |= fix.bit
    return found


def group_bits(world: World) -> tuple[int, int, int]:
    """Return the group bits without forces, without torques, and with a largest speed."""
    unforced = unturned = limited = 0
    for fix in world.of_kind(Integrate):
        unforced |= 0 if fix.forced else fix.bit
        unturned |= 0 if fix.turned else fix.bit
        limited |= fix.bit if isinstance(fix, LimitedSpeed) else 0
    return unforced, unturned, limited


def speed_limit(world: World) -> tuple[float, bool]:
    """Return the squared speed of ``nve/limit``, m2/s2 or 1/s2, and whether it is per radius."""
    for fix in world.of_kind(LimitedSpeed):
        speed = fix.way / world.dt
        return speed * speed, fix.of_radius
    return 0.0, False
