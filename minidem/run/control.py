"""The numbers that Python gives the run loop at the start of a run."""

from __future__ import annotations

from minidem.fixes.forces.body import gravity_leads, late_forces, needs_python
from minidem.fixes.forces.freeze import frozen_bit
from minidem.fixes.integrate import nve_bit
from minidem.kernels.control import REALS, WHOLES
from minidem.kernels.tables import Control, Motions, Posts
from minidem.world.world import World

__all__ = ["REAL", "WHOLE", "fill_control"]

WHOLE = {name: i for i, name in enumerate(WHOLES)}
"""Name of a whole number to its place in ``Control.whole``."""

REAL = {name: i for i, name in enumerate(REALS)}
"""Name of a number to its place in ``Control.real``."""


def fill_control(world: World, control: Control, motions: Motions, posts: Posts) -> None:
    """Write the numbers that do not change within a run; the tables of the fixes are there."""
    whole, real = control.whole, control.real
    near = world.neighbor
    whole[WHOLE["delay"]] = near.delay
    whole[WHOLE["every"]] = near.every
    whole[WHOLE["check"]] = int(near.check)
    whole[WHOLE["clear"]] = int(near.reach > 1.0)
    whole[WHOLE["nve"]] = nve_bit(world)
    whole[WHOLE["frozen"]] = frozen_bit(world)
    whole[WHOLE["types"]] = world.types
    whole[WHOLE["motions"]] = len(motions.spec)
    whole[WHOLE["flows"]] = len(world.lists.flows.spec)
    whole[WHOLE["leading"]] = int(gravity_leads(world))
    outside = needs_python(world)
    whole[WHOLE["outside"]] = int(outside)
    whole[WHOLE["late"]] = late = late_forces(world)
    # forces worked out in Python are not the kernels' business
    whole[WHOLE["posts"]] = late if outside else len(posts.spec)
    real[REAL["dt"]] = world.dt
    real[REAL["trigger2"]] = 0.25 * near.skin * near.skin
    real[REAL["reach2"]] = near.reach * near.reach
    real[REAL["skin"]] = near.skin
    real[REAL["reach"]] = near.reach
