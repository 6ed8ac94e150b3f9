"""Which pairs of the neighbour list may touch soon.

A list is made for a way of half the skin, and most of its pairs lie far apart. So now and then a
scan of the whole list notes which pairs are near, within a part of the skin or in contact already,
and only those are looked at until a particle may have gone half that far. What touches is found in
any case, in the same order.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from minidem.kernels.columns import ALONG, ROW, SKIN, SWEPT, VX, WIDE
from minidem.kernels.machine.jit import inlined
from minidem.kernels.machine.space import columns

__all__ = ["MANY", "WORTH", "is_time", "looked", "within"]

MANY = 1000
"""Particles whose data do not fit into the nearest cache."""

NEAR, NEAR_OF_WIDE = 0.25, 0.5
"""Parts of the skin within which pairs are near; to look through a wide list takes longer."""
ENOUGH = 0.4999
"""Part of that distance that particles may go before others are near; the rest is for rounding."""
WORTH = 0.75
"""Largest share of near pairs with which they are looked at alone: the list of them costs too."""


@inlined
def within(real: Any) -> Any:
    """Return the gap up to which pairs are near, m."""
    return real[SKIN] * (NEAR_OF_WIDE if real[WIDE] > real[SKIN] else NEAR)


@inlined
def is_time(real: Any) -> Any:
    """Return True if a particle may have gone so far that others are near; nan counts as far."""
    return not real[SWEPT] <= ENOUGH * within(real)


@inlined
def looked(n: int, table: Any, real: Any) -> None:
    """Note that near pairs were looked for in all ranges, if it was time.

    Ways count from now on relative to the middle of all velocities: particles that fall or are
    carried together stay as near as they are.

    Parameters
    ----------
    n : int
        Particles.
    table : float64 (cap, 8)
        Particle rows.
    real : float64 (32,)
        See `minidem.kernels.tables`.
    """
    if not is_time(real):
        return
    real[SWEPT] = 0.0
    row = columns(table, ROW)
    for c in range(3):
        least = np.inf
        most = -np.inf
        for i in range(n):
            least = min(least, row[i, VX + c])
            most = max(most, row[i, VX + c])
        middle = 0.5 * (least + most)
        real[ALONG + c] = middle if abs(middle) < np.inf else 0.0  # without particles, or lost ones
