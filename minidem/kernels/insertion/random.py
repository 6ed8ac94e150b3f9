"""Random numbers of the insertion commands: the minimal standard generator.

A generator's state is an array of three numbers: the seed, whether a second normal number is
kept, and that number.

References
----------
S. K. Park, K. W. Miller, "Random number generators: good ones are hard to find", Communications
of the ACM 31 (1988) 1192-1201.
"""

from __future__ import annotations

from math import log, sqrt

import numpy as np
from numpy.typing import NDArray

from minidem.kernels.columns import KEPT_NORMAL, KEPT_READY, SEED
from minidem.kernels.machine.jit import inlined, kernel

__all__ = ["draw_gaussian", "draw_orientation", "gaussian", "skip", "uniform"]

_MOST = 2147483647
_SCALE = 1.0 / _MOST


@inlined
def uniform(state: NDArray[np.float64]) -> float:
    """Return the next number in (0, 1) and advance `state`."""
    # The rest of a division by 2**31 - 1, without a division.
    product = 16807 * np.int64(state[SEED])
    seed = (product & _MOST) + (product >> 31)
    if seed >= _MOST:
        seed -= _MOST
    state[SEED] = seed
    return _SCALE * seed


@inlined
def gaussian(state: NDArray[np.float64]) -> float:
    """Return the next normally distributed number; they are made in pairs (polar method)."""
    if state[KEPT_READY] != 0.0:
        state[KEPT_READY] = 0.0
        return state[KEPT_NORMAL]
    square = 0.0
    first = 0.0
    second = 0.0
    while square >= 1.0 or square == 0.0:
        first = 2.0 * uniform(state) - 1.0
        second = 2.0 * uniform(state) - 1.0
        square = first * first + second * second
    factor = sqrt(-2.0 * log(square) / square)
    state[KEPT_NORMAL] = first * factor
    state[KEPT_READY] = 1.0
    return second * factor


@inlined
def draw_orientation(state: NDArray[np.float64]) -> None:
    """Draw the three numbers of a random orientation."""
    for _ in range(3):
        uniform(state)


@kernel
def draw_gaussian(state: NDArray[np.float64]) -> float:
    """Return the next normal number; for callers outside the kernels."""
    return gaussian(state)


@kernel
def skip(state: NDArray[np.float64], count: int) -> None:
    """Advance `state` by `count` numbers."""
    for _ in range(count):
        uniform(state)
