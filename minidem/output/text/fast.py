"""Fast formatting of many numbers in C's ``%d`` and ``%g``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from minidem.kernels.text.numbers import MOST_BYTES, POWERS, write_numbers

__all__ = ["WORTHWHILE", "number_lines", "precision_of"]

WORTHWHILE: Final = 3000
"""Fewer numbers than this are formatted by Python: no kernel has to be loaded."""

_PRECISIONS: Final = {"%d": 0, "%g": 6, "%.11g": 11}


def precision_of(formats: Sequence[str]) -> NDArray[np.int64] | None:
    """Return the digits of each format, 0 for ``%d``; None if one is not a default format."""
    if any(one not in _PRECISIONS for one in formats):
        return None
    return np.array([_PRECISIONS[one] for one in formats], dtype=np.int64)


def number_lines(values: NDArray[np.float64], precision: NDArray[np.int64], per_line: int) -> str:
    """Return numbers as text, each followed by a blank, with a break after every `per_line`.

    Parameters
    ----------
    values : (n,) ndarray of float64
        The numbers; whole ones must be below 2**53.
    precision : (m,) ndarray of int
        Digits of number i are ``precision[i % m]``, 0 for whole numbers.
    per_line : int
        Numbers per line.
    """
    out = np.empty(MOST_BYTES * len(values), dtype=np.uint8)
    at, done = 0, 0
    while done < len(values):
        done, at = write_numbers(values, precision, POWERS, per_line, done, out, at)
        if done < len(values):
            at = _write_slowly(values, precision, per_line, done, out, at)
            done += 1
    return out[:at].tobytes().decode("ascii")


def _write_slowly(
    values: NDArray[np.float64],
    precision: NDArray[np.int64],
    per_line: int,
    done: int,
    out: NDArray[np.uint8],
    at: int,
) -> int:
    """Write the one number whose last digit the kernel could not decide."""
    digits = int(precision[done % len(precision)])
    text = f"{values[done]:.{digits}g} " + ("\n" if (done + 1) % per_line == 0 else "")
    letters = np.frombuffer(text.encode("ascii"), dtype=np.uint8)
    out[at : at + len(letters)] = letters
    return at + len(letters)
