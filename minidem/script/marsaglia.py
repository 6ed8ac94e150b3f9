"""Random numbers of variables: Marsaglia's subtract-with-carry generator.

References
----------
F. James, "A review of pseudorandom number generators", Computer Physics Communications 60
(1990) 329-344, generator RANMAR.
"""

from __future__ import annotations

import math

from minidem.script.formula import FormulaError

__all__ = ["Marsaglia", "is_prime"]

_SCALE = 16777216.0  # 2**24: the generator works with 24-bit fractions
_LAGS = (97, 33)
_BASES = (2, 3, 5, 7)


def is_prime(number: int) -> bool:
    """Tell whether a number below 3 215 031 751 is prime (Miller and Rabin's test).

    References
    ----------
    C. Pomerance, J. L. Selfridge, S. S. Wagstaff, "The pseudoprimes to 25e9", Mathematics of
    Computation 35 (1980) 1003-1026: no composite below that limit passes for all four bases.
    """
    if number in _BASES:
        return True
    if number < 2 or any(number % base == 0 for base in _BASES):
        return False
    odd = number - 1
    twos = (odd & -odd).bit_length() - 1
    odd >>= twos
    return all(_passes(number, base, odd, twos) for base in _BASES)


def _passes(number: int, base: int, odd: int, twos: int) -> bool:
    """Tell whether `number` = odd 2**twos + 1 behaves like a prime for a base."""
    power = pow(base, odd, number)
    if power in (1, number - 1):
        return True
    for _ in range(twos - 1):
        power = power * power % number
        if power == number - 1:
            return True
    return False


class Marsaglia:
    """Generator of ``random()`` and ``normal()`` in formulas.

    Parameters
    ----------
    seed : int
        A prime above 10000 and at most 900000000, as LIGGGHTS demands.
    """

    def __init__(self, seed: int) -> None:
        if not 10000 < seed <= 900_000_000 or not is_prime(seed):
            msg = f"seed {seed} must be a prime from 10007 to 900000000, e.g. 15485863 or 32452843"
            raise FormulaError(msg)
        high, low = divmod(seed - 1, 30082)
        state = [high // 177 % 177 + 2, high % 177 + 2, low // 169 % 178 + 1]
        linear = low % 169
        self._table: list[float] = []
        for _ in range(_LAGS[0]):
            bits = 0
            for _ in range(24):
                new = state[0] * state[1] % 179 * state[2] % 179
                state = [state[1], state[2], new]
                linear = (53 * linear + 1) % 169
                bits = 2 * bits + (linear * new % 64 >= 32)
            self._table.append(bits / _SCALE)
        self._carry = 362436.0 / _SCALE
        self._i, self._j = _LAGS[0] - 1, _LAGS[1] - 1
        self._saved: float | None = None
        self.uniform()

    def uniform(self) -> float:
        """Return the next number in [0, 1)."""
        table, i, j = self._table, self._i, self._j
        number = table[i] - table[j]
        if number < 0.0:
            number += 1.0
        table[i] = number
        self._i = i - 1 if i else _LAGS[0] - 1
        self._j = j - 1 if j else _LAGS[0] - 1
        self._carry -= 7654321.0 / _SCALE
        if self._carry < 0.0:
            self._carry += 16777213.0 / _SCALE
        number -= self._carry
        return number + 1.0 if number < 0.0 else number

    def gaussian(self) -> float:
        """Return the next normally distributed number (polar method, two at a time)."""
        if self._saved is not None:
            number, self._saved = self._saved, None
            return number
        square = 0.0
        while square >= 1.0 or square == 0.0:
            first = 2.0 * self.uniform() - 1.0
            second = 2.0 * self.uniform() - 1.0
            square = first * first + second * second
        factor = math.sqrt(-2.0 * math.log(square) / square)
        self._saved = first * factor
        return second * factor
