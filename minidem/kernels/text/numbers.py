"""Numbers to text, as C's ``%g`` and ``%d`` write them, many at once.

A number is scaled to an integer of the wanted digits with one table of powers of ten; its error is
far below the last digit. Where the digits could still be in doubt (close to a tie), or the number
is not finite, the kernel stops and leaves this one to the caller.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from minidem.kernels.machine.jit import inlined, kernel

__all__ = ["MOST_BYTES", "POWERS", "write_numbers"]

MOST_BYTES = 26
"""Most characters of one number, the blank after it and a line break."""
_SPAN = 290
POWERS = np.array([float(f"1e{k}") for k in range(_SPAN + 1)])
"""Powers of ten, correctly rounded."""
_DOUBT = 1e-15  # the scaled number is off by less than 3 roundings of 1.1e-16

MINUS, PLUS, POINT, ZERO, EXPONENT, BLANK, LINE_END = (ord(c) for c in "-+.0e \n")


@inlined
def _digits(number: np.int64, count: int, text: NDArray[np.uint8], at: int) -> None:
    """Write exactly `count` decimal digits."""
    for place in range(at + count - 1, at - 1, -1):
        text[place] = ZERO + number % 10
        number //= 10


@inlined
def _whole(value: float, text: NDArray[np.uint8], at: int) -> int:
    """Write a whole number; return the place after it."""
    number = np.int64(value)
    if number < 0:
        text[at] = MINUS
        at += 1
        number = -number
    count = 1
    rest = number // 10
    while rest > 0:
        count += 1
        rest //= 10
    _digits(number, count, text, at)
    return at + count


@inlined
def _scaled(value: float, exponent: int, precision: int, powers: NDArray[np.float64]) -> float:
    """Return value / 10**exponent * 10**(precision - 1)."""
    shift = precision - 1 - exponent
    return value * powers[shift] if shift >= 0 else value / powers[-shift]


@inlined
def _general(
    value: float, precision: int, powers: NDArray[np.float64], text: NDArray[np.uint8], at: int
) -> int:
    """Write a number like ``%.{precision}g``; return the place after it, -1 if in doubt."""
    if value == 0.0:
        if np.signbit(value):
            text[at] = MINUS
            at += 1
        text[at] = ZERO
        return at + 1
    after = precision - 1  # digits after the first
    size = abs(value)
    if not (size > 1e-270 and size < 1e270):
        return -1
    exponent = int(np.floor(np.log10(size)))
    scaled = _scaled(size, exponent, precision, powers)
    if scaled >= powers[precision]:
        exponent += 1
        scaled = _scaled(size, exponent, precision, powers)
    elif scaled < powers[after]:
        exponent -= 1
        scaled = _scaled(size, exponent, precision, powers)
    number = np.int64(np.floor(scaled + 0.5))
    if abs(scaled - np.floor(scaled) - 0.5) < _DOUBT * scaled:
        return -1
    if number >= np.int64(powers[precision]):
        number //= 10
        exponent += 1
    elif number < np.int64(powers[after]):
        return -1
    if value < 0.0:
        text[at] = MINUS
        at += 1
    count = precision
    while count > 1 and number % 10 == 0:
        number //= 10
        count -= 1
    if exponent < -4 or exponent >= precision:
        return _scientific(number, count, exponent, text, at)
    return _fixed(number, count, exponent, text, at)


@inlined
def _fixed(number: np.int64, count: int, exponent: int, text: NDArray[np.uint8], at: int) -> int:
    """Write `count` digits with a point after the one of 10**0."""
    if exponent < 0:
        text[at] = ZERO
        text[at + 1] = POINT
        for k in range(-exponent - 1):
            text[at + 2 + k] = ZERO
        at += 1 - exponent
        _digits(number, count, text, at)
        return at + count
    before = exponent + 1
    if count <= before:
        _digits(number, count, text, at)
        for k in range(count, before):
            text[at + k] = ZERO
        return at + before
    split = np.int64(1)
    for _ in range(count - before):
        split *= 10
    _digits(number // split, before, text, at)
    text[at + before] = POINT
    _digits(number % split, count - before, text, at + before + 1)
    return at + count + 1


@inlined
def _scientific(
    number: np.int64, count: int, exponent: int, text: NDArray[np.uint8], at: int
) -> int:
    """Write ``d.ddde-07``."""
    _digits(number, count, text, at + 1)
    text[at] = text[at + 1]
    at += 1
    if count > 1:
        text[at] = POINT
        at += count
    text[at] = EXPONENT
    text[at + 1] = MINUS if exponent < 0 else PLUS
    size = np.int64(abs(exponent))
    wide = 3 if size >= 100 else 2
    _digits(size, wide, text, at + 2)
    return at + 2 + wide


@kernel
def write_numbers(
    values: NDArray[np.float64],
    precision: NDArray[np.int64],
    powers: NDArray[np.float64],
    per_line: int,
    first: int,
    text: NDArray[np.uint8],
    at: int,
) -> tuple[int, int]:
    """Write numbers, each followed by a blank, with a line break after every `per_line`.

    Parameters
    ----------
    values : (n,) float64
        Numbers.
    precision : (m,) int64
        Digits of number i are ``precision[i % m]``, 0 for whole numbers.
    powers : ndarray
        `POWERS`.
    per_line : int
        Numbers per line.
    first : int
        Where to start.
    text : (bytes,) uint8
        Text, at least `MOST_BYTES` per number.
    at : int
        Place of the first character.

    Returns
    -------
    tuple of int
        Index of the first number not written (n if all are), place after the text.
    """
    kinds = precision.shape[0]
    for i in range(first, values.shape[0]):
        digits = precision[i % kinds]
        if digits == 0:
            end = _whole(values[i], text, at)
        else:
            end = _general(values[i], digits, powers, text, at)
            if end < 0:
                return i, at
        text[end] = BLANK
        at = end + 1
        if (i + 1) % per_line == 0:
            text[at] = LINE_END
            at += 1
    return values.shape[0], at
