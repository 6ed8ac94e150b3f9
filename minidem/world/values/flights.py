"""What LIGGGHTS tells of particles of a stream as ``f_release_fix_insert_stream[I]``."""

from __future__ import annotations

from typing import Final

import numpy as np

from minidem.errors import InputError
from minidem.kernels.columns import FLIGHT_START, FLIGHT_STOP
from minidem.world.event import NEVER
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["RELEASE", "flight_values", "last_flight"]

RELEASE: Final = "release_fix_insert_stream"
"""Name of the fix that LIGGGHTS adds with the first stream of a script.

Its values are the first columns of ``Particles.flight``: place and step of insertion, step of
release, and velocities; 0 for particles that come from no stream.
"""
_VALUES: Final = 14


def last_flight(world: World) -> int:
    """Return the last step up to which the kernels have to look after flights, -1 for none.

    They forget those of released particles, unless the script asks for them.
    """
    state = world.state
    last = int(state.flight[: state.n, FLIGHT_STOP].max()) if state.n else -1
    asked = last >= 0 and any(RELEASE in word for word in world.words_of_fixes)
    return NEVER if asked else last


def flight_values(world: World, name: str) -> Floats | None:
    """Return one value per particle, None if `name` does not mean any.

    Parameters
    ----------
    world : World
        What is asked about.
    name : str
        ``release_fix_insert_stream[I]``, I from 1 to 14.

    Raises
    ------
    InputError
        If they are forgotten.
    """
    index = name.removeprefix(f"{RELEASE}[").removesuffix("]")
    if name != f"{RELEASE}[{index}]" or not (index.isascii() and index.isdigit()):
        return None
    if not 1 <= int(index) <= _VALUES:
        return None
    flight = world.state.flight[: world.state.n]
    free = flight[:, FLIGHT_STOP] < 0.0
    if (flight[free, FLIGHT_START] > 0.0).any():
        msg = (
            f"f_{name[:40]}: particles were released before the script has asked for it; name it "
            "in a dump or a variable before the first run"
        )
        raise InputError(msg)
    column = int(index) - 1
    return np.where(free, 0.0, flight[:, column])
