"""Split text dumps into frames, in the memory of one frame.

A dump is read in large pieces and cut at the lines that begin a frame. How many rows a frame has
is counted, so that one that was cut is known without looking at its numbers.
"""

from __future__ import annotations

import gzip
import io
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from liggghts_io.errors import DamagedFile

MARK: Final = b"ITEM: TIMESTEP"
_ABOVE: Final = (b"ITEM: TIME", b"ITEM: UNITS")
"""Titles that may stand above that of the step, each with one line, the nearest one first."""
BEGINS: Final = (MARK, *_ABOVE)
"""What a frame begins with."""
GZIP: Final = b"\x1f\x8b"
_PIECE: Final = 1 << 22  # bytes read at once
_MOST_BYTES: Final = 1 << 30  # of a frame; a small compressed file may hold any number
_FIRST_BYTES: Final = 400  # in which the lines above a step stand
HEAD_LINES: Final = 9
"""Lines above the rows of a frame, from that of the step on."""


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
                begin = _begin(buffer, end + 1)
                searched = end + 1 - begin  # behind what stands above the mark
                if not begin:
                    continue
                content = bytes(memoryview(buffer)[:begin])
                del buffer[:begin]
                lines = content.count(b"\n")
                yield Block(path, line, content, lines)
                line += lines
            searched = max(0, len(buffer) - len(MARK))
            check_size(path, len(buffer))
            if not piece:
                break
    begin = _unfinished(buffer)
    lines = buffer.count(b"\n", 0, begin)
    head = HEAD_LINES + lines_above(bytes(buffer[:_FIRST_BYTES]))
    if lines >= head and begin < len(buffer):
        yield Block(path, line, bytes(buffer[:begin]), lines)  # the file is cut in the next mark
        line += lines
        del buffer[:begin]
    yield Block(path, line, bytes(buffer), buffer.count(b"\n"), True, cut)


def check_size(path: Path, size: int) -> None:
    """Refuse a frame of more bytes than there is memory for.

    Raises
    ------
    DamagedFile
        With the remedy.
    """
    if size > _MOST_BYTES:
        msg = (
            f"{path}: a frame of more than {_MOST_BYTES >> 30} GiB; write fewer columns, or the "
            "grains of a region"
        )
        raise DamagedFile(msg)


def _begin(buffer: bytearray, mark: int) -> int:
    """Return where the frame begins that has its mark there: time and units may stand above."""
    begin = mark
    for title in _ABOVE:
        value = buffer.rfind(b"\n", 0, max(begin - 1, 0)) + 1
        above = buffer.rfind(b"\n", 0, max(value - 1, 0)) + 1
        if bytes(buffer[above:value]).strip() == title:
            begin = above
    return begin


def _unfinished(buffer: bytearray) -> int:
    """Return where the begin of a frame stands that does not get as far as its mark, else the end.

    A run that is stopped may leave any part of what stands above the rows.
    """
    line = buffer.rfind(b"\n") + 1
    begun = bytes(buffer[line:]).strip()
    if begun and any(one.startswith(begun) for one in BEGINS):
        return _begin(buffer, line)
    title = buffer.rfind(b"\nITEM: ") + 1
    if bytes(buffer[title : title + _FIRST_BYTES]).partition(b"\n")[0].strip() in _ABOVE:
        return _begin(buffer, title)
    return len(buffer)


def lines_above(content: bytes) -> int:
    """Return how many lines stand above the title of the step in a frame: 0, 2 or 4."""
    titles = [one.strip() for one in content[:_FIRST_BYTES].split(b"\n")[:4:2]]
    count = 0
    while count < len(titles) and titles[count] in _ABOVE:
        count += 1
    return 2 * count


def begin_of(path: Path, size: int) -> bytes:
    """Return the first bytes of a file, decompressed, as far as it can be read; fewer if it is cut.

    Raises
    ------
    DamagedFile
        As `open_dump`.
    """
    found, cut = b"", ""
    with open_dump(path) as stream:
        while len(found) < size and not cut:
            piece, cut = _piece(stream)
            if not piece:
                break
            found += piece
    return found[:size]


def _piece(stream: io.BufferedReader) -> tuple[bytes, str]:
    """Return the next bytes, empty at the end, and why there are no more that can be read."""
    try:
        return stream.read1(_PIECE), ""  # what comes before an error is kept
    except (EOFError, zlib.error, OSError) as err:
        return b"", f"the compressed file cannot be read further ({err})"
