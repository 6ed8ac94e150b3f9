"""Reading of the words of a command: single words, and one after the other with `Words`."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from math import isfinite, nan

from minidem.errors import InputError, MistakeError, UnknownWordError, suggest
from minidem.record import field, record

__all__ = ["Words", "integer", "leading_numbers", "number", "one_of", "variables_in"]

_DIGITS = frozenset("0123456789+-.eE")
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_LEADING = re.compile(r"[+-]?[0-9]+")
_CUT = re.compile(r"[+-]?[0-9]+(?![0-9]*\.?[0-9]*[eE_])")
_WHOLE = re.compile(r"[+-]?[0-9]+(?![0-9]*(?:\.0*[1-9]|\.?[eE_]))")
_SHOWN = 40  # characters of a word that a message shows
_COMPARED = 80  # characters of a word that are compared with known ones
_NAMED = ("mesh", "region of")  # kinds of names that a script gives
_COMMA = re.compile(r"[+-]?[0-9]*,[0-9]+(?:[eE][+-]?[0-9]+)?")  # for the decimal point
_MOST_DIGITS = 18  # fit into 64 bits


@record
class _Reading:
    """How numbers are read at present.

    Attributes
    ----------
    loose : bool
        Whether anything may follow a number.
    tell : callable
        Takes a word of which only the beginning was read, and that beginning.
    told : set of str
        Words that were told.
    """

    loose: bool
    tell: Callable[[str, str], None]
    told: set[str] = field(default_factory=set)


_READING: ContextVar[_Reading | None] = ContextVar("reading", default=None)


@contextmanager
def leading_numbers(tell: Callable[[str, str], None], *, loose: bool) -> Iterator[None]:
    """Let numbers be read as far as LIGGGHTS reads them.

    Parameters
    ----------
    tell : callable
        Takes a word of which only the beginning is read, and that beginning.
    loose : bool
        Whether anything may follow a number (``4.05/2`` is 4.05), as in some commands; else only
        signs, points and digits may.
    """
    before = _READING.set(_Reading(loose, tell))
    try:
        yield
    finally:
        _READING.reset(before)


def _beginning(word: str, pattern: re.Pattern[str]) -> str:
    """Return the number that a word begins with, if more may follow it; '' if there is none."""
    reading = _READING.get()
    found = pattern.match(word)
    if reading is None or found is None:
        return ""
    if not (reading.loose or _DIGITS.issuperset(word)):
        return ""
    if word not in reading.told:
        reading.told.add(word)
        reading.tell(word, found.group())
    return found.group()


def number(word: str, what: str) -> float:
    """Return a word as a finite number, written as LIGGGHTS accepts it.

    Raises
    ------
    InputError
        Naming the word.
    """
    try:
        value = float(word) if _DIGITS.issuperset(word) else nan
    except ValueError:
        value = nan
    if value != value:
        value = float(_beginning(word, _NUMBER) or nan)
    if not isfinite(value):
        remedy = "; write a point, not a comma" if _COMMA.fullmatch(word) else ""
        msg = f"{what}: expected a number, found '{word[:_SHOWN]}'{remedy}"
        raise InputError(msg)
    return value


def integer(word: str, what: str, *, powers: bool = False) -> int:
    """Return a word as a whole number.

    Where LIGGGHTS reads leading digits only, what stands behind them is left out with a warning:
    ``33.3`` is 33. Of ``1e5`` it reads 1, which nobody means; that is an error but with `powers`.

    Raises
    ------
    InputError
        Naming the word.
    """
    digits = word.removeprefix("-").removeprefix("+")
    if not (digits.isascii() and digits.isdigit()):
        reading = _READING.get()
        cut = _LEADING if powers else _CUT
        digits = _beginning(word, cut if reading and reading.loose else _WHOLE)
        word = digits or word
    if not digits or len(digits) > _MOST_DIGITS:
        msg = f"{what}: expected a whole number, found '{word[:_SHOWN]}'"
        raise InputError(msg)
    return int(word)


def variables_in(words: Iterable[object]) -> tuple[str, ...]:
    """Return the names of the variables among inputs as ``v_NAME``."""
    shown = [word for word in words if isinstance(word, str)]
    return tuple(word[2:].partition("[")[0] for word in shown if word.startswith("v_"))


def one_of(word: str, known: Sequence[str], what: str) -> str:
    """Return the word if it is known.

    Raises
    ------
    InputError
        With the nearest known word.
    """
    if word not in known:
        near = suggest(word[:_COMPARED], known)
        msg = f"unknown {what} '{word[:_SHOWN]}'{near} (known: {', '.join(known)})"
        # a name that the script gives itself is no word of the language
        own = what.startswith(_NAMED) or what.endswith(" ID")
        raise MistakeError(msg) if own else UnknownWordError(msg)
    return word


class Words:
    """A cursor over the words of a command; all methods raise InputError for an unfit word.

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

    def need(self, count: int, usage: str) -> None:
        """Refuse fewer than `count` words still to be read."""
        if len(self._words) - self._at < count:
            msg = f"too few words; usage: {usage}"
            raise MistakeError(msg)

    def take(self, expected: str) -> str:
        """Read a word; `expected` says in a message which one is missing."""
        if self.done():
            after = f" after '{self._words[self._at - 1][:_SHOWN]}'" if self._at else ""
            msg = f"{self._what}: expected {expected}{after}"
            raise InputError(msg)
        self._at += 1
        return self._words[self._at - 1]

    def rest(self) -> list[str]:
        """Read all words that are left."""
        found = list(self._words[self._at :])
        self._at = len(self._words)
        return found

    def finish(self) -> None:
        """Refuse words that nobody has read."""
        if not self.done():
            msg = f"{self._what}: unexpected word '{self.peek()[:_SHOWN]}' at the end"
            raise InputError(msg)

    def expect(self, *wanted: str) -> None:
        """Read words that must be there."""
        for word in wanted:
            found = self.take(f"'{word}'")
            if found != word:
                msg = f"{self._what}: expected '{word}', found '{found[:_SHOWN]}'"
                raise InputError(msg)

    def choice(self, choices: Sequence[str], what: str = "keyword") -> str:
        """Read one of several words."""
        word = self.take(f"one of {', '.join(choices)}")
        return one_of(word, choices, f"{self._what} {what}")

    def number(self) -> float:
        """Read a finite number."""
        return number(self.take("a number"), self._what)

    def numbers(self, count: int) -> list[float]:
        """Read some finite numbers."""
        return [self.number() for _ in range(count)]

    def positive(self) -> float:
        """Read a number above zero."""
        value = self.number()
        if value <= 0.0:
            msg = f"{self._what}: expected a number above zero, found {value:g}"
            raise InputError(msg)
        return value

    def integer(self) -> int:
        """Read a whole number, written without point and exponent."""
        return integer(self.take("a whole number"), self._what)

    def count(self, least: int | None = None) -> int:
        """Read a whole number of which nothing but the leading digits counts, even of 1e6."""
        value = integer(self.take("a whole number"), self._what, powers=True)
        if least is not None and value < least:
            msg = f"{self._what}: expected at least {least}, found {value}"
            raise InputError(msg)
        return value

    def interval(self, least: int = 1) -> int:
        """Read a number of steps."""
        value = self.integer()
        if value < least:
            fault = "negative" if value < 0 else "not positive"
            msg = f"{self._what}: the interval {value} is {fault}"
            raise InputError(msg)
        return value

    def yes_no(self) -> bool:
        """Read yes or no."""
        return self.choice(("yes", "no"), "value") == "yes"

    def variable(self) -> str:
        """Read ``v_NAME``; return the name."""
        word = self.take("a variable v_NAME")
        if not word.startswith("v_"):
            msg = f"{self._what}: expected a variable v_NAME, found '{word[:_SHOWN]}'"
            raise InputError(msg)
        return word[2:]
