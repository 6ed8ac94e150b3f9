"""Where the keys of a TOML text stand, which the parser of the standard library does not tell."""

from __future__ import annotations

import re
from typing import Final, TypeAlias

Key: TypeAlias = tuple[str | int, ...]
"""Way to a value, for example ``("observable", 0, "name")``."""

_NAME: Final = r"""(?:[A-Za-z0-9_-]+|"[^"]*"|'[^']*')"""
_DOTTED: Final = rf"{_NAME}(?:\s*\.\s*{_NAME})*"
_HEADER: Final = re.compile(rf"\s*(\[\[?)\s*({_DOTTED})\s*\]\]?\s*(?:#.*)?$")
_SETTING: Final = re.compile(rf"\s*({_DOTTED})\s*=(.*)$")
_STRING: Final = re.compile(r""""(?:[^"\\]|\\.)*"|'[^']*'|#.*""")


class Lines:
    """Lines on which the tables and keys of a TOML text stand.

    The parser of the standard library tells no positions. This reads headers and the keys that
    begin a line, and skips strings and lists that go over several lines; a key inside an inline
    table is found at the key that holds it.

    Parameters
    ----------
    text : str
        Valid TOML.
    """

    def __init__(self, text: str) -> None:
        self._lines: dict[Key, int] = {}
        self._count: dict[Key, int] = {}
        table: Key = ()
        quote, depth = "", 0  # of a string or list that is still open
        for number, line in enumerate(text.splitlines(), 1):
            if quote:
                quote = "" if line.count(quote) % 2 else quote
                continue
            if depth > 0:
                depth += _brackets(line)
                continue
            header, setting = _HEADER.match(line), _SETTING.match(line)
            if header:
                repeated = header[1] == "[["
                table = self._open(_names(header[2]), repeated=repeated)
                self._lines.setdefault(table, number)
                if repeated:  # the list itself stands where its first table does
                    self._lines.setdefault(table[:-1], number)
            elif setting:
                self._lines.setdefault((*table, *_names(setting[1])), number)
                quote = next((q for q in ('"""', "'''") if setting[2].count(q) % 2), "")
                depth = 0 if quote else _brackets(setting[2])

    def _open(self, names: list[str], *, repeated: bool) -> Key:
        """Return the way to a table; of a list of tables, to its last one."""
        key: Key = ()
        for position, name in enumerate(names):
            key = (*key, name)
            if repeated and position == len(names) - 1:
                self._count[key] = self._count.get(key, -1) + 1
            if key in self._count:
                key = (*key, self._count[key])
        return key

    def of(self, key: Key) -> int | None:
        """Return the line of a key or, without one, of what holds it; None for the whole file."""
        for length in range(len(key), 0, -1):
            if key[:length] in self._lines:
                return self._lines[key[:length]]
        return None


def _names(dotted: str) -> list[str]:
    return [name.strip("\"'") for name in re.findall(_NAME, dotted)]


def _brackets(text: str) -> int:
    """Return how many more brackets open than close, those in strings and comments left out."""
    bare = _STRING.sub("", text)
    return bare.count("[") - bare.count("]")
