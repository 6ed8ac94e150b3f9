"""Reading of STL files, ASCII and binary.

Normals in the file are ignored, as in LIGGGHTS: a triangle's orientation follows from the order of
its vertices.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from minidem.errors import DemError
from minidem.words import integer

__all__ = ["liggghts_stops_at", "not_excluded", "numbered_triangles"]

MAX_BYTES = 1_000_000_000
"""Largest STL file that is read."""

_HEADER = 84
_FACET = np.dtype([("normal", "<f4", 3), ("vertices", "<f4", (3, 3)), ("attribute", "<u2")])
_SOLID = re.compile(rb"(?:\s|#[^\n]*\n)*solid", re.IGNORECASE)
"""How an ASCII file begins: LIGGGHTS takes what follows a ``#`` for a comment."""
_CAPITALS = re.compile(
    rb"^[ \t]*(?=[a-z]*[A-Z])(?i:solid|endsolid|facet|endfacet|outer|endloop|vertex)\b",
    re.MULTILINE,
)
_PATTERN = ("facet", "outer", "vertex", "vertex", "vertex", "endloop", "endfacet")


def numbered_triangles(path: Path, name: str = "") -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Read the triangles of an STL file and the numbers that LIGGGHTS knows them by.

    Parameters
    ----------
    path : Path
        The file. A file whose length fits the triangle count at byte 80 is binary, any other one
        must be ASCII.
    name : str
        Its name, as the script has it; empty for that of the path.

    Returns
    -------
    (n, 3, 3) ndarray of float64
        Vertices in file order: triangle, corner, coordinate. Degenerate triangles are kept.
    (n,) ndarray of int64
        Line at which each begins; in a binary file its place, from 1.

    Raises
    ------
    DemError
        If the file is missing, empty, truncated or not an STL file; the message names file and
        place.
    """
    name = name or path.name
    try:
        size = path.stat().st_size
        if size > MAX_BYTES:
            msg = f"{name}: has {size} bytes, at most {MAX_BYTES} are read"
            raise DemError(msg)
        data = path.read_bytes()
    except OSError as err:
        msg = f"{name}: cannot read STL file: {err.strerror}"
        raise DemError(msg) from err
    count = int.from_bytes(data[80:_HEADER], "little") if len(data) >= _HEADER else -1
    if count >= 0 and len(data) == _HEADER + _FACET.itemsize * count:
        triangles = np.frombuffer(data, _FACET, count, _HEADER)["vertices"].astype(np.float64)
        numbers = 1 + np.arange(count)
    elif _SOLID.match(data) and b"\0" not in data:
        triangles, numbers = _ascii(data, name)
    else:
        raise DemError(_not_stl(data, count, name))
    if len(triangles) == 0:
        msg = f"{name}: holds no triangle"
        raise DemError(msg)
    bad = np.flatnonzero(~np.isfinite(triangles).all(axis=(1, 2)))
    if bad.size:
        msg = f"{name}: triangle {bad[0] + 1} has a coordinate that is not a finite number"
        raise DemError(msg)
    return triangles, numbers


def _not_stl(data: bytes, count: int, name: str) -> str:
    """Say why a file is neither a whole binary nor an ASCII file."""
    if not data:
        return f"{name}: the file is empty"
    if data.startswith(b"# vtk"):
        return (
            f"{name}: a VTK file, at which LIGGGHTS 3.8.0 stops as well; save the surface as STL, "
            "in ParaView with 'Save Data'"
        )
    if len(data) < _HEADER:
        return f"{name}: not an STL file: neither 'solid' at its start nor {_HEADER} bytes long"
    wanted = _HEADER + _FACET.itemsize * count
    return (
        f"{name}: as binary STL it announces {count} triangles, which needs {wanted} bytes, but it "
        f"has {len(data)}; the file is truncated or no STL file"
    )


def _ascii(data: bytes, name: str) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Read the facets of an ASCII file line by line, and the lines at which they begin.

    As LIGGGHTS does it passes over lines between facets that begin with none of its words.
    """
    numbers: list[float] = []
    lines: list[int] = []
    state = 0
    for i, raw in enumerate(data.decode("latin-1").splitlines(), start=1):
        words = raw.partition("#")[0].split()
        if not words:
            continue
        word = words[0].lower()
        if state == 0 and word not in _PATTERN:
            continue
        if word != _PATTERN[state]:
            msg = f"{name}:{i}: expected '{_PATTERN[state]}', found '{words[0][:40]}'"
            raise DemError(msg)
        if state == 0:
            lines.append(i)
        if word == "vertex":
            numbers.extend(_vertex(words, name, i))
        state = (state + 1) % len(_PATTERN)
    if state:
        msg = f"{name}: ends within a facet, '{_PATTERN[state]}' is missing; the file is truncated"
        raise DemError(msg)
    return np.array(numbers, dtype=np.float64).reshape(-1, 3, 3), np.array(lines, np.int64)


def _vertex(words: list[str], name: str, line: int) -> list[float]:
    try:
        if len(words) == 4:
            return [float(word) for word in words[1:]]
    except ValueError:
        pass
    msg = f"{name}:{line}: expected 'vertex X Y Z', found '{' '.join(words)[:60]}'"
    raise DemError(msg)


def liggghts_stops_at(path: Path) -> str:
    """Return why LIGGGHTS cannot read an STL file that is read here, empty if it can.

    It takes a file for ASCII if its first line begins with ``solid``, and knows small letters only.
    """
    data = path.read_bytes()
    count = int.from_bytes(data[80:_HEADER], "little") if len(data) >= _HEADER else -1
    binary = len(data) == _HEADER + _FACET.itemsize * count
    first = data.partition(b"\n")[0].partition(b"#")[0].split()
    ascii_to_it = bool(first) and first[0] == b"solid"
    if binary and ascii_to_it:
        return "is binary and begins with 'solid', so that it takes it for ASCII; change the header"
    if not binary and (found := _CAPITALS.search(data)):
        return f"has '{found.group().split()[0].decode()}' in capitals, and it knows small letters"
    return ""


def not_excluded(path: Path, numbers: NDArray[np.int64], name: str = "") -> NDArray[np.bool_]:
    """Return which triangles an exclusion list leaves.

    Parameters
    ----------
    path : Path
        Text file with the number of a triangle on each line.
    numbers : (n,) ndarray of int64
        Numbers of the triangles, as `numbered_triangles` gives them.
    name : str
        See `numbered_triangles`.

    Raises
    ------
    DemError
        If the file cannot be read, holds something else, or names all triangles.
    """
    name = name or path.name
    try:
        words = path.read_text(encoding="utf-8", errors="replace").split()
    except OSError as err:
        msg = f"{name}: cannot read element_exclusion_list: {err.strerror}"
        raise DemError(msg) from err
    gone = np.array([integer(word, name) for word in words], np.int64)
    keep: NDArray[np.bool_] = ~np.isin(numbers, gone)
    if not keep.any():
        msg = f"{name}: element_exclusion_list leaves no triangle"
        raise DemError(msg)
    return keep
