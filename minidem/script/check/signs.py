"""Signs that word processors and web pages put in place of plain ones, which no engine reads."""

from __future__ import annotations

from typing import Final

from minidem.script.lexer import strip_comment

__all__ = ["foreign_signs"]

_PLAIN: Final = {
    "\N{LEFT DOUBLE QUOTATION MARK}": '"',
    "\N{RIGHT DOUBLE QUOTATION MARK}": '"',
    "\N{DOUBLE LOW-9 QUOTATION MARK}": '"',
    "\N{LEFT SINGLE QUOTATION MARK}": "'",
    "\N{RIGHT SINGLE QUOTATION MARK}": "'",
    "\N{MINUS SIGN}": "-",
    "\N{EN DASH}": "-",
    "\N{EM DASH}": "-",
    "\N{HYPHEN}": "-",
    "\N{NON-BREAKING HYPHEN}": "-",
    "\N{NO-BREAK SPACE}": "a blank",
    "\N{NARROW NO-BREAK SPACE}": "a blank",
    "\N{IDEOGRAPHIC SPACE}": "a blank",
    "\N{ZERO WIDTH SPACE}": "nothing",
    "\N{ZERO WIDTH NO-BREAK SPACE}": "nothing",
}
"""Sign: what belongs there."""


def foreign_signs(line: str) -> str:
    """Return what to say of such signs in a line of a script; empty if there are none.

    Examples
    --------
    >>> foreign_signs("print \N{LEFT DOUBLE QUOTATION MARK}done")
    'the line has U+201C, a sign of word processors: write " in its place'
    """
    for sign in strip_comment(line):
        if sign in _PLAIN:
            plain = _PLAIN[sign]
            return (
                f"the line has U+{ord(sign):04X}, a sign of word processors: "
                f"write {plain} in its place"
            )
    return ""
