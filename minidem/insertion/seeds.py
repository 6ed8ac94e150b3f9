"""Seeds and generators of the insertion commands."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError
from minidem.kernels.columns import SEED
from minidem.kernels.insertion.random import draw_gaussian
from minidem.script.marsaglia import is_prime
from minidem.words import integer

__all__ = ["MESH_SEED", "ParkMiller", "drawn_at", "read_seed"]

MESH_SEED: Final = 179424799
"""Of every mesh in LIGGGHTS."""

MAX_SEED: Final = 2_147_483_647
_WARM = 5  # numbers that a generator throws away after it was seeded by a place
_BITS = 2**32 - 1
_SEEDS = 0x7FFFFFF
_MODULUS: Final = MAX_SEED
_FACTOR: Final = 16807


def read_seed(word: str) -> int:
    """Return a seed given in a script.

    Parameters
    ----------
    word : str
        A prime above 10000, as LIGGGHTS demands.

    Raises
    ------
    InputError
        If it is not.

    Examples
    --------
    >>> read_seed("10007")
    10007
    """
    try:
        seed = integer(word, "seed", powers=True)
    except InputError:
        seed = 0
    if not 10000 < seed < MAX_SEED or not is_prime(seed):
        msg = (
            f"seed '{word[:40]}' must be a prime number above 10000, "
            "e.g. 15485863, 32452843 or 49979687"
        )
        raise InputError(msg)
    return seed


class ParkMiller:
    """A generator that kernels can advance.

    Parameters
    ----------
    seed : int
        Start value, 1 .. 2**31 - 2.

    Attributes
    ----------
    state : (3,) ndarray
        Seed, whether a second normal number is kept, that number.
    """

    def __init__(self, seed: int) -> None:
        self.state = np.zeros(3)
        self.reset(seed)

    def reset(self, seed: int) -> None:
        """Start anew."""
        self.state[:] = (seed, 0.0, 0.0)

    def uniform(self) -> float:
        """Return the next number in (0, 1)."""
        # here, because calling a kernel takes longer
        seed = int(self.state[SEED]) * _FACTOR % _MODULUS
        self.state[SEED] = seed
        return seed * (1.0 / _MODULUS)

    def uniforms(self, count: int) -> NDArray[np.float64]:
        """Return the next numbers in (0, 1), as `uniform` would one by one, shape (count,)."""
        powers = np.array([_FACTOR], np.int64)
        while len(powers) < count:
            powers = np.concatenate([powers, powers * powers[-1] % _MODULUS])
        seeds = powers[:count] * np.int64(self.state[SEED]) % _MODULUS
        if count:
            self.state[SEED] = seeds[-1]
        return seeds.astype(np.float64) * (1.0 / _MODULUS)

    def gaussian(self) -> float:
        """Return the next normally distributed number."""
        return float(draw_gaussian(self.state))


def drawn_at(seed: int, point: NDArray[np.float64], count: int) -> list[float]:
    """Return the numbers that a generator gives when it is seeded by a place."""
    mixed = 0
    data = np.int32(seed).tobytes() + np.asarray(point, np.float64).tobytes()
    for byte in np.frombuffer(data, np.int8).tolist():
        mixed = (mixed + byte) & _BITS
        mixed = (mixed + (mixed << 10)) & _BITS
        mixed ^= mixed >> 6
    mixed = (mixed + (mixed << 3)) & _BITS
    mixed ^= mixed >> 11
    mixed = (mixed + (mixed << 15)) & _BITS
    random = ParkMiller(mixed & _SEEDS or 1)
    return [random.uniform() for _ in range(_WARM + count)][_WARM:]
