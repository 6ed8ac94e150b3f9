"""One snapshot of a dump file: ``dump custom`` of LIGGGHTS or minidem, as text or by gzip."""

from __future__ import annotations

import gzip
import zlib
from collections.abc import Iterator, Sequence
from io import TextIOWrapper
from itertools import islice
from pathlib import Path
from typing import NoReturn

import numpy as np

from minidem.errors import InputError
from minidem.memory import check_room
from minidem.record import record
from minidem.words import integer, number
from minidem.world.state import Floats, Ints

__all__ = ["Snapshot", "find_snapshot"]

_STEP, _COUNT = "ITEM: TIMESTEP", "ITEM: NUMBER OF ATOMS"
_BOX, _ATOMS = "ITEM: BOX BOUNDS", "ITEM: ATOMS"
_SHOWN = 60  # characters of a line in a message
_GZIP = b"\x1f\x8b"
_LONGEST = 1 << 16  # characters of a line, so that a small compressed file takes no memory
_MOST = 1 << 30  # characters of the lines of a snapshot


@record(frozen=True)
class Snapshot:
    """The particles that a dump has of one step.

    Attributes
    ----------
    name : str
        Of the file, for messages.
    bounds : ndarray, shape (2, 3)
        Lower and upper corner of the box, m.
    faces : tuple of str
        Boundaries in x, y and z, such as ``pp``; empty where the dump does not tell.
    labels : tuple of str
        Names of the columns.
    """

    name: str
    bounds: Floats
    faces: tuple[str, ...]
    labels: tuple[str, ...]
    _rows: tuple[str, ...]

    @property
    def count(self) -> int:
        """Number of particles."""
        return len(self._rows)

    def column(self, label: str) -> Floats:
        """Return the numbers of a column, shape (n,).

        Raises
        ------
        InputError
            If there is no such column, or a word in it is no number.
        """
        return np.array([number(word, f"{self.name}: {label}") for word in self._words(label)])

    def whole(self, label: str) -> Ints:
        """Return the whole numbers of a column, shape (n,); errors as those of `column`."""
        what = f"{self.name}: {label}"
        return np.array([integer(word, what) for word in self._words(label)], dtype=np.int64)

    def _words(self, label: str) -> list[str]:
        if label not in self.labels:
            msg = f"{self.name}: no column '{label}' (there: {', '.join(self.labels)[:_SHOWN]})"
            raise InputError(msg)
        at = self.labels.index(label)
        return [row.split()[at] for row in self._rows]


def find_snapshot(path: Path, name: str, step: int, present: int) -> Snapshot:
    """Return the snapshot of a step; those before it are passed over.

    Parameters
    ----------
    path : Path
        The file.
    name : str
        Its name, as the script has it.
    step : int
        Its step.
    present : int
        Number of particles that there are already, for the memory that is needed.

    Raises
    ------
    InputError
        If the file cannot be read, is no dump, ends too early or has no snapshot of that step.
    """
    try:
        with path.open("rb") as file:
            packed = file.peek(len(_GZIP)).startswith(_GZIP)
            content = gzip.GzipFile(fileobj=file) if packed else file
            with TextIOWrapper(content, encoding="utf-8", errors="replace") as text:
                return _Reader(name, _lines(text, name)).find(step, present)
    except (EOFError, zlib.error, gzip.BadGzipFile) as err:
        msg = f"{name}: the compressed file cannot be read further ({err}); write it again"
        raise InputError(msg) from err
    except OSError as err:
        msg = f"Cannot open file {name}: {err.strerror}"
        raise InputError(msg) from err


def _lines(text: TextIOWrapper, name: str) -> Iterator[str]:
    """Yield the lines of a file; InputError for one that is longer than any of a dump."""
    while line := text.readline(_LONGEST):
        if len(line) == _LONGEST:
            msg = f"{name}: a line has {_LONGEST} characters or more; this is no dump"
            raise InputError(msg)
        yield line


class _Reader:
    """Reads a dump line by line.

    Parameters
    ----------
    name : str
        Of the file, for messages.
    lines : iterator of str
        Its lines.
    """

    def __init__(self, name: str, lines: Iterator[str]) -> None:
        self._name = name
        self._at = 0
        self._lines = lines

    def find(self, step: int, present: int) -> Snapshot:
        """Return the snapshot of a step."""
        seen: list[int] = []
        while (title := next(self._lines, None)) is not None:
            self._at += 1
            if not title.startswith(_STEP):
                self._fail(f"expected '{_STEP}', found '{title.strip()[:_SHOWN]}'")
            found = self._whole()
            self._title(_COUNT)
            count = self._whole()
            faces = tuple(self._title(_BOX))
            sides = [self._line().split() for _ in range(3)]
            labels = tuple(self._title(_ATOMS))
            if found == step:
                check_room(count, present, f"read_dump {self._name}")
                return Snapshot(
                    self._name, self._bounds(faces, sides), faces, labels, self._rows(count, labels)
                )
            seen.append(found)
            if found > step:  # as LIGGGHTS, which takes steps to be in order
                break
            self._at += sum(1 for _ in islice(self._lines, count))
        steps = f"steps {seen[0]} to {seen[-1]}" if seen else "nothing"
        msg = f"{self._name}: Dump file does not contain requested snapshot {step}; it has {steps}"
        raise InputError(msg)

    def _bounds(self, faces: Sequence[str], sides: Sequence[Sequence[str]]) -> Floats:
        if any(face in ("xy", "xz", "yz") for face in faces):
            self._fail("the box is tilted, which is not supported")
        if any(len(side) != 2 for side in sides):
            self._fail("the box needs two numbers in each direction")
        lower, upper = np.array([[number(word, self._name) for word in side] for side in sides]).T
        if not (lower < upper).all():
            self._fail("a lower side of the box is not below the upper one")
        return np.stack((lower, upper))

    def _rows(self, count: int, labels: Sequence[str]) -> tuple[str, ...]:
        """Return lines as they are, which take less room than their words."""
        rows, size = [], 0
        for line in islice(self._lines, count):
            self._at += 1
            size += len(line)
            if size > _MOST:
                self._fail(f"a snapshot of more than {_MOST} characters; write fewer columns")
            if (found := len(line.split())) < len(labels):
                self._fail(f"{found} words for {len(labels)} columns")
            rows.append(line)
        if len(rows) < count:
            self._fail(f"the file ends after {len(rows)} of {count} particles")
        return tuple(rows)

    def _title(self, wanted: str) -> list[str]:
        line = self._line()
        if not line.startswith(wanted):
            self._fail(f"expected '{wanted}', found '{line.strip()[:_SHOWN]}'")
        return line[len(wanted) :].split()

    def _whole(self) -> int:
        found = integer(self._line().strip(), self._name)
        if found < 0:
            self._fail(f"{found} is negative")
        return found

    def _line(self) -> str:
        line = next(self._lines, None)
        if line is None:
            self._fail("the file ends here")
        self._at += 1
        return line

    def _fail(self, what: str) -> NoReturn:
        msg = f"{self._name}:{self._at}: {what}"
        raise InputError(msg)
