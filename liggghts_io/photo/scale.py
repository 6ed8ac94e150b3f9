"""The scale of a photograph from what a person writes: pixels per length, or two points."""

from __future__ import annotations

import math
import re
from typing import Final

from liggghts_io.errors import CaseError, nearest

LENGTHS: Final = {
    "m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "μm": 1e-6, "nm": 1e-9, "in": 0.0254,
}  # fmt: skip
"""Units of length [m]; the micro sign and the Greek letter look alike."""

FINEST_M: Final = 1e-8
COARSEST_M: Final = 1e-2
"""Size of a pixel: from a microscope's to one that grains cannot be seen with."""

_NUMBER: Final = r"[+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][+-]?\d+)?"
_RATIO: Final = re.compile(rf"\s*({_NUMBER})\s*([^\s\d/]+)\s*/\s*([^\s\d/]+)\s*")
_LENGTH: Final = re.compile(rf"\s*({_NUMBER})\s*([^\s\d]*)\s*")
_PIXEL: Final = ("px", "pixel", "pixels")
_POINT_NUMBERS: Final = 4
_EXAMPLE: Final = "write it as 22.7px/mm"


def scale_of(text: str) -> float:
    """Return the size of a pixel [m] from words such as ``22.7px/mm`` or ``44um/px``.

    Raises
    ------
    CaseError
        If the text is no scale, has another unit or is out of all proportion.

    Examples
    --------
    >>> f"{scale_of('20px/mm'):g} {scale_of('50 um/px'):g}"
    '5e-05 5e-05'
    """
    match = _RATIO.fullmatch(text)
    if not match:
        msg = f"--scale {text}: is no scale; {_EXAMPLE}"
        raise CaseError(msg)
    number, above, below = _number(match[1]), match[2], match[3]
    if not number > 0.0:
        msg = f"--scale {text}: must be above 0; {_EXAMPLE}"
        raise CaseError(msg)
    if above.lower() in _PIXEL:
        metres = _unit(below, f"--scale {text}") / number
    elif below.lower() in _PIXEL:
        metres = number * _unit(above, f"--scale {text}")
    else:
        msg = f"--scale {text}: counts no pixels (px); {_EXAMPLE}"
        raise CaseError(msg)
    return checked_scale(metres, f"--scale {text}")


def length_of(text: str, place: str) -> float:
    """Return a length above 0 [m] from words such as ``10mm``.

    Parameters
    ----------
    text : str
    place : str
        Begins the message.

    Raises
    ------
    CaseError
        If the text is no such length.
    """
    match = _LENGTH.fullmatch(text)
    if not match or not match[2]:
        msg = f"{place}: '{text}' is no length with a unit; write it as 10mm"
        raise CaseError(msg)
    metres = _number(match[1]) * _unit(match[2], place)
    if not (metres > 0.0 and math.isfinite(metres)):
        msg = f"{place}: the length is {metres:g} m; it must be above 0"
        raise CaseError(msg)
    return metres


def scale_between(text: str) -> float:
    """Return the size of a pixel [m] from ``x1,y1,x2,y2,length``: two points and what lies between.

    Points are columns and rows [px].

    Raises
    ------
    CaseError
        If the text is no such list, or both points are one.

    Examples
    --------
    >>> f"{scale_between('100,50,300,50,10mm'):g}"
    '5e-05'
    """
    words = text.split(",")
    if len(words) != _POINT_NUMBERS + 1:
        msg = (
            f"--points {text}: has {len(words)} parts; write x1,y1,x2,y2,length: 100,50,300,50,10mm"
        )
        raise CaseError(msg)
    x1, y1, x2, y2 = points_of(",".join(words[:-1]), "--points")
    apart = math.hypot(x2 - x1, y2 - y1)
    metres = length_of(words[-1], f"--points {text}")
    return checked_scale(metres / apart, f"--points {text}")


def points_of(text: str, option: str) -> tuple[float, float, float, float]:
    """Return two points from ``x1,y1,x2,y2`` [px].

    Raises
    ------
    CaseError
        If the text is no such list, or both points are one.
    """
    words = text.split(",")
    if len(words) != _POINT_NUMBERS or not all(re.fullmatch(rf"\s*{_NUMBER}\s*", w) for w in words):
        msg = f"{option} {text}: are no two points; write columns and rows as 100,50,300,50"
        raise CaseError(msg)
    x1, y1, x2, y2 = (_number(word) for word in words)
    if not math.hypot(x2 - x1, y2 - y1) >= 1.0:
        msg = f"{option} {text}: both points are one; choose them far apart"
        raise CaseError(msg)
    return x1, y1, x2, y2


def checked_scale(metres: float, place: str) -> float:
    """Return the size of a pixel [m], or refuse one that no photograph of grains has."""
    if not FINEST_M <= metres <= COARSEST_M:
        msg = (
            f"{place}: makes a pixel {metres:.3g} m wide; photographs of grains have pixels from "
            f"{FINEST_M:g} to {COARSEST_M:g} m, so check number and unit"
        )
        raise CaseError(msg)
    return metres


def _number(word: str) -> float:
    return float(word.strip().replace(",", "."))


def _unit(word: str, place: str) -> float:
    if word not in LENGTHS:
        hint = nearest(word, ("mm", "cm", "m", "um", "in"))
        msg = f"{place}: unknown unit of length '{word}'{hint}"
        raise CaseError(msg)
    return LENGTHS[word]
