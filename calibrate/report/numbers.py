"""Numbers as text: as many digits as their error justifies."""

from __future__ import annotations

import math

from calibrate.inference import Interval

__all__ = ["band", "pair", "plus_minus", "signed"]


def _decimals(error: float) -> int:
    """Return the decimals that show an error with two significant digits.

    Examples
    --------
    >>> _decimals(0.034)
    3
    """
    if not (math.isfinite(error) and error > 0.0):
        return 2
    return max(0, 1 - math.floor(math.log10(error)))


def plus_minus(value: float, error: float) -> str:
    """Return ``value ± error``.

    Examples
    --------
    >>> plus_minus(38.2812, 0.61)
    '38.28 ± 0.61'
    """
    digits = _decimals(error)
    if not math.isfinite(value):
        return "n/a"
    spread = f"{error:.{digits}f}" if math.isfinite(error) else "?"
    return f"{value:.{digits}f} ± {spread}"


def pair(first: tuple[float, float], second: tuple[float, float]) -> tuple[str, str]:
    """Return two values with errors as text, each with its own digits."""
    return plus_minus(*first), plus_minus(*second)


def signed(value: float, unit: str = "") -> str:
    """Return a number with its sign, or n/a when there is none.

    Examples
    --------
    >>> signed(-1.25, " %")
    '-1.2 %'
    """
    return f"{value:+.1f}{unit}" if math.isfinite(value) else "n/a"


def band(interval: Interval) -> str:
    """Return an interval; an end that only the searched range sets is marked.

    Examples
    --------
    >>> band(Interval(0.05, 0.21, True, False))
    '≤ 0.050 to 0.210'
    """
    low = ("≤ " if interval.open_low else "") + f"{interval.low:.3f}"
    high = ("≥ " if interval.open_high else "") + f"{interval.high:.3f}"
    return f"{low} to {high}"
