"""Operators and elementary functions of formulas, for one number or one per particle.

Elementary functions use the C library's value for each particle, not numpy's vector loops, so
that a formula gives the same bits as LIGGGHTS.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from minidem.script.formula import FormulaError

__all__ = ["BINARY", "FUNCTIONS", "OF_ELEMENTS", "SERIES", "Value", "negate", "sign"]

_NEVER = 9 * 10**18

Value = float | NDArray[np.float64]
"""One number, or one number per particle."""


def _truth(value: Value | bool | NDArray[np.bool_]) -> Value:
    return value.astype(np.float64) if isinstance(value, np.ndarray) else float(value)


def _no_zero(value: Value, what: str) -> None:
    if np.any(np.asarray(value) == 0.0):
        raise FormulaError(what)


def _each(function: Callable[..., float], *values: Value) -> Value:
    """Apply a function of numbers to numbers or arrays."""
    try:
        if not any(isinstance(value, np.ndarray) for value in values):
            return function(*values)
        columns = np.broadcast_arrays(*values)
        count = columns[0].size
        return np.fromiter(map(function, *(c.tolist() for c in columns)), np.float64, count)
    except OverflowError:
        # C returns infinity where Python raises.
        return np.inf


def _divide(a: Value, b: Value) -> Value:
    _no_zero(b, "division by zero")
    with np.errstate(over="ignore", invalid="ignore"):
        return a / b


def _modulo(a: Value, b: Value) -> Value:
    _no_zero(b, "modulo by zero")
    return _each(_fmod, a, b)


def _fmod(a: float, b: float) -> float:
    return math.nan if math.isinf(a) else math.fmod(a, b)


def _power(a: Value, b: Value) -> Value:
    _no_zero(b, "exponent zero is refused, as in LIGGGHTS")
    return _each(_pow, a, b)


def _pow(a: float, b: float) -> float:
    try:
        return math.pow(a, b)
    except OverflowError:
        return -math.inf if a < 0 and math.fmod(b, 2.0) else math.inf
    except ValueError:
        # A zero to a negative power is infinite in C, a negative to a fraction is not a number.
        return math.inf if a == 0 else math.nan


def _quiet(function: Callable[[Value, Value], Value]) -> Callable[[Value, Value], Value]:
    def apply(a: Value, b: Value) -> Value:
        with np.errstate(over="ignore", invalid="ignore"):
            return function(a, b)

    return apply


BINARY: dict[str, Callable[[Value, Value], Value]] = {
    "+": _quiet(lambda a, b: a + b),
    "-": _quiet(lambda a, b: a - b),
    "*": _quiet(lambda a, b: a * b),
    "/": _divide,
    "%": _modulo,
    "^": _power,
    "==": lambda a, b: _truth(a == b),
    "!=": lambda a, b: _truth(a != b),
    "<": lambda a, b: _truth(a < b),
    "<=": lambda a, b: _truth(a <= b),
    ">": lambda a, b: _truth(a > b),
    ">=": lambda a, b: _truth(a >= b),
    "&&": lambda a, b: _truth(np.logical_and(a, b)),
    "||": lambda a, b: _truth(np.logical_or(a, b)),
}
"""Binary operators; comparisons give 1 or 0."""


def negate(value: Value) -> Value:
    """Return 1 where `value` is zero, else 0."""
    return _truth(value == 0.0)


def sign(operator: str, value: Value) -> Value:
    """Apply the prefix operator ``-`` or ``!``."""
    return -value if operator == "-" else negate(value)


def _checked(
    function: Callable[[float], float], valid: Callable[[float], bool], what: str
) -> Callable[[float], float]:
    def apply(x: float) -> float:
        if not valid(x):
            raise FormulaError(what)
        try:
            return function(x)
        except OverflowError:
            return math.inf
        except ValueError:
            return math.nan

    return apply


def _always(x: float) -> bool:
    del x
    return True


def _round(x: float) -> float:
    if not math.isfinite(x):
        return x
    low = math.floor(x)
    return float(math.ceil(x)) if x - low >= 0.5 else float(low)


def _whole(function: Callable[[float], int]) -> Callable[[float], float]:
    # copysign keeps the minus of ceil(-0.5), which C prints as -0.
    return lambda x: math.copysign(float(function(x)), x) if math.isfinite(x) else x


def _elementwise(function: Callable[..., float]) -> Callable[..., Value]:
    return lambda *values: _each(function, *values)


FUNCTIONS: dict[str, Callable[..., Value]] = {
    "sqrt": _elementwise(_checked(math.sqrt, lambda x: not x < 0, "square root of a negative")),
    "exp": _elementwise(_checked(math.exp, _always, "")),
    "ln": _elementwise(_checked(math.log, lambda x: not x <= 0, "logarithm of zero or less")),
    "log": _elementwise(_checked(math.log10, lambda x: not x <= 0, "logarithm of zero or less")),
    "abs": _elementwise(math.fabs),
    "sin": _elementwise(_checked(math.sin, _always, "")),
    "cos": _elementwise(_checked(math.cos, _always, "")),
    "tan": _elementwise(_checked(math.tan, _always, "")),
    "asin": _elementwise(_checked(math.asin, lambda x: not abs(x) > 1, "arcsine outside -1..1")),
    "acos": _elementwise(_checked(math.acos, lambda x: not abs(x) > 1, "arccosine outside -1..1")),
    "atan": _elementwise(math.atan),
    "atan2": _elementwise(math.atan2),
    "ceil": _elementwise(_whole(math.ceil)),
    "floor": _elementwise(_whole(math.floor)),
    "round": _elementwise(_round),
}
"""Functions without memory and without knowledge of the run."""


def _stagger(step: int, first: int, second: int) -> int:
    if first <= 0 or second <= 0 or first <= second:
        msg = f"stagger({first},{second}) needs first > second > 0"
        raise FormulaError(msg)
    lower = step // first * first
    return lower + second if step - lower < second else lower + first


def _logfreq(step: int, first: int, count: int, base: int) -> int:
    if first <= 0 or count <= 0 or base <= 0 or count >= base:
        msg = f"logfreq({first},{count},{base}) needs positive numbers, the second below the third"
        raise FormulaError(msg)
    if step < first:
        return first
    lower = first
    while step >= base * lower:
        lower *= base
    multiple = step // lower
    return (multiple + 1) * lower if multiple < count else lower * base


def _stride(step: int, first: int, last: int, every: int) -> int:
    if first < 0 or last < 0 or every <= 0 or first > last:
        msg = f"stride({first},{last},{every}) needs 0 <= first <= last and every > 0"
        raise FormulaError(msg)
    if step < first:
        return first
    following = step - (step - first) % every + every
    return following if step < last and following <= last else _NEVER


OF_ELEMENTS: dict[str, Callable[..., float]] = {
    "sum": np.sum,
    "min": np.min,
    "max": np.max,
    "ave": np.mean,
}
SERIES: dict[str, Callable[..., int]] = {
    "stagger": _stagger,
    "logfreq": _logfreq,
    "stride": _stride,
}
