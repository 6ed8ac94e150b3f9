"""Tetrahedra of a region: their file, and which faces make up the surface."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from math import cos, pi, sin
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from minidem.errors import DemError, InputError
from minidem.kernels.columns import LOWER, UPPER, X, Y, Z
from minidem.kernels.insertion.tets import TetTable
from minidem.record import record
from minidem.words import Words, integer, number

__all__ = ["NO_TETS", "Tets", "read_tets", "tet_table"]

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_CORNERS = 4
_TETRAHEDRON = "10"  # cell type of VTK
_MOST_BYTES = 1_000_000_000
_HALF = 180.0  # degrees
_EQUAL = 1e-12  # m, up to which nodes are one
_MIRRORED = [3, 1, 2, 0]  # order of corners that changes the sign of the volume
_OPPOSITE = ((1, 2, 3), (0, 2, 3), (0, 1, 3), (0, 1, 2))  # face to each corner


@record(frozen=True)
class Tets:
    """Tetrahedra.

    Attributes
    ----------
    nodes : (n, 4, 3) float64
        Corners, m; the volumes are positive.
    volumes : (n,) float64
        m3.
    """

    nodes: Floats
    volumes: Floats

    @property
    def volume(self) -> float:
        """Volume of all of them, m3, summed in order."""
        return float(np.cumsum(self.volumes)[-1]) if len(self.volumes) else 0.0


NO_TETS = Tets(np.zeros((0, _CORNERS, 3)), np.zeros(0))


def read_tets(source: Words, box: Floats | None, path: Callable[[str], Path]) -> Tets:
    """Read ``file FILE scale S move X Y Z rotate PHIX PHIY PHIZ`` and the file.

    Raises
    ------
    DemError
        If the file cannot be read, holds no tetrahedron, or one beyond the box.
    """
    if box is None:
        msg = "region mesh/tet needs the simulation box; put the region after create_box"
        raise InputError(msg)
    source.expect("file")
    name = source.take("a file")
    source.expect("scale")
    scale = source.positive()
    source.expect("move")
    shift = np.array(source.numbers(3))
    source.expect("rotate")
    angles = source.numbers(3)
    points, cells = _read(path(name), name)
    points = _turned((points + shift) * scale, angles)
    if (points < box[LOWER]).any() or (points > box[UPPER]).any():
        msg = f"{name}: one or more points lie outside the simulation box"
        raise DemError(msg)
    nodes = points[cells]
    volumes = _volumes(nodes)
    turned = volumes < 0.0
    nodes[turned] = nodes[turned][:, _MIRRORED]
    found = Tets(nodes, _volumes(nodes))
    if not found.volume > 0.0:
        msg = f"{name}: its tetrahedra have no volume"
        raise DemError(msg)
    return found


def _turned(points: Floats, angles: Sequence[float]) -> Floats:
    """Turn points about the axes x, y and z one after the other, by degrees."""
    (sx, cx), (sy, cy), (sz, cz) = ((sin(a * pi / _HALF), cos(a * pi / _HALF)) for a in angles)
    x, y, z = points[:, X], points[:, Y], points[:, Z]
    return np.stack(
        [
            x * cy * cz + y * (cz * sx * sy - cx * sz) + z * (cx * cz * sy + sx * sz),
            x * cy * sz + z * (-cz * sx + cx * sy * sz) + y * (cx * cz + sx * sy * sz),
            z * cx * cy + y * cy * sx - x * sy,
        ],
        axis=1,
    )


def _volumes(nodes: Floats) -> Floats:
    """Return volumes with a sign, shape (n,)."""
    v0, v1, v2, v3 = (nodes[:, k] for k in range(_CORNERS))
    across = np.cross(v3 - v1, v2 - v1)
    c = v0 - v1
    found: Floats = (across[:, X] * c[:, X] + across[:, Y] * c[:, Y] + across[:, Z] * c[:, Z]) / 6.0
    return found


class _File:
    """A VTK file by lines that hold something.

    Parameters
    ----------
    path : Path
        The file.
    name : str
        Its name, as the script has it.
    """

    def __init__(self, path: Path, name: str) -> None:
        self._name = name
        try:
            size = path.stat().st_size
            if size > _MOST_BYTES:
                msg = f"{name}: has {size} bytes, at most {_MOST_BYTES} are read"
                raise DemError(msg)
            text = path.read_text(encoding="latin-1")
        except OSError as err:
            msg = f"{name}: cannot read VTK file: {err.strerror}"
            raise DemError(msg) from err
        lines = (
            (i, line.partition("#")[0].split()) for i, line in enumerate(text.splitlines(), start=1)
        )
        self._lines: Iterator[tuple[int, list[str]]] = (one for one in lines if one[1])
        self.line = 0

    def take(self, expected: str) -> list[str]:
        """Return the words of the next line."""
        self.line, words = next(self._lines, (0, []))
        if not words:
            msg = f"{self._name}: ends where {expected} is expected; the file is truncated"
            raise DemError(msg)
        return words

    def section(self, *wanted: str) -> int:
        """Read the first line of a section; return its count."""
        words = self.take(wanted[0])
        if tuple(words[: len(wanted)]) != wanted:
            msg = f"expected '{' '.join(wanted)}', found '{' '.join(words)[:60]}'"
            raise self.error(msg)
        return self.whole(words[len(wanted)]) if len(words) > len(wanted) else 0

    def whole(self, word: str) -> int:
        """Return a whole number that is not negative."""
        found = integer(word, f"{self._name}:{self.line}")
        if found < 0:
            msg = f"expected a number from zero on, found '{word[:40]}'"
            raise self.error(msg)
        return found

    def place(self) -> str:
        """Return file and line."""
        return f"{self._name}:{self.line}"

    def error(self, text: str) -> DemError:
        """Return an error with its place."""
        return DemError(f"{self.place()}: {text}")


def _read(path: Path, name: str) -> tuple[Floats, Ints]:
    """Read the points (n, 3) and tetrahedra (m, 4) of an ASCII VTK file."""
    file = _File(path, name)
    file.take("a title")
    file.section("ASCII")
    file.section("DATASET", "UNSTRUCTURED_GRID")
    count = file.section("POINTS")
    numbers: list[float] = []
    while len(numbers) < 3 * count:
        words = file.take("a point")
        if len(words) % 3:
            msg = f"expected 3 numbers for each point, found {len(words)}"
            raise file.error(msg)
        numbers.extend(number(word, file.place()) for word in words)
    if len(numbers) != 3 * count:
        msg = f"more than the {count} points that the file announces"
        raise file.error(msg)
    cells: list[list[int] | None] = []
    for _ in range(file.section("CELLS")):
        words = file.take("a cell")
        four = len(words) == 1 + _CORNERS
        cells.append([file.whole(word) for word in words[1:]] if four else None)
    if file.section("CELL_TYPES") != len(cells):
        msg = f"CELL_TYPES has another number than CELLS ({len(cells)})"
        raise file.error(msg)
    chosen = [cell for cell in cells if file.take("a cell type") == [_TETRAHEDRON] and cell]
    if not chosen:
        msg = f"{name}: holds no tetrahedron"
        raise DemError(msg)
    found = np.array(chosen, np.int64)
    if found.max() >= count:
        msg = f"{name}: a tetrahedron has point {found.max()}, but there are {count}"
        raise DemError(msg)
    return np.array(numbers).reshape(-1, 3), found


def tet_table(rows: Sequence[Tets]) -> TetTable:
    """Return the tetrahedra of all rows of a region as the kernels read them."""
    starts = np.cumsum([0, *(len(row.nodes) for row in rows)])
    nodes = np.concatenate([row.nodes for row in rows]) if rows else NO_TETS.nodes
    skins = [_skin(row.nodes) for row in rows]
    faces = [face for _, face in skins]
    shifts = np.cumsum([0, *(len(face) for face in faces)])
    near = [one + shift for (nears, _), shift in zip(skins, shifts, strict=False) for one in nears]
    return TetTable(
        first=starts.astype(np.int64),
        node=np.ascontiguousarray(nodes),
        bound=np.ascontiguousarray(np.stack([nodes.min(axis=1), nodes.max(axis=1)], axis=1)),
        volume=np.concatenate([np.cumsum(row.volumes) for row in rows] or [np.zeros(0)]),
        start=np.cumsum([0, *(len(one) for one in near)]).astype(np.int64),
        skin=np.concatenate([*near, np.zeros(0, np.int64)]).astype(np.int64),
        face=np.concatenate([*faces, np.zeros((0, 3, 3))]),
    )


def _skin(nodes: Floats) -> tuple[list[Ints], Floats]:
    """Return for each tetrahedron the faces of the surface around it, and these faces.

    Around it are its own and those of tetrahedra with which it shares a node.
    """
    count = len(nodes)
    if not count:
        return [], np.zeros((0, 3, 3))
    _, ids = np.unique(np.round(nodes.reshape(-1, 3) / _EQUAL), axis=0, return_inverse=True)
    corner = ids.reshape(count, _CORNERS)
    sides = corner[:, _OPPOSITE].reshape(-1, 3)
    _, which, uses = np.unique(
        np.sort(sides, axis=1), axis=0, return_inverse=True, return_counts=True
    )
    free = np.flatnonzero(uses[which.reshape(-1)] == 1)
    owner = free // _CORNERS
    around: dict[int, list[int]] = {}
    for face, tet in enumerate(owner.tolist()):
        for node in corner[tet].tolist():
            around.setdefault(node, []).append(face)
    near = [
        np.array(sorted({f for node in row for f in around.get(node, ())}), np.int64)
        for row in corner.tolist()
    ]
    faces = nodes[:, _OPPOSITE].reshape(-1, 3, 3)[free]
    return near, faces
