"""Words of the form name=value+-error: a measurement that is supposed to have been made."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Final

from calibrate.causes.studies.suppose import Supposed
from calibrate.errors import CalibrationError

__all__ = ["supposed_of"]

BETWEEN: Final = re.compile(r"\+/-|\+-|±")
"""What stands between a value and its standard error."""


def supposed_of(option: str, words: Sequence[str]) -> list[Supposed]:
    """Read ``name=value+-error`` or ``name:where=value±error``, with spaces anywhere between.

    Parameters
    ----------
    option : str
        Option they belong to, for the message.
    words : sequence of str

    Raises
    ------
    CalibrationError
        With the word, what is wrong with it and what would be right.

    Examples
    --------
    >>> [one.word for one in supposed_of("--with", ["plate_period = 0 ± 0.005"])]
    ['plate_period=0+-0.005']
    """
    found: dict[str, Supposed] = {}
    for word in words:
        one = _read(option, word)
        if one.called in found:
            msg = f"{option} {word}: '{one.called}' is given twice; join the measurements into one"
            raise CalibrationError(msg)
        found[one.called] = one
    return list(found.values())


def _read(option: str, word: str) -> Supposed:
    place = f"{option} {word}"
    called, equals, result = word.partition("=")
    name, colon, where = (part.strip() for part in called.partition(":"))
    numbers = BETWEEN.split(result)
    if not equals or not name or (colon and not where) or len(numbers) > 2:
        msg = (
            f"{place}: write {option} NAME=VALUE+-ERROR or NAME:WHERE=VALUE+-ERROR, for example "
            f'{option} "plate_period=0+-0.005"'
        )
        raise CalibrationError(msg)
    if len(numbers) < 2:
        msg = (
            f"{place}: has no standard error; a measurement without one says nothing, so write "
            f'{option} "{called.strip()}={result.strip()}+-0.01" with the error of yours'
        )
        raise CalibrationError(msg)
    value, se = (_number(place, text.strip()) for text in numbers)
    if se <= 0.0:
        msg = f"{place}: standard error {se:g}: give a number above 0"
        raise CalibrationError(msg)
    return Supposed(name, where, value, se)


def _number(place: str, text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        msg = f"{place}: '{text}' is not a number"
        raise CalibrationError(msg)
    return number
