"""Errors of the case layer, and the hint that ends their messages."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from difflib import get_close_matches
from typing import Any, Final

_PLAIN: Final = {
    "Value error, ": "", "Input should be": "must be", "Input should have": "must have",
    "greater than or equal to": "at least", "less than or equal to": "at most",
    "greater than": "above", "less than": "below",
    "a valid integer": "a whole number", "a valid boolean": "true or false",
    "a valid tuple": "a list", "a valid string": "a text in quotes", "a valid ": "a ",
    "String should match pattern '^[a-z][a-z0-9_]{0,39}$'": (
        "write at most 40 small letters, digits and _, a letter first"
    ),
    "String should match pattern '^[A-Za-z][A-Za-z0-9_]{0,63}$'": (
        "write at most 64 letters, digits and _, a letter first"
    ),
    "String should match pattern '^[A-Za-z0-9_]+$'": "write letters, digits and _ only",
    ", unable to parse string as an integer": "", ", unable to parse string as a number": "",
}  # fmt: skip
"""What pydantic says, and how a person would."""
_COUNTS: Final = {
    r"(?:Tuple|List) should have at (most|least) (\d+) items? after validation, not (\d+)": (
        r"has \3 entries where there must be at \1 \2"
    ),
    r"String should have at least \d+ characters?": "is empty; give it a name",
    r"a valid dictionary or instance of \w+": "a table",
}
"""The same for messages with numbers in them."""


class CaseError(RuntimeError):
    """Raised when a case cannot be described, written, run or read.

    The message names the place, the value and a remedy; the command line shows it without a
    traceback and ends with exit code 2.
    """


class DamagedFile(CaseError):  # noqa: N818 - named after what the reader finds
    """Raised when a file that an engine or this package wrote is missing, cut or changed.

    It says nothing about the grains: no number and no reason of a run follow from it.
    """


class DiskFull(CaseError):  # noqa: N818 - named after what happened
    """Raised when a file of a case cannot be written because the disk is full or broken."""


def nearest(word: str, known: Sequence[str]) -> str:
    """Return the hint that ends a message about an unknown word.

    Parameters
    ----------
    word : str
        What was written.
    known : sequence of str
        All words that would have been right.

    Returns
    -------
    str
        The nearest known word as a question, where one is near, and all known words.

    Examples
    --------
    >>> nearest("steal", ["steel", "glued"])
    "; did you mean 'steel'? (known: steel, glued)"
    """
    close = get_close_matches(word, known, n=1, cutoff=0.4)
    hint = f"; did you mean {close[0]!r}?" if close else ""
    return f"{hint} (known: {', '.join(known)})"


def told(finding: Mapping[str, Any]) -> str:
    """Return what pydantic found wrong with a value, in plain words.

    Parameters
    ----------
    finding : mapping
        One of `ValidationError.errors()`.

    Returns
    -------
    str
        What the value must be.

    Examples
    --------
    >>> told({"msg": "Input should be greater than or equal to 10"})
    'must be at least 10'
    """
    message = str(finding["msg"])
    for pattern, plain in _COUNTS.items():
        message = re.sub(pattern, plain, message)
    for words, plain in _PLAIN.items():
        message = message.replace(words, plain)
    return message
