"""Where something stands in a study file, and all mistakes found in it, to be told together."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final, TypeAlias

from calibrate.errors import CalibrationError, StudyError
from liggghts_io.errors import CaseError

__all__ = ["Key", "Lines", "Mistakes"]

Key: TypeAlias = tuple[str | int, ...]
"""Way to a value in a study, for example ``("stage", 0, "free", "mu_pp")``."""

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
                table = self._open(_names(header[2]), repeated=header[1] == "[[")
                self._lines.setdefault(table, number)
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


class Mistakes:
    """Mistakes of a study, each with its place.

    Parameters
    ----------
    path : Path
        Study file.
    lines : Lines
        Where things stand in it.
    """

    def __init__(self, path: Path, lines: Lines) -> None:
        self._path, self._lines = path, lines
        self._found: list[tuple[int, str]] = []

    def __bool__(self) -> bool:
        """Whether there are any."""
        return bool(self._found)

    def add(self, key: Key, message: str) -> None:
        """Note a mistake at a key; the same one at the same place is told once."""
        line = self._lines.of(key)
        place = f"{self._path}:{line}" if line else str(self._path)
        entry = (line or 0, f"{place}: {message}")
        if entry not in self._found:
            self._found.append(entry)

    @contextmanager
    def noting(self, key: Key) -> Iterator[None]:
        """Note what a block refuses, and go on behind it."""
        try:
            yield
        except (CalibrationError, CaseError) as err:
            self.add(key, str(err))

    def tell(self) -> None:
        """Raise all mistakes as one error, if there are any.

        Raises
        ------
        StudyError
        """
        if self._found:
            raise StudyError([message for _, message in sorted(self._found)])
