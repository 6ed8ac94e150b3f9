"""What a template of a stranger may spend: time, turns of loops, text, lists, numbers."""

from __future__ import annotations

import time
from typing import Any, Final

from liggghts_io.errors import CaseError

MOST_ITEMS: Final = 10_000
LONGEST: Final = 2_000_000
"""Characters of a text, and of a script."""

_LIMIT_S: Final = 5.0
_MOST_TURNS: Final = 100_000
_DEEPEST: Final = 3  # lists within lists
_LARGEST: Final = 1e15  # of a whole number


class Budget:
    """What is left of time, turns of loops and text for one script.

    Each method raises `CaseError` when there is no more.
    """

    def __init__(self) -> None:
        self._turns, self._text = 0, 0
        self._end = time.monotonic() + _LIMIT_S

    def turn(self) -> None:
        """Count a turn of a loop, or a call."""
        self._turns += 1
        if self._turns > _MOST_TURNS:
            refuse(f"more than {_MOST_TURNS} turns of loops")
        self.look()

    def look(self) -> None:
        """Look at the clock."""
        if time.monotonic() > self._end:
            refuse(f"takes longer than {_LIMIT_S:g} s")

    def write(self, made: str | list[Any] | tuple[Any, ...]) -> None:
        """Count a text that was made, or a list, each of its items as a character."""
        self._text += len(made)
        if self._text > LONGEST:
            refuse(f"more than {LONGEST} characters")
        self.look()


def refuse(what: str) -> None:
    """Refuse what is more than a script needs.

    Raises
    ------
    CaseError
    """
    msg = f"{what}; a script needs less than that: make it simpler"
    raise CaseError(msg)


def within(value: Any) -> Any:
    """Return a value that was made; refuse one that is too large to be needed.

    Raises
    ------
    CaseError
    """
    if isinstance(value, bool | float):
        return value
    if isinstance(value, int):
        if abs(value) > _LARGEST:
            refuse(f"a whole number beyond {_LARGEST:g}")
    elif isinstance(value, str):
        if len(value) > LONGEST:
            refuse(f"a text of more than {LONGEST} characters")
    elif isinstance(value, list | tuple):
        _check_list(value, _DEEPEST)
    return value


def _check_list(value: list[Any] | tuple[Any, ...], depth: int) -> int:
    """Return how many items a list holds, those of inner lists included."""
    if depth == 0:
        refuse(f"lists within lists, deeper than {_DEEPEST}")
    count = len(value)
    if count <= MOST_ITEMS:
        for item in value:
            count += _check_list(item, depth - 1) if isinstance(item, list | tuple) else 0
            if count > MOST_ITEMS:
                break
    if count > MOST_ITEMS:
        refuse(f"a list of more than {MOST_ITEMS} items")
    return count
