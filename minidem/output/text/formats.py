"""C formats given in a script, checked before they are used."""

from __future__ import annotations

import re
from typing import Final

from minidem.errors import InputError

__all__ = ["FLOAT_DEFAULT", "INT_DEFAULT", "column_formats", "read_format"]

FLOAT_DEFAULT: Final = "%g"
INT_DEFAULT: Final = "%d"

_CONVERSION: Final = re.compile(
    r"(?P<before>(?:[^%]|%%)*)%(?P<flags>[-+ #0]*)(?P<width>\d{0,3})(?P<precision>(?:\.\d{0,3})?)"
    r"(?:hh|h|ll|l|L)?(?P<kind>[diuxXoeEfFgG])(?P<after>(?:[^%]|%%)*)"
)


def read_format(text: str, *, integer: bool) -> str:
    """Return a C format with one conversion as a Python format.

    Parameters
    ----------
    text : str
        Such as ``%.17g`` or ``%8d``.
    integer : bool
        Whether it is for whole numbers.

    Returns
    -------
    str
        The same without length modifiers.

    Raises
    ------
    InputError
        If it is not exactly one conversion of a number of that kind.

    Examples
    --------
    >>> read_format("%.8lg", integer=False)
    '%.8g'
    """
    found = _CONVERSION.fullmatch(text) if len(text) <= 200 else None
    if found is None or (found["kind"] in "diuxXo") != integer:
        wanted = "a whole number, such as %d" if integer else "a number, such as %g or %.17g"
        msg = f"format '{text[:40]}' must have one conversion for {wanted}"
        raise InputError(msg)
    parts = ("before", "%", "flags", "width", "precision", "kind", "after")
    return "".join(part if part == "%" else found[part] for part in parts)


def column_formats(text: str | None, integers: list[bool]) -> list[str]:
    """Return one Python format per column.

    Parameters
    ----------
    text : str or None
        The formats as ``dump_modify ... format`` gives them, separated by blanks; None for the
        defaults ``%d`` and ``%g``.
    integers : list of bool
        Which columns hold whole numbers.

    Raises
    ------
    InputError
        If the number of formats differs from that of columns, or one does not fit its column.
    """
    if text is None:
        return [INT_DEFAULT if integer else FLOAT_DEFAULT for integer in integers]
    words = text.split()
    if len(words) != len(integers):
        msg = f"dump_modify format has {len(words)} formats for {len(integers)} columns"
        raise InputError(msg)
    return [
        read_format(word, integer=integer) for word, integer in zip(words, integers, strict=True)
    ]
