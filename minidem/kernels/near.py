"""Which pairs of the neighbour list may touch soon.

A list is made for a way of half the skin, and most of its pairs lie far apart. So now and then a
scan of the whole list notes which pairs are near, within a part of the skin or in contact already,
and only those are looked at until a particle may have gone half that far. What touches is found in
any case, in the same order.
"""

from __future__ import annotations

from typing import Any

from minidem.kernels.columns import SKIN, SWEPT
from minidem.kernels.machine.jit import inlined

__all__ = ["NEAR", "WORTH", "is_time", "looked"]

NEAR = 0.25
"""Parts of the skin within which pairs are near,"""
ENOUGH = 0.4999 * NEAR
"""and that particles may go before others are; the rest is for rounding."""
WORTH = 0.75
"""Largest share of near pairs with which they are looked at alone: the list of them costs too."""


@inlined
def is_time(real: Any) -> Any:
    """Return True if a particle may have gone so far that others are near; nan counts as far."""
    return not real[SWEPT] <= ENOUGH * real[SKIN]


@inlined
def looked(real: Any) -> None:
    """Note that near pairs were looked for in all ranges, if it was time."""
    if is_time(real):
        real[SWEPT] = 0.0
