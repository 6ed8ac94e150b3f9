"""Reading of STL files, ASCII and binary.

Normals in the file are ignored, as in LIGGGHTS: a triangle's orientation follows from the order of
its vertices.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from minidem.errors import DemError

__all__ = ["read_stl"]

MAX_BYTES = 1_000_000_000
"""Largest STL file that is read."""

_HEADER = 84
_FACET = np.dtype([("normal", "<f4", 3), ("vertices", "<f4", (3, 3)), ("attribute", "<u2")])
_PATTERN = ("facet", "outer", "vertex", "vertex", "vertex", "endloop", "endfacet")


def read_stl(path: Path) -> NDArray[np.float64]:
    """Read the triangles of an STL file.

    Parameters
    ----------
    path : Path
        The file. A file whose length fits the triangle count at byte 80 is binary, any other one
        must be ASCII.

    Returns
    -------
    (n, 3, 3) ndarray of float64
        Vertices in file order: triangle, corner, coordinate. Degenerate triangles are kept.

    Raises
    ------
    DemError
        If the file is missing, empty, truncated or not an STL file; the message names file and
        place.
    """
    try:
        size = path.stat().st_size
        if size > MAX_BYTES:
            msg = f"{path.name}: has {size} bytes, at most {MAX_BYTES} are read"
            raise DemError(msg)
        data = path.read_bytes()
    except OSError as err:
        msg = f"{path.name}: cannot read STL file: {err.strerror}"
        raise DemError(msg) from err
    count = int.from_bytes(data[80:_HEADER], "little") if len(data) >= _HEADER else -1
    if count >= 0 and len(data) == _HEADER + _FACET.itemsize * count:
        triangles = np.frombuffer(data, _FACET, count, _HEADER)["vertices"].astype(np.float64)
    elif data.lstrip()[:5].lower() == b"solid" and b"\0" not in data:
        triangles = _ascii(data, path.name)
    else:
        raise DemError(_not_stl(data, count, path.name))
    if len(triangles) == 0:
        msg = f"{path.name}: holds no triangle"
        raise DemError(msg)
    bad = np.flatnonzero(~np.isfinite(triangles).all(axis=(1, 2)))
    if bad.size:
        msg = f"{path.name}: triangle {bad[0] + 1} has a coordinate that is not a finite number"
        raise DemError(msg)
    return triangles


def _not_stl(data: bytes, count: int, name: str) -> str:
    """Say why a file is neither a whole binary nor an ASCII file."""
    if not data:
        return f"{name}: the file is empty"
    if len(data) < _HEADER:
        return f"{name}: not an STL file: neither 'solid' at its start nor {_HEADER} bytes long"
    wanted = _HEADER + _FACET.itemsize * count
    return (
        f"{name}: as binary STL it announces {count} triangles, which needs {wanted} bytes, but it "
        f"has {len(data)}; the file is truncated or no STL file"
    )


def _ascii(data: bytes, name: str) -> NDArray[np.float64]:
    """Read the facets of an ASCII file line by line."""
    numbers: list[float] = []
    state = 0
    for i, raw in enumerate(data.decode("latin-1").splitlines(), start=1):
        words = raw.split()
        if not words:
            continue
        word = words[0].lower()
        if state == 0 and word in ("solid", "endsolid"):
            continue
        if word != _PATTERN[state]:
            msg = f"{name}:{i}: expected '{_PATTERN[state]}', found '{words[0][:40]}'"
            raise DemError(msg)
        if word == "vertex":
            numbers.extend(_vertex(words, name, i))
        state = (state + 1) % len(_PATTERN)
    if state:
        msg = f"{name}: ends within a facet, '{_PATTERN[state]}' is missing; the file is truncated"
        raise DemError(msg)
    return np.array(numbers, dtype=np.float64).reshape(-1, 3, 3)


def _vertex(words: list[str], name: str, line: int) -> list[float]:
    try:
        if len(words) == 4:
            return [float(word) for word in words[1:]]
    except ValueError:
        pass
    msg = f"{name}:{line}: expected 'vertex X Y Z', found '{' '.join(words)[:60]}'"
    raise DemError(msg)
