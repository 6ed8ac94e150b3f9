"""Tables of the words that a script may use: one mechanism for commands, fixes, computes and so on.

A table stands beside the base class of what it holds: `minidem.world.fix.FIXES`,
`minidem.world.compute.COMPUTES`, `minidem.output.dump.DUMPS`, `minidem.output.columns.COLUMNS`,
`minidem.output.quantities.THERMO` and `minidem.commands.command.COMMANDS`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from importlib import import_module
from typing import NamedTuple, TypeVar

from minidem.words import one_of

__all__ = ["Head", "Registry"]

T = TypeVar("T")


class Head(NamedTuple):
    """What the commands ``fix``, ``compute`` and ``dump`` begin with.

    Attributes
    ----------
    name : str
        Id in the script.
    style : str
        Style as written.
    bit : int
        Bit of the group.
    """

    name: str
    style: str
    bit: int


class Registry(Mapping[str, T]):
    """Words and what they mean.

    Parameters
    ----------
    kind : str
        What its words are, for messages: ``fix``, ``dump column``.

    Examples
    --------
    >>> greetings = Registry("greeting")
    >>> @greetings.register("hello", "hi")
    ... def greet(): ...
    >>> sorted(greetings)
    ['hello', 'hi']
    """

    def __init__(self, kind: str) -> None:
        self.kind = kind
        self._entries: dict[str, T | None] = {}
        self._homes: dict[str, str] = {}

    def later(self, home: str, *words: str) -> None:
        """Say which module registers some words.

        It is imported when one of them is looked up: a script uses few of the words that there
        are, and importing all of them takes longer than many a script.

        Parameters
        ----------
        home : str
            Full name of the module.
        words : str
            All words that it registers in this table.
        """
        for word in words:
            self._entries.setdefault(word, None)
            self._homes[word] = home

    def register(self, *words: str) -> Callable[[T], T]:
        """Return a decorator that enters what it decorates under some words."""

        def enter(entry: T) -> T:
            for word in words:
                self._entries[word] = entry
            return entry

        return enter

    def find(self, word: str) -> T:
        """Return what a word of a script means.

        Raises
        ------
        InputError
            For an unknown word, with the nearest known one.
        """
        return self[one_of(word, tuple(self._entries), self.kind)]

    def __getitem__(self, word: str) -> T:
        """Return what a word means; KeyError for an unknown one."""
        if self._entries[word] is None:
            import_module(self._homes[word])
        entry = self._entries[word]
        if entry is None:
            msg = f"{self._homes[word]} does not register the {self.kind} '{word}'"
            raise KeyError(msg)
        return entry

    def __contains__(self, word: object) -> bool:
        """Whether there is such a word; imports nothing."""
        return word in self._entries

    def __iter__(self) -> Iterator[str]:
        """Go through the words in the order in which they were registered."""
        return iter(self._entries)

    def __len__(self) -> int:
        """Return the number of words."""
        return len(self._entries)
