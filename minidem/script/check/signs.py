"""Signs that word processors and web pages put in place of plain ones, which no engine reads."""

from __future__ import annotations

import re
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
_QUOTED: Final = re.compile(r"\"[^\"]*\"|'[^']*'")


def foreign_signs(line: str, message: str = "") -> str:
    """Return what to say of such signs in a line of a script; empty if there are none.

    In quoted text they may be meant, and count only where the message of a mistake shows them.

    Examples
    --------
    >>> foreign_signs("print \N{LEFT DOUBLE QUOTATION MARK}done")
    'U+201C is a sign of word processors: write " in its place'
    """
    for sign in _QUOTED.sub("", strip_comment(line)) + message:
        if sign in _PLAIN:
            plain = _PLAIN[sign]
            return f"U+{ord(sign):04X} is a sign of word processors: write {plain} in its place"
    return ""
