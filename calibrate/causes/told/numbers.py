"""Numbers as sentences and tables of a diagnosis say them."""

from __future__ import annotations

__all__ = ["short", "with_unit"]


def short(value: float) -> str:
    """Return three digits, without a power of ten where the number is an everyday one.

    Examples
    --------
    >>> short(71_966.0), short(0.004567), short(-5.0)
    ('72000', '0.00457', '-5')
    """
    return f"{float(f'{value:.3g}'):.9g}"


def with_unit(text: str, unit: str) -> str:
    """Return a number with its unit, if it has one.

    Examples
    --------
    >>> with_unit("3", "deg"), with_unit("3", "-")
    ('3 deg', '3')
    """
    return text if unit in ("", "-") else f"{text} {unit}"
