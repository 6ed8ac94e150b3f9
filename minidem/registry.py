"""Tables of commands and fix styles; each family of commands registers its handlers here."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import isfinite, nan
from typing import TYPE_CHECKING, Any

from minidem.errors import suggest

if TYPE_CHECKING:
    from minidem.run.engine import Engine

__all__ = ["COMMANDS", "COMPUTES", "DUMPS", "FIXES", "Handler", "command", "compute", "dump", "fix"]

Handler = Callable[["Engine", Sequence[str]], None]
FixMaker = Callable[["Engine", str, str, str, Sequence[str]], Any]

COMMANDS: dict[str, Handler] = {}
"""Command word to handler(engine, words)."""

FIXES: dict[str, FixMaker] = {}
"""Fix style to maker(engine, name, style, group, words)."""

COMPUTES: dict[str, FixMaker] = {}
"""Compute style to maker, as for fixes."""

DUMPS: dict[str, FixMaker] = {}
"""Dump style to maker, as for fixes."""


def command(*names: str) -> Callable[[Handler], Handler]:
    """Register a handler for command words."""

    def register(handler: Handler) -> Handler:
        for name in names:
            COMMANDS[name] = handler
        return handler

    return register


def _styles(table: dict[str, FixMaker]) -> Callable[..., Callable[[FixMaker], FixMaker]]:
    def decorator(*names: str) -> Callable[[FixMaker], FixMaker]:
        def register(maker: FixMaker) -> FixMaker:
            for name in names:
                table[name] = maker
            return maker

        return register

    return decorator


fix = _styles(FIXES)
compute = _styles(COMPUTES)
dump = _styles(DUMPS)


_DIGITS = frozenset("0123456789+-.eE")


def number(word: str, what: str) -> float:
    """Return a word as a finite number, written as LIGGGHTS accepts it.

    Raises
    ------
    ValueError
        Naming the word.
    """
    try:
        value = float(word) if _DIGITS.issuperset(word) else nan
    except ValueError:
        value = nan
    if not isfinite(value):
        msg = f"{what}: expected a number, found '{word[:40]}'"
        raise ValueError(msg)
    return value


def integer(word: str, what: str) -> int:
    """Return a word as a whole number.

    Raises
    ------
    ValueError
        Naming the word.
    """
    digits = word.removeprefix("-").removeprefix("+")
    # 18 digits fit into 64 bits
    if not (digits.isascii() and digits.isdigit() and len(digits) <= 18):
        msg = f"{what}: expected a whole number, found '{word[:40]}'"
        raise ValueError(msg)
    return int(word)


def need(words: Sequence[str], count: int, usage: str) -> None:
    """Refuse too few words.

    Raises
    ------
    ValueError
        With the usage.
    """
    if len(words) < count:
        msg = f"too few words; usage: {usage}"
        raise ValueError(msg)


def one_of(word: str, known: Sequence[str], what: str) -> str:
    """Return the word if it is known.

    Raises
    ------
    ValueError
        With the nearest known word.
    """
    if word not in known:
        msg = f"unknown {what} '{word}'{suggest(word, known)} (known: {', '.join(known)})"
        raise ValueError(msg)
    return word


def yes_no(word: str, what: str) -> bool:
    """Return True for yes, False for no.

    Raises
    ------
    ValueError
        For anything else.
    """
    return one_of(word, ("yes", "no"), what) == "yes"
