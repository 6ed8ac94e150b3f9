"""The numbers that Python gives the run loop at the start of a run."""

from __future__ import annotations

from minidem.fixes.forces.body import gravity_leads, late_forces, needs_python
from minidem.fixes.forces.freeze import frozen_bit
from minidem.fixes.integrate import group_bits, nve_bit, speed_limit
from minidem.fixes.wet.liquid import is_wet
from minidem.kernels.columns import (
    CLEAR_HISTORY,
    DT,
    FLOWS,
    FROZEN,
    INTEGRATED,
    LASTING,
    LATE_POSTS,
    LEADING,
    LIMIT2,
    LIMIT_OF_RADIUS,
    LIMITED,
    LIST_CHECK,
    LIST_DELAY,
    LIST_EVERY,
    MOTIONS,
    NEEDS_PYTHON,
    POSTS,
    REACH,
    REACH2,
    SKIN,
    TRIGGER2,
    TYPES,
    UNFORCED,
    UNTURNED,
    WET,
)
from minidem.kernels.tables import Control, Motions, Posts
from minidem.world.world import World

__all__ = ["fill_control"]


def fill_control(world: World, control: Control, motions: Motions, posts: Posts) -> None:
    """Write the numbers that do not change within a run; the tables of the fixes are there."""
    whole, real = control.whole, control.real
    near = world.neighbor
    whole[LIST_DELAY] = near.delay
    whole[LIST_EVERY] = near.every
    whole[LIST_CHECK] = int(near.check)
    whole[LASTING] = int(not (is_wet(world) or _asks_who_is_listed(world)))
    whole[CLEAR_HISTORY] = int(near.reach > 1.0)
    whole[INTEGRATED] = nve_bit(world)
    whole[UNFORCED], whole[UNTURNED], whole[LIMITED] = group_bits(world)
    real[LIMIT2], whole[LIMIT_OF_RADIUS] = speed_limit(world)
    whole[FROZEN] = frozen_bit(world)
    whole[TYPES] = world.types
    whole[WET] = int(is_wet(world))
    whole[MOTIONS] = len(motions.spec)
    whole[FLOWS] = len(world.lists.flows.spec)
    whole[LEADING] = int(gravity_leads(world))
    outside = needs_python(world)
    whole[NEEDS_PYTHON] = int(outside)
    whole[LATE_POSTS] = late = late_forces(world)
    # forces worked out in Python are not the kernels' business
    whole[POSTS] = late if outside else len(posts.spec)
    real[DT] = world.dt
    real[TRIGGER2] = 0.25 * near.skin * near.skin
    real[REACH2] = near.reach * near.reach
    real[SKIN] = near.skin
    real[REACH] = near.reach


def _asks_who_is_listed(world: World) -> bool:
    """Return True if a word of the script depends on what LIGGGHTS' lists hold, touching or not."""
    return any(one.own_lists for one in world.computes.values()) or any(
        fix.style.endswith("/servo") for fix in world.fixes.values()
    )
