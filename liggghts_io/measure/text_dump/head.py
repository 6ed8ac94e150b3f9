"""Read what stands above the rows of a frame of a text dump."""

from __future__ import annotations

import io
import itertools
import math
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from liggghts_io.errors import DamagedFile
from liggghts_io.measure.text_dump.blocks import BEGINS, HEAD_LINES, Block, lines_above

FloatArray = npt.NDArray[np.float64]

_SHOWN: Final = 60  # characters of a wrong line in a message
_MOST_DIGITS: Final = 18  # of a step or a number of grains: both fit into 64 bits
_UNITS: Final = "ITEM: UNITS"
_TIME: Final = "ITEM: TIME"
_STEP: Final = "ITEM: TIMESTEP"
_COUNT: Final = "ITEM: NUMBER OF ATOMS"
_BOX: Final = "ITEM: BOX BOUNDS"
_ROWS: Final = "ITEM: ATOMS"
_EDGES: Final = ["abc", "origin"]
_LEANS: Final = ["xy", "xz", "yz"]


@dataclass(frozen=True)
class Head:
    """What stands above the rows of a frame.

    Attributes
    ----------
    step : int
    count : int
        Grains that are announced.
    names : tuple of str
        Columns in their order.
    box : (3, 2) float64
        Lower and upper bounds of what the box fills along x, y and z.
    cell : (3, 4) float64
        Corner of the box and, in columns, its three edges, to which scaled coordinates refer.
    size, lines : int
        Bytes and lines of the head.
    time : float, optional
        Time of the frame, in the units of the dump, where it has one.
    """

    step: int
    count: int
    names: tuple[str, ...]
    box: FloatArray
    cell: FloatArray
    size: int
    lines: int = HEAD_LINES
    time: float | None = None


def head_of(block: Block) -> Head:
    """Return what stands above the rows of a frame.

    Raises
    ------
    DamagedFile
        With the line that is not as in a dump of grains.
    """
    count = HEAD_LINES + lines_above(block.content)
    stream = io.BytesIO(block.content)
    raw = [stream.readline() for _ in range(count)]
    lines = [one.decode("ascii", errors="replace").rstrip() for one in raw if one]
    reader = _Lines(block, lines)
    time = reader.above()
    step = reader.whole(_STEP)
    grains = reader.whole(_COUNT)
    box, cell = reader.box()
    title = reader.take(_ROWS)
    names = tuple(title.split()[2:])
    if not names or len(set(names)) != len(names):
        what = "a column twice" if names else "no column"
        msg = f"{reader.place()}: names {what}; expected '{_ROWS} id type x y z ...'"
        raise DamagedFile(msg)
    return Head(step, grains, names, box, cell, stream.tell(), count, time)


class _Lines:
    """Takes the lines of a head one after the other.

    Parameters
    ----------
    block : Block
    lines : list of str
    """

    def __init__(self, block: Block, lines: list[str]) -> None:
        self._block, self._lines, self._at = block, lines, 0

    def place(self) -> str:
        """Return file and line of what was taken last."""
        return f"{self._block.path}:{self._block.line + max(self._at - 1, 0)}"

    def take(self, wanted: str) -> str:
        """Return the next line, which must begin so."""
        there = self._at < len(self._lines)
        found = self._lines[self._at] if there else ""
        self._at += 1
        if not there or not found.startswith(wanted):
            got = f"got {found[:_SHOWN]!r}" if there else "the file ends in the head of a frame"
            expected = f"expected {wanted!r} of a dump of grains, " if wanted else ""
            msg = f"{self.place()}: {expected}{got}"
            raise DamagedFile(msg)
        return found

    def above(self) -> float | None:
        """Take what LAMMPS writes above the step if it is asked to: units and time."""
        time = None
        while self._lines[self._at : self._at + 1] in ([_UNITS], [_TIME]):
            title = self.take("")
            word = self.take("").strip()
            if title == _UNITS:
                continue
            time = _number(word)
            if time is None:
                msg = f"{self.place()}: expected a number below {title!r}, got {word[:_SHOWN]!r}"
                raise DamagedFile(msg)
        return time

    def whole(self, title: str) -> int:
        """Return the whole number below a title."""
        self.take(title)
        word = self.take("").strip()
        if not word.isdecimal() or len(word) > _MOST_DIGITS:
            msg = f"{self.place()}: expected a whole number below {title!r}, got {word[:_SHOWN]!r}"
            raise DamagedFile(msg)
        return int(word)

    def box(self) -> tuple[FloatArray, FloatArray]:
        """Return the bounds of the box, and its corner with its edges."""
        words = self.take(_BOX).split()[3:6]
        if words[:2] == _EDGES:
            rows = self._three_rows(4, "an edge of the box and a coordinate of its corner")
            return _bounds(np.column_stack([rows[:, 3], rows[:, :3].T]))
        if words == _LEANS:
            rows = self._three_rows(3, "two bounds of the box and how far it leans")
            return rows[:, :2], _leaning(rows[:, :2], rows[:, 2])
        rows = self._three_rows(2, "two bounds of the box")
        return rows, _leaning(rows, np.zeros(3))

    def _three_rows(self, count: int, what: str) -> FloatArray:
        rows = []
        for _ in "xyz":
            words = self.take("").split()
            numbers = [_number(word) for word in words[:count]]
            if len(numbers) < count or None in numbers:
                msg = f"{self.place()}: expected {what}, got {' '.join(words)[:_SHOWN]!r}"
                raise DamagedFile(msg)
            rows.append(numbers)
        return np.array(rows, dtype=np.float64)


def _number(word: str) -> float | None:
    """Return a finite number, None where it is none."""
    try:
        value = float(word) if "_" not in word else math.nan
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def _leaning(box: FloatArray, tilt: FloatArray) -> FloatArray:
    """Return corner and edges of a box along the axes, or of one that leans by xy, xz and yz.

    The bounds of a box that leans are those of what it fills (LAMMPS manual, "Triclinic").
    """
    xy, xz, yz = tilt
    lean = [(0.0, xy, xz, xy + xz), (0.0, yz), (0.0,)]
    found = np.zeros((3, 4))
    for axis, (low, high) in enumerate(box):
        found[axis, 0] = low - min(lean[axis])
        found[axis, 1 + axis] = high - max(lean[axis]) - found[axis, 0]
    found[0, 2], found[0, 3], found[1, 3] = xy, xz, yz
    return found


def _bounds(cell: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return what a box of any edges fills along the axes, and its corner with its edges."""
    parts = np.array(list(itertools.product((0.0, 1.0), repeat=3)))
    corners = cell[:, :1] + cell[:, 1:] @ parts.T
    return np.column_stack([corners.min(axis=1), corners.max(axis=1)]), cell


def is_cut(block: Block, head: Head | None) -> bool:
    """Whether a frame is one that was not written to its end, as the last of a stopped run.

    Parameters
    ----------
    block : Block
    head : Head, optional
        None where the head cannot be read.
    """
    begins = any(block.content.startswith(one) or one.startswith(block.content) for one in BEGINS)
    above = HEAD_LINES + lines_above(block.content)
    whole = above if head is None else above + head.count
    return block.last and begins and block.lines < whole + (head is not None)


def missing_rows(block: Block, head: Head) -> str:
    """Return how a frame differs from the number of rows that its head announces, else ''."""
    rows = block.lines - head.lines
    if rows == head.count and block.content.endswith(b"\n"):
        return ""
    there = f"{rows} whole rows" if rows != head.count else "the last row is cut"
    why = f"; {block.cut}" if block.cut else ""
    return (
        f"{block.path}:{block.line + head.lines + min(rows, head.count)}: step {head.step}: the "
        f"head announces {head.count} grains, {there} follow{why}"
    )
