"""Errors of the calibration layer, and the hint that ends their messages."""

from __future__ import annotations

import difflib
import signal
from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import Final

__all__ = [
    "BugError",
    "CalibrationError",
    "StudyError",
    "Terminated",
    "suggest",
    "unknown_name",
]


MOST_SHOWN: Final = 40
"""Mistakes that one message lists."""

_MOST_COMPARED: Final = 20
"""Known words that are compared letter by letter with one that is unknown."""
_LONGEST_WORD: Final = 200
"""Letters that are compared; names are shorter."""


class CalibrationError(RuntimeError):
    """Raised when a study, its data or a calibration step cannot be used as given.

    The message names the place, the value and a remedy; the command line shows it without a
    traceback and ends with exit code 2.
    """


class BugError(RuntimeError):
    """Raised when work ends for a fault of this program, not of its user; exit code 1.

    The message asks for a report and says with what.
    """


class Terminated(BaseException):
    """Raised when SIGTERM comes, or SIGHUP as a terminal goes away; work ends as with Ctrl-C.

    Parameters
    ----------
    number : int
        Of the signal.
    """

    def __init__(self, number: int = signal.SIGTERM) -> None:
        super().__init__(number)
        self.code = 128 + number
        """Exit code, as shells count it: 143, or 129."""


class StudyError(CalibrationError):
    """All mistakes of a study at once.

    Parameters
    ----------
    mistakes : sequence of str
        One message each, with file, line, value and remedy.
    """

    def __init__(self, mistakes: Sequence[str]) -> None:
        self.mistakes = tuple(mistakes)
        shown = list(mistakes[:MOST_SHOWN])
        if len(mistakes) > MOST_SHOWN:
            shown.append(f"and {len(mistakes) - MOST_SHOWN} more")
        head = [f"{len(mistakes)} mistakes:"] if len(mistakes) > 1 else []
        super().__init__("\n".join([*head, *shown]))

    def __reduce__(self) -> tuple[type[StudyError], tuple[tuple[str, ...]]]:
        """Return how to copy it to another process."""
        return type(self), (self.mistakes,)


def suggest(word: str, known: Iterable[str]) -> str:
    """Return ``; did you mean 'x'?`` for the nearest known word, or an empty string.

    Examples
    --------
    >>> suggest("surfce", ["surface", "scale"])
    "; did you mean 'surface'?"
    """
    near = difflib.get_close_matches(word[:_LONGEST_WORD], _like(word, list(known)), n=1)
    return f"; did you mean '{near[0]}'?" if near else ""


def _like(word: str, known: Sequence[str]) -> Sequence[str]:
    """Return the known words that share the most pairs of letters with a word.

    Comparing with each of hundreds takes long where thousands of words are unknown.
    """
    if len(known) <= _MOST_COMPARED:
        return known
    pairs = _pairs(word[:_LONGEST_WORD])
    return sorted(known, key=lambda one: -len(pairs & _pairs(one)))[:_MOST_COMPARED]


@lru_cache(maxsize=4096)
def _pairs(word: str) -> frozenset[str]:
    return frozenset(word[k : k + 2] for k in range(len(word) - 1))


def unknown_name(word: str, known: Iterable[str]) -> str:
    """Return the end of a message about a name that is not known: the nearest one, or all.

    Examples
    --------
    >>> unknown_name("heep", ["heap", "conveyor"])
    "unknown name 'heep'; did you mean 'heap'?"
    >>> unknown_name("x", ["heap", "conveyor"])
    "unknown name 'x'; known names: heap, conveyor"
    """
    names = list(known)
    near = suggest(word, names) or f"; known names: {', '.join(names)}"
    return f"unknown name '{word}'{near}"
