"""``fix ID GROUP store/force``: forces as they are where the fix stands in the script."""

from __future__ import annotations

import numpy as np

from minidem.fixes.forces.body import BodyForce
from minidem.kernels.columns import TOTAL_FORCE
from minidem.record import field, record
from minidem.world.fix import FIXES
from minidem.world.state import Floats
from minidem.world.values.by_id import ById
from minidem.world.world import World

__all__ = ["StoreForce"]

_NONE = (0.0, 0.0, 0.0)


@FIXES.register("store/force")
@record
class StoreForce(BodyForce):
    """Forces on the particles of a group before the fixes behind it, ``f_ID[1]`` to ``f_ID[3]``.

    Attributes
    ----------
    kept : ById
        N; zero for particles that are not in the group.
    """

    kept: ById = field(default_factory=lambda: ById(_NONE))

    def apply(self, world: World) -> None:
        """Note the forces."""
        force = world.state.force[: world.state.n, TOTAL_FORCE]
        self.kept.keep(world, np.where(world.member(self.bit)[:, None], force, 0.0))

    def per_atom(self, world: World, name: str) -> Floats | None:
        """Return a component of the forces."""
        for column in range(len(_NONE)):
            if name == f"{self.name}[{column + 1}]":
                return self.kept.rows(world)[:, column]
        return None
