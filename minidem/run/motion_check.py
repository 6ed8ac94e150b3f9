"""Particles that move too far, or nowhere."""

from __future__ import annotations

from typing import Final

import numpy as np

from minidem.errors import SimulationError
from minidem.kernels.columns import MASS, RADIUS, VELOCITY
from minidem.world.world import World

__all__ = ["check_motion"]

MOST: Final = 0.5
"""Part of its radius that a particle may move in one step, if the skin is no larger."""


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
    skin = world.neighbor.skin
    if moved2 <= skin * skin:
        return
    row = state.row[: state.n]
    bad = np.flatnonzero(~np.isfinite(row[:, :MASS]).all(axis=1))
    if len(bad):
        raise SimulationError(
            world.step, int(state.ids[bad[0]]),
            "position or velocity is not a finite number; the time step is probably too "
            "large (compare fix check/timestep/gran) or particles overlap strongly",
        )  # fmt: skip
    # Lists are made anew before the forces of a step, so that a thin skin misses no contact.
    limit = np.maximum(skin, MOST * row[:, RADIUS])
    step = np.sqrt((row[:, VELOCITY] ** 2).sum(axis=1)) * world.dt
    worst = int(np.argmax(step / limit))
    if step[worst] > limit[worst]:
        raise SimulationError(
            world.step, int(state.ids[worst]),
            f"moves {step[worst]:.3g} m in one step, farther than {MOST:g} of its radius and the "
            f"neighbour skin of {skin:.3g} m; reduce the time step",
        )  # fmt: skip
