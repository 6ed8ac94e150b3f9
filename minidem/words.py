"""Reading of the words of a command one after the other."""

from __future__ import annotations

import math
from collections.abc import Sequence

from minidem.errors import suggest

__all__ = ["Words"]


class Words:
    """A cursor over the words of a command.

    Parameters
    ----------
    words : sequence of str
        The words.
    what : str
        Name of the command for messages.
    """

    def __init__(self, words: Sequence[str], what: str) -> None:
        self._words = tuple(words)
        self._at = 0
        self._what = what

    def done(self) -> bool:
        """Tell whether all words are read."""
        return self._at >= len(self._words)

    def peek(self) -> str:
        """Return the next word without reading it, '' at the end."""
        return "" if self.done() else self._words[self._at]

    def take(self, expected: str) -> str:
        """Read a word; ValueError if there is none."""
        if self.done():
            after = f" after '{self._words[self._at - 1][:40]}'" if self._at else ""
            msg = f"{self._what}: expected {expected}{after}"
            raise ValueError(msg)
        self._at += 1
        return self._words[self._at - 1]

    def choice(self, choices: Sequence[str]) -> str:
        """Read one of several words."""
        word = self.take(f"one of {', '.join(choices)}")
        if word not in choices:
            hint = suggest(word[:80], choices) or f"; expected one of {', '.join(choices)}"
            msg = f"{self._what}: unknown word '{word[:40]}'{hint}"
            raise ValueError(msg)
        return word

    def number(self) -> float:
        """Read a finite number."""
        word = self.take("a number")
        try:
            value = float(word.replace("_", "?"))
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            msg = f"{self._what}: expected a number, got '{word[:40]}'"
            raise ValueError(msg)
        return value

    def positive(self) -> float:
        """Read a number above zero."""
        value = self.number()
        if value <= 0.0:
            msg = f"{self._what}: expected a number above zero, got {value:g}"
            raise ValueError(msg)
        return value

    def integer(self) -> int:
        """Read a whole number."""
        value = self.number()
        if value != int(value):
            msg = f"{self._what}: expected a whole number, got {value:g}"
            raise ValueError(msg)
        return int(value)

    def yes_no(self) -> bool:
        """Read yes or no."""
        return self.choice(("yes", "no")) == "yes"
