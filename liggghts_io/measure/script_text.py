"""A LIGGGHTS script as lines of words: continuations joined, comments gone."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final

_WORD: Final = re.compile(r'"([^"]*)"|\'([^\']*)\'|([^\s"\']+)')
_BLANK: Final = " \t\r\v\f"
_PIECES: Final = re.compile(r'"[^"]*"|\'[^\']*\'|#|[^"\'#]+|["\']')


def logical_lines(text: str) -> Iterator[tuple[int, str]]:
    """Yield number and text of every line of commands.

    Lines that end in ``&`` are joined with the next, comments and empty lines are left out.
    """
    start, held = 0, ""
    for number, line in enumerate(text.split("\n"), start=1):
        start = start or number
        # LIGGGHTS looks at the last character before it takes the comment away.
        bare = line.rstrip(_BLANK)
        if bare.endswith("&"):
            held += bare[:-1]
            continue
        command = _without_comment(held + bare).strip()
        if command:
            yield start, command
        start, held = 0, ""
    if held.strip():
        yield start, _without_comment(held).strip()


def words_of(line: str) -> list[str]:
    """Return the words of a line of commands; what stands in quotes is one word."""
    return [
        next(part for part in found if part) if any(found) else "" for found in _WORD.findall(line)
    ]


def quoted_in(line: str) -> list[str]:
    """Return what stands in quotes in a line."""
    return [one or other for one, other, bare in _WORD.findall(line) if not bare]


def _without_comment(line: str) -> str:
    kept = []
    for piece in _PIECES.findall(line):
        if piece == "#":
            break
        kept.append(piece)
    return "".join(kept)
