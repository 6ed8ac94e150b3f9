"""Numbers as sentences and tables of a diagnosis say them."""

from __future__ import annotations

from collections.abc import Sequence

__all__ = ["result_words", "short", "with_unit"]


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


def result_words(values: Sequence[float], names: Sequence[str], units: Sequence[str]) -> str:
    """Return a result of one number as it is, of several with the name of each.

    Examples
    --------
    >>> result_words([0.15], ["plate_period"], ["-"])
    '0.15'
    >>> result_words([10.13, 34.0], ["t100_s", "angle_deg"], ["s", "deg"])
    't100_s 10.1 s, angle_deg 34 deg'
    """
    said = [with_unit(short(value), unit) for value, unit in zip(values, units, strict=True)]
    if len(said) == 1:
        return said[0]
    return ", ".join(f"{name} {one}" for name, one in zip(names, said, strict=True))
