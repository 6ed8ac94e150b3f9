"""``thermo_modify lost``: what to do when particles have left the box.

As in LIGGGHTS a particle beyond a fixed face is deleted when lists are made anew, and nobody is
told: the default is ``ignore``. With ``warn`` and ``error`` the number of particles is looked at
with every line of thermo output. LIGGGHTS takes any decrease since the line before for a loss,
deleted particles included, and does not see a loss that an insertion makes up for; here that
counts too.
"""

from __future__ import annotations

from minidem.errors import SimulationError
from minidem.record import record
from minidem.world.world import World

__all__ = ["LossWatch"]


@record
class LossWatch:
    """Compares the number of particles with that of the line of output before.

    Attributes
    ----------
    before : int
        Number of particles then, 0 at the start of a run.
    lost : int
        Number of particles that had left the box until then.
    """

    before: int = 0
    lost: int = 0

    def start(self, world: World) -> None:
        """Begin a run."""
        self.before, self.lost = 0, world.lost

    def look(self, world: World) -> str:
        """Look at the number of particles; return a warning, empty for none.

        Raises
        ------
        SimulationError
            If some are lost and that is an error.
        """
        before, now, left = self.before, world.state.n, world.lost - self.lost
        self.before, self.lost = now, world.lost
        if (now >= before and not left) or world.thermo.lost == "ignore":
            return ""
        if world.thermo.lost == "error":
            raise _error(world, left, before - now)
        if world.thermo.warned:
            return ""
        world.thermo.warned = True
        return f"Lost atoms: original {now + max(left, before - now)} current {now}"


def _error(world: World, left: int, fewer: int) -> SimulationError:
    """Say who left, where and what to do."""
    if left and world.last_lost is not None:
        step, number, position = world.last_lost
        where = ", ".join(f"{v:.4g}" for v in position)
        others = f", as the last of {left}," if left > 1 else ""
        return SimulationError(
            world.step, number,
            f"left the box{others} at step {step} at ({where}) through a fixed boundary; enlarge "
            "the box, close the geometry, or allow it with 'thermo_modify lost ignore'",
        )  # fmt: skip
    return SimulationError(
        world.step, None,
        f"there are {fewer} particles less than at the output before, and none has left the box: "
        "as in LIGGGHTS 'thermo_modify lost error' counts those that the script deletes; use "
        "'thermo_modify lost ignore'",
    )  # fmt: skip
