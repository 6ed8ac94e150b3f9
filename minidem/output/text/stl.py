"""``dump mesh/stl``: meshes as STL, ASCII and binary."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from minidem.kernels.columns import A, B, C

__all__ = ["binary_stl_file", "stl_file"]

_FACET = (
    "  facet normal %g %g %g\n    outer loop\n"
    + "      vertex %g %g %g\n" * 3
    + "    endloop\n  endfacet\n"
)
_NAME = "LIGGGHTS_STL_EXPORT"
_HEADER = b"STL File written by LIGGGHTS".ljust(80)
_ROW = np.dtype([("numbers", "<f4", 12), ("attribute", "<u2")])


def stl_file(triangles: NDArray[np.float64]) -> str:
    """Return triangles as an ASCII STL file.

    Parameters
    ----------
    triangles : (n, 3, 3) ndarray
        Vertices of all meshes, one mesh after the other, m.

    Returns
    -------
    str
        The file as LIGGGHTS writes it, 6 digits per number.
    """
    rows = _rows(triangles)
    body = _FACET * len(triangles) % tuple(rows.ravel().tolist())
    return f"solid {_NAME}\n{body}endsolid {_NAME}\n"


def binary_stl_file(triangles: NDArray[np.float64]) -> bytes:
    """Return triangles (n, 3, 3), m, as the binary STL file that LIGGGHTS writes."""
    rows = np.zeros(len(triangles), _ROW)
    rows["numbers"] = _rows(triangles)
    return _HEADER + len(triangles).to_bytes(4, "little") + rows.tobytes()


def _rows(triangles: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return normal and vertices of each triangle, shape (n, 12)."""
    return np.concatenate([_normals(triangles), triangles.reshape(-1, 9)], axis=1)


def _normals(triangles: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return unit normals (n, 3), rounded as LIGGGHTS rounds them."""
    first = _unit(triangles[:, B] - triangles[:, A])
    second = _unit(triangles[:, C] - triangles[:, B])
    x, y, z = (first[:, d] for d in range(3))
    a, b, c = (second[:, d] for d in range(3))
    return _unit(np.stack([y * c - z * b, z * a - x * c, x * b - y * a], axis=1))


def _unit(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    x, y, z = (vectors[:, d] for d in range(3))
    length = np.sqrt(x * x + y * y + z * z)
    with np.errstate(divide="ignore", invalid="ignore"):
        found: NDArray[np.float64] = vectors * (1.0 / length)[:, None]
    return found
