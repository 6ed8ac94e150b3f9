"""Particles that move too far, or nowhere."""

from __future__ import annotations

import numpy as np

from minidem.errors import SimulationError
from minidem.kernels.columns import MASS, VELOCITY
from minidem.world.world import World

__all__ = ["check_motion"]


def check_motion(world: World, moved2: float) -> None:
    """Refuse to go on with NaN, or with a particle faster than the lists allow.

    Parameters
    ----------
    world : World
        The simulation.
    moved2 : float
        Largest squared move since the rebuild, m2.

    Raises
    ------
    SimulationError
        With the particle and what to change.
    """
    state = world.state
    limit = world.neighbor.skin
    if moved2 <= limit * limit:
        return
    row = state.row[: state.n]
    bad = np.flatnonzero(~np.isfinite(row[:, :MASS]).all(axis=1))
    if len(bad):
        raise SimulationError(
            world.step, int(state.ids[bad[0]]),
            "position or velocity is not a finite number; the time step is probably too "
            "large (compare fix check/timestep/gran) or particles overlap strongly",
        )  # fmt: skip
    speed = np.sqrt((row[:, VELOCITY] ** 2).sum(axis=1)) * world.dt
    worst = int(np.argmax(speed))
    if speed[worst] > limit:
        raise SimulationError(
            world.step, int(state.ids[worst]),
            f"moves {speed[worst]:.3g} m in one step, farther than the neighbour skin of "
            f"{limit:.3g} m; reduce the time step or enlarge the skin ('neighbor')",
        )  # fmt: skip
