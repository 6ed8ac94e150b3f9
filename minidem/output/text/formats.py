"""C formats given in a script, checked before they are used."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from minidem.errors import InputError

__all__ = ["FLOAT_DEFAULT", "INT_DEFAULT", "TEXT_DEFAULT", "column_formats", "read_format"]

FLOAT_DEFAULT: Final = "%g"
INT_DEFAULT: Final = "%d"
TEXT_DEFAULT: Final = "%s"

_CONVERSION: Final = re.compile(
    r"(?P<before>(?:[^%]|%%)*)%(?P<flags>[-+ #0]*)(?P<width>\d{0,3})(?P<precision>(?:\.\d{0,3})?)"
    r"(?:hh|h|ll|l|L)?(?P<kind>[diuxXoeEfFgGs])(?P<after>(?:[^%]|%%)*)"
)


def read_format(text: str, *, integer: bool, words: bool = False) -> str:
    """Return a C format with one conversion as a Python format.

    Parameters
    ----------
    text : str
        Such as ``%.17g`` or ``%8d``.
    integer : bool
        Whether it is for whole numbers.
    words : bool
        Whether it is for words, which ``%s`` is for.

    Returns
    -------
    str
        The same without length modifiers.

    Raises
    ------
    InputError
        If it is not exactly one conversion of a value of that kind.

    Examples
    --------
    >>> read_format("%.8lg", integer=False)
    '%.8g'
    """
    found = _CONVERSION.fullmatch(text) if len(text) <= 200 else None
    kinds = "s" if words else "diuxXo" if integer else "eEfFgG"
    if found is None or found["kind"] not in kinds:
        wanted = "a whole number, such as %d" if integer else "a number, such as %g or %.17g"
        wanted = "a name, such as %s" if words else wanted
        msg = f"format '{text[:40]}' must have one conversion for {wanted}"
        raise InputError(msg)
    parts = ("before", "%", "flags", "width", "precision", "kind", "after")
    return "".join(part if part == "%" else found[part] for part in parts)


def column_formats(
    text: str | None, integers: Sequence[bool], words: Sequence[bool] = ()
) -> list[str]:
    """Return one Python format per column.

    Parameters
    ----------
    text : str or None
        The formats as ``dump_modify ... format`` gives them, separated by blanks; None for the
        defaults ``%d``, ``%g`` and ``%s``.
    integers : sequence of bool
        Which columns hold whole numbers.
    words : sequence of bool
        Which columns hold words, none by default.

    Raises
    ------
    InputError
        If the number of formats differs from that of columns, or one does not fit its column.
    """
    kinds = list(zip(integers, words or [False] * len(integers), strict=True))
    if text is None:
        return [
            TEXT_DEFAULT if word else INT_DEFAULT if integer else FLOAT_DEFAULT
            for integer, word in kinds
        ]
    given = text.split()
    if len(given) != len(kinds):
        msg = f"dump_modify format has {len(given)} formats for {len(kinds)} columns"
        raise InputError(msg)
    return [
        read_format(one, integer=integer, words=word)
        for one, (integer, word) in zip(given, kinds, strict=True)
    ]
