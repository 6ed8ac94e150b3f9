"""Write and read triangle meshes as ASCII STL, and build the few shapes the experiments need.

A mesh is an array of shape (n, 3, 3): triangle, corner, coordinate [m].
"""

from __future__ import annotations

from pathlib import Path
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from liggghts_io.errors import CaseError

Triangles: TypeAlias = npt.NDArray[np.float64]
Point: TypeAlias = tuple[float, float, float]


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
    """Read an ASCII STL file.

    Raises
    ------
    CaseError
        If the file is not text or was cut short, the number of corners is not a multiple of
        three, or a corner is not three finite numbers.
    """
    text = path.read_bytes().decode("utf-8", errors="replace")
    rows = [line.split()[1:] for line in text.splitlines() if line.lstrip().startswith("vertex")]
    if not rows or len(rows) % 3:
        msg = f"{path}: {len(rows)} corners; an ASCII STL file has three for each triangle"
        raise CaseError(msg)
    try:
        corners = np.array(rows, dtype=np.float64).reshape(-1, 3, 3)
    except ValueError as err:
        msg = f"{path}: a corner is not three numbers"
        raise CaseError(msg) from err
    if not np.isfinite(corners).all():
        msg = f"{path}: a corner is not finite"
        raise CaseError(msg)
    if not text.rstrip().rpartition("\n")[2].startswith("endsolid"):
        msg = f"{path}: the last line is not 'endsolid'; the file was cut short, or is no ASCII STL"
        raise CaseError(msg)
    return corners
