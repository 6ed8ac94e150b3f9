"""Split text dumps into frames, in the memory of one frame.

A dump is read in large pieces and cut at the lines that begin a frame. How many rows a frame has
is counted, so that one that was cut is known without looking at its numbers.
"""

from __future__ import annotations

import gzip
import io
import math
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from liggghts_io.errors import DamagedFile

FloatArray = npt.NDArray[np.float64]

MARK: Final = b"ITEM: TIMESTEP"
GZIP: Final = b"\x1f\x8b"
_PIECE: Final = 1 << 22  # bytes read at once
_SHOWN: Final = 60  # characters of a wrong row in a message
HEAD_LINES: Final = 9
"""Lines above the rows of a frame."""
_MOST_DIGITS: Final = 18  # of a step or a number of grains: both fit into 64 bits
_ONE_LINE: Final = ("ITEM: TIMESTEP", "ITEM: NUMBER OF ATOMS")
_BOX: Final = "ITEM: BOX BOUNDS"
_ROWS: Final = "ITEM: ATOMS"


@dataclass(frozen=True)
class Block:
    """One frame as it stands in a file.

    Attributes
    ----------
    path : Path
    line : int
        Where it begins, counted from 1.
    content : bytes
    lines : int
        Its whole lines.
    last : bool
        Whether the file ends with it.
    cut : str
        Why the file cannot be read behind it, if it cannot.
    """

    path: Path
    line: int
    content: bytes
    lines: int
    last: bool = False
    cut: str = ""


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
        Lower and upper bounds of x, y and z.
    tilt : (3,) float64
        How far the box leans: xy, xz, yz.
    size : int
        Bytes of the head.
    """

    step: int
    count: int
    names: tuple[str, ...]
    box: FloatArray
    tilt: FloatArray
    size: int

    @property
    def cell(self) -> FloatArray:
        """Corner of the box and its three edges, (3, 4).

        The bounds of a box that leans are those of what it fills (LAMMPS manual, "Triclinic").
        """
        xy, xz, yz = self.tilt
        lean = [(0.0, xy, xz, xy + xz), (0.0, yz), (0.0,)]
        found = np.zeros((3, 4))
        for axis, (low, high) in enumerate(self.box):
            found[axis, 0] = low - min(lean[axis])
            found[axis, 1 + axis] = high - max(lean[axis]) - found[axis, 0]
        found[0, 2], found[0, 3], found[1, 3] = xy, xz, yz
        return found


def open_dump(path: Path) -> io.BufferedReader:
    """Return a file opened for reading bytes, decompressed where gzip has compressed it.

    Raises
    ------
    DamagedFile
        If it is missing, a directory, or cannot be opened.
    """
    try:
        with path.open("rb") as begin:
            packed = begin.read(len(GZIP)) == GZIP
        # Its own type says nothing that a reader of bytes needs.
        return gzip.open(path) if packed else path.open("rb")  # type: ignore[return-value]
    except FileNotFoundError as err:
        msg = f"{path}: missing; did the engine run to the end?"
        raise DamagedFile(msg) from err
    except OSError as err:
        msg = f"{path}: cannot be read ({err.strerror}); a dump is a file"
        raise DamagedFile(msg) from err


def blocks_of(path: Path) -> Iterator[Block]:
    """Yield the frames of a text dump, plain or compressed by gzip, in their order.

    Raises
    ------
    DamagedFile
        If the file cannot be read, or does not begin as a dump.
    """
    buffer = bytearray()
    line, searched, cut = 1, 0, ""
    with open_dump(path) as stream:
        while not cut:
            piece, cut = _piece(stream)
            buffer += piece
            while (end := buffer.find(b"\n" + MARK, searched)) >= 0:
                content = bytes(memoryview(buffer)[: end + 1])
                del buffer[: end + 1]
                searched = 0
                lines = content.count(b"\n")
                yield Block(path, line, content, lines)
                line += lines
            searched = max(0, len(buffer) - len(MARK))
            if not piece:
                break
    end = buffer.rfind(b"\n") + 1
    lines = buffer.count(b"\n")
    if lines >= HEAD_LINES and buffer[end:] and MARK.startswith(buffer[end:]):
        yield Block(path, line, bytes(buffer[:end]), lines)  # the file is cut in the next mark
        line += lines
        del buffer[:end]
    yield Block(path, line, bytes(buffer), buffer.count(b"\n"), True, cut)


def _piece(stream: io.BufferedReader) -> tuple[bytes, str]:
    """Return the next bytes, empty at the end, and why there are no more that can be read."""
    try:
        return stream.read1(_PIECE), ""  # what comes before an error is kept
    except (EOFError, zlib.error, OSError) as err:
        return b"", f"the compressed file cannot be read further ({err})"


def head_of(block: Block) -> Head:
    """Return what stands above the rows of a frame.

    Raises
    ------
    DamagedFile
        With the line that is not as in a dump of grains.
    """
    stream = io.BytesIO(block.content)
    raw = [stream.readline() for _ in range(HEAD_LINES)]
    lines = [one.decode("ascii", errors="replace").rstrip() for one in raw if one]
    reader = _Lines(block, lines)
    step = reader.whole(_ONE_LINE[0])
    count = reader.whole(_ONE_LINE[1])
    box, tilt = reader.box()
    title = reader.take(_ROWS)
    names = tuple(title.split()[2:])
    if not names or len(set(names)) != len(names):
        what = "twice" if names else "at all"
        msg = f"{reader.place()}: names a column {what}; expected '{_ROWS} id type x y z ...'"
        raise DamagedFile(msg)
    return Head(step, count, names, box, tilt, stream.tell())


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

    def whole(self, title: str) -> int:
        """Return the whole number below a title."""
        self.take(title)
        word = self.take("")
        if not word.isdecimal() or len(word) > _MOST_DIGITS:
            msg = f"{self.place()}: expected a whole number below {title!r}, got {word[:_SHOWN]!r}"
            raise DamagedFile(msg)
        return int(word)

    def box(self) -> tuple[FloatArray, FloatArray]:
        """Return the bounds of the box, and how far it leans."""
        leans = self.take(_BOX).split()[3:6] == ["xy", "xz", "yz"]
        sides = []
        for _ in "xyz":
            words = self.take("").split()
            try:
                numbers = [float(word) for word in words[: 2 + leans]]
            except ValueError:
                numbers = []
            if len(numbers) < 2 + leans or not all(map(math.isfinite, numbers)):
                what = "two bounds of the box" + " and how far it leans" * leans
                msg = f"{self.place()}: expected {what}, got {' '.join(words)!r}"
                raise DamagedFile(msg)
            sides.append((*numbers, 0.0)[:3])
        found = np.array(sides)
        return found[:, :2], found[:, 2]


def is_cut(block: Block, head: Head | None) -> bool:
    """Whether a frame is one that was not written to its end, as the last of a stopped run.

    Parameters
    ----------
    block : Block
    head : Head, optional
        None where the head cannot be read.
    """
    begins = block.content.startswith(MARK) or MARK.startswith(block.content)
    whole = HEAD_LINES if head is None else HEAD_LINES + head.count
    return block.last and begins and block.lines < whole + (head is not None)


def missing_rows(block: Block, head: Head) -> str:
    """Return how a frame differs from the number of rows that its head announces, else ''."""
    rows = block.lines - HEAD_LINES
    if rows == head.count and block.content.endswith(b"\n"):
        return ""
    there = f"{rows} whole rows" if rows != head.count else "the last row is cut"
    why = f"; {block.cut}" if block.cut else ""
    return (
        f"{block.path}:{block.line + HEAD_LINES + min(rows, head.count)}: step {head.step}: the "
        f"head announces {head.count} grains, {there} follow{why}"
    )
