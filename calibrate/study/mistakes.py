"""All mistakes found in a study file, each with its line, to be told together."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from calibrate.errors import CalibrationError, StudyError
from liggghts_io.errors import CaseError
from liggghts_io.toml_lines import Key, Lines

__all__ = ["Key", "Lines", "Mistakes"]

MOST_NOTED: Final = 400
"""Mistakes after which looking for more ends: a message lists a tenth of them."""


class Mistakes:
    """Mistakes of a study, each with its place.

    Parameters
    ----------
    path : Path or str
        Study file, or what else holds them.
    lines : Lines
        Where things stand in it.
    """

    def __init__(self, path: Path | str, lines: Lines) -> None:
        self._path, self._lines = path, lines
        self._found: list[tuple[int, str]] = []

    def __bool__(self) -> bool:
        """Whether there are any."""
        return bool(self._found)

    def add(self, key: Key, message: str) -> None:
        """Note a mistake at a key; the same one at the same place is told once.

        Raises
        ------
        StudyError
            With all mistakes, when there are so many that nobody reads more.
        """
        line = self._lines.of(key)
        place = f"{self._path}:{line}" if line else str(self._path)
        entry = (line or 0, f"{place}: {message}")
        if entry not in self._found:
            self._found.append(entry)
        if len(self._found) >= MOST_NOTED:
            self.tell()

    @contextmanager
    def noting(self, key: Key) -> Iterator[None]:
        """Note what a block refuses, and go on behind it."""
        try:
            yield
        except StudyError:
            raise
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
