"""Dumps of numbers as the machine has them, `dump custom` into a file ``.bin``, taken for text.

Such a file does not hold the names of its columns. They are looked for in the ``dump`` command of a
log or script that lies beside it.
"""

from __future__ import annotations

import io
import re
import struct
import zlib
from collections.abc import Iterator
from functools import lru_cache
from math import isfinite
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from liggghts_io.errors import DamagedFile
from liggghts_io.measure.script_text import logical_lines
from liggghts_io.measure.text_dump import blocks
from liggghts_io.measure.text_dump.blocks import Block

FloatArray = npt.NDArray[np.float64]

_HEAD: Final = struct.Struct("<qq7i6d2i")
"""Step, grains, whether the box leans, boundaries, lower and upper sides, columns, parts."""
_LENGTH: Final = struct.Struct("<i")
_NUMBER_BYTES: Final = 8
_TEXT_BYTES: Final = 20  # that a number takes as text, about
_ROWS: Final = 1 << 14  # made to text at once
_FACES: Final = "pfsm"
_MOST_COLUMNS: Final = 1000
_MOST_PARTS: Final = 1_000_000  # processes that have written
_MOST_GRAINS: Final = 10**12
_SCRIPTS: Final = ("log*", "in.*", "*.in", "*.liggghts", "*.lmp", "*.script", "*.s")
_MOST_SCRIPT: Final = 1 << 20  # bytes of a log in which commands are looked for
_PLACES: Final[dict[str, tuple[int, int]]] = {"dump": (3, 5), "write_dump": (2, 3)}
"""Where style and file stand in the commands."""
_STARS: Final = {"*": r"\d+", "%": r"\d+"}


class _Head(NamedTuple):
    step: int
    grains: int
    faces: tuple[int, ...]
    bounds: tuple[float, ...]
    columns: int
    parts: int


def blocks_of(path: Path) -> Iterator[Block]:
    """Yield the frames of a dump, those of numbers as the text that they would be.

    Raises
    ------
    DamagedFile
        As `blocks.blocks_of`; for a dump of numbers whose columns nobody names.
    """
    with blocks.open_dump(path) as stream:
        if _head(stream.peek(_HEAD.size)[: _HEAD.size]) is not None:
            yield from _frames(path, stream)
            return
    yield from blocks.blocks_of(path)


def begin_of(path: Path, size: int) -> bytes:
    """Return how a file begins, a dump of numbers as text; errors as those of `blocks.begin_of`."""
    found = blocks.begin_of(path, max(size, _HEAD.size))
    head = _head(found[: _HEAD.size])
    return found[:size] if head is None else _text_head(head, _columns(path, head.columns))


def _head(content: bytes) -> _Head | None:
    """Return what stands above the numbers of a frame, None where that is no such head."""
    if len(content) < _HEAD.size:
        return None
    step, grains, leans, *rest = _HEAD.unpack(content)
    faces, bounds, (columns, parts) = tuple(rest[:6]), tuple(rest[6:12]), rest[12:]
    fits = (
        step >= 0 and 0 <= grains <= _MOST_GRAINS and not leans
        and all(0 <= face < len(_FACES) for face in faces)
        and all(map(isfinite, bounds)) and all(a < b for a, b in _pairs(bounds))
        and 1 <= columns <= _MOST_COLUMNS and 1 <= parts <= _MOST_PARTS
    )  # fmt: skip
    return _Head(step, grains, faces, bounds, columns, parts) if fits else None


def _pairs(values: tuple[float, ...]) -> list[tuple[float, float]]:
    return list(zip(values[::2], values[1::2], strict=True))


def _frames(path: Path, stream: io.BufferedReader) -> Iterator[Block]:
    """Yield the frames of a dump of numbers; one that is cut has fewer rows than it announces."""
    names: tuple[str, ...] = ()
    line, begin = 1, _read(stream, _HEAD.size)
    while begin:
        head = _head(begin)
        if head is None:
            if len(begin) == _HEAD.size:
                msg = f"{path}: frame at line {line} of its text: no head of a frame of numbers"
                raise DamagedFile(msg)
            yield Block(path, line, blocks.MARK, 0, last=True)
            return
        names = names or _columns(path, head.columns)
        if len(names) != head.columns:
            raise DamagedFile(_nameless(path, head.columns))
        content = _text_head(head, names) + _text_rows(_numbers(path, stream, head))
        begin = _read(stream, _HEAD.size)
        lines = content.count(b"\n")
        yield Block(path, line, content, lines, last=not begin)
        line += lines


def _numbers(path: Path, stream: io.BufferedReader, head: _Head) -> FloatArray:
    """Return the whole rows of a frame, shape (n, columns)."""
    parts, total = [], 0
    for _ in range(head.parts):
        size = _read(stream, _LENGTH.size)
        count = _LENGTH.unpack(size)[0] if len(size) == _LENGTH.size else 0
        if not 0 <= count <= head.grains * head.columns or count % head.columns:
            msg = f"{path}: step {head.step}: a part of {count} numbers in {head.columns} columns"
            raise DamagedFile(msg)
        total += count
        blocks.check_size(path, total * _TEXT_BYTES)
        content = _read(stream, count * _NUMBER_BYTES)
        whole = len(content) // (head.columns * _NUMBER_BYTES) * head.columns
        parts.append(np.frombuffer(content, "<f8", whole))
    return np.concatenate(parts).reshape(-1, head.columns)


def _read(stream: io.BufferedReader, size: int) -> bytes:
    """Return the next bytes, fewer where the file ends or a compressed one is damaged."""
    try:
        return stream.read(size)
    except (EOFError, zlib.error, OSError):
        return b""


def _text_head(head: _Head, names: tuple[str, ...]) -> bytes:
    faces = [
        _FACES[one] + _FACES[other]
        for one, other in zip(head.faces[::2], head.faces[1::2], strict=True)
    ]
    sides = "".join(f"{low!r} {high!r}\n" for low, high in _pairs(head.bounds))
    return (
        f"ITEM: TIMESTEP\n{head.step}\nITEM: NUMBER OF ATOMS\n{head.grains}\n"
        f"ITEM: BOX BOUNDS {' '.join(faces)}\n{sides}ITEM: ATOMS {' '.join(names)}\n"
    ).encode()


def _text_rows(rows: FloatArray) -> bytes:
    pieces = (rows[at : at + _ROWS].tolist() for at in range(0, len(rows), _ROWS))
    return b"".join(
        "".join(" ".join(map(repr, row)) + "\n" for row in piece).encode() for piece in pieces
    )


def _columns(path: Path, count: int) -> tuple[str, ...]:
    """Return the names that a ``dump`` command beside the file gives its columns, else ()."""
    folder = path.absolute().parent
    found = {
        columns
        for place in (folder, folder.parent)
        for pattern in _SCRIPTS
        for script in place.glob(pattern)
        if script.is_file()
        for name, columns in _commands(script, script.stat().st_mtime_ns)
        if len(columns) == count and _pattern(name).fullmatch(path.name)
    }
    return found.pop() if len(found) == 1 else ()


@lru_cache(maxsize=64)
def _commands(script: Path, _changed: int) -> tuple[tuple[str, tuple[str, ...]], ...]:
    """Return file names and columns of the dumps that a script or log asks for."""
    try:
        with script.open(errors="replace") as file:
            text = file.read(_MOST_SCRIPT)
    except OSError:
        return ()
    found = []
    for _, line in logical_lines(text):
        words = line.split() or [""]  # of a last line that was to be continued, perhaps
        style, at = _PLACES.get(words[0], (0, 0))
        if not at or len(words) <= at or words[style] != "custom":
            continue
        columns = words[at + 1 :]
        end = columns.index("modify") if "modify" in columns else len(columns)
        found.append((words[at].rpartition("/")[2], tuple(columns[:end])))
    return tuple(found)


def _pattern(name: str) -> re.Pattern[str]:
    return re.compile("".join(_STARS.get(one, re.escape(one)) for one in name))


def _nameless(path: Path, count: int) -> str:
    return (
        f"{path}: a dump of numbers ({count} columns) does not hold the names of its columns, and "
        f"no 'dump' command of {count} columns in a log or script beside it names this file, or "
        "several do; put log or script there, or write the dump as text"
    )
