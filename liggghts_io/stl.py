"""Write triangle meshes as ASCII STL, read any STL, and build the shapes the experiments need.

A mesh is an array of shape (n, 3, 3): triangle, corner, coordinate [m].
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

from liggghts_io.errors import CaseError
from liggghts_io.files import nearest_file

Triangles: TypeAlias = npt.NDArray[np.float64]
Point: TypeAlias = tuple[float, float, float]

_HEAD: Final = 80  # bytes of any text that a binary file begins with
_COUNT: Final = 4  # bytes of the number of triangles behind it
_FACET: Final = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def quad(a: Point, b: Point, c: Point, d: Point) -> Triangles:
    """Split the quadrilateral a-b-c-d into two triangles with right angles kept at b and d."""
    return np.array([[a, b, c], [a, c, d]], dtype=np.float64)


def rectangle(x: tuple[float, float], y: tuple[float, float], z: float) -> Triangles:
    """Horizontal rectangle at height `z` [m]."""
    return quad((x[0], y[0], z), (x[1], y[0], z), (x[1], y[1], z), (x[0], y[1], z))


def disc(radius: float, z: float, segments: int = 48) -> Triangles:
    """Horizontal disc about the z axis as a fan of triangles."""
    angle = np.linspace(0.0, 2.0 * np.pi, segments + 1)
    rim = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full_like(angle, z)], axis=1)
    centre = np.broadcast_to([0.0, 0.0, z], (segments, 3))
    return np.stack([centre, rim[:-1], rim[1:]], axis=1)


def tube(radii: tuple[float, float], z: tuple[float, float], segments: int = 24) -> Triangles:
    """Open tube (or cone) about the z axis from (radii[0], z[0]) to (radii[1], z[1])."""
    angle = np.linspace(0.0, 2.0 * np.pi, segments + 1)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    low = np.column_stack([radii[0] * ring, np.full(segments + 1, z[0])])
    high = np.column_stack([radii[1] * ring, np.full(segments + 1, z[1])])
    first = np.stack([low[:-1], low[1:], high[1:]], axis=1)
    second = np.stack([low[:-1], high[1:], high[:-1]], axis=1)
    return np.concatenate([first, second])


def open_box(
    x: tuple[float, float], y: tuple[float, float], z: tuple[float, float], *, floor: bool
) -> Triangles:
    """Four vertical walls, with a floor at z[0] if asked for."""
    corners = [(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])]
    walls = [
        quad((*a, z[0]), (*b, z[0]), (*b, z[1]), (*a, z[1]))
        for a, b in zip(corners, corners[1:] + corners[:1], strict=True)
    ]
    if floor:
        walls.append(rectangle(x, y, z[0]))
    return np.concatenate(walls)


def stl_text(name: str, triangles: Triangles) -> str:
    """Return a mesh as an ASCII STL file with 9 significant digits.

    Raises
    ------
    CaseError
        If a corner is not finite or a triangle has no area.
    """
    if triangles.ndim != 3 or triangles.shape[1:] != (3, 3) or not np.isfinite(triangles).all():
        msg = f"{name}.stl: a mesh needs finite corners of shape (n, 3, 3), got {triangles.shape}"
        raise CaseError(msg)
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    if (lengths <= 0.0).any():
        msg = f"{name}.stl: triangle {int(np.argmin(lengths))} has no area"
        raise CaseError(msg)
    lines = [f"solid {name}"]
    for corner, normal in zip(triangles, normals / lengths[:, None], strict=True):
        lines.append(" facet normal " + " ".join(f"{v:.9g}" for v in normal))
        lines.append("  outer loop")
        lines.extend("   vertex " + " ".join(f"{v:.9g}" for v in point) for point in corner)
        lines.extend(["  endloop", " endfacet"])
    lines.append(f"endsolid {name}")
    return "\n".join(lines) + "\n"


def read_stl(path: Path) -> Triangles:
    """Read an STL file, text or binary.

    Raises
    ------
    CaseError
        If the file cannot be read, was cut short, holds no triangle or a facet of another number
        of corners, or a corner is not three finite numbers; of a text with its line.
    """
    try:
        content = path.read_bytes()
    except FileNotFoundError as err:
        msg = f"{path}: no such file{nearest_file(path)}; name an STL file"
        raise CaseError(msg) from err
    except OSError as err:
        msg = f"{path}: cannot be read ({err.strerror}); name an STL file"
        raise CaseError(msg) from err
    if b"\0" in content[: _HEAD + _COUNT]:
        return _binary(path, content)
    corners = list(_corners(path, content.decode("utf-8", errors="replace").splitlines()))
    if not corners:
        msg = f"{path}: holds no triangle; name an STL file, text or binary"
        raise CaseError(msg)
    return np.array(corners, dtype=np.float64).reshape(-1, 3, 3)


def _binary(path: Path, content: bytes) -> Triangles:
    count = int.from_bytes(content[_HEAD : _HEAD + _COUNT], "little")
    size = _HEAD + _COUNT + _FACET.itemsize * count
    if len(content) != size:
        msg = (
            f"{path}: a binary STL file of {count} triangles has {size} bytes, this one "
            f"{len(content)}; it was cut short, or is no STL file"
        )
        raise CaseError(msg)
    found = np.frombuffer(content, _FACET, count, _HEAD + _COUNT)["corners"].astype(np.float64)
    bad = ~np.isfinite(found).all(axis=(1, 2))
    if bad.any() or not count:
        what = f"triangle {int(np.argmax(bad))} is not finite" if count else "holds no triangle"
        msg = f"{path}: {what}; write the mesh again"
        raise CaseError(msg)
    return np.asarray(found)


def _corners(path: Path, lines: Sequence[str]) -> Iterator[list[float]]:
    """Yield the corners of a text; its facets have three each and its last line ends the solid."""
    count, last = 0, ""
    for number, line in enumerate(lines, start=1):
        words = line.lower().split()
        last = words[0] if words else last
        if last == "endloop" and words and count % 3:
            msg = f"{path}:{number}: a facet without three corners; write the mesh again"
            raise CaseError(msg)
        if words[:1] != ["vertex"]:
            continue
        count += 1
        yield _corner(f"{path}:{number}", words[1:])
    if count % 3 or (count and last != "endsolid"):
        msg = f"{path}: the last line is not 'endsolid'; the file was cut short, or is no STL file"
        raise CaseError(msg)


def _corner(place: str, words: Sequence[str]) -> list[float]:
    try:
        found = [float("x" if "_" in word else word) for word in words]
    except ValueError:
        found = []
    if len(found) != len("xyz") or not np.isfinite(found).all():
        msg = f"{place}: a corner is not three finite numbers: {' '.join(words)[:60]!r}"
        raise CaseError(msg)
    return found
