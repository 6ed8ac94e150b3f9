"""Lattices: points of space in rows, with the operations in LIGGGHTS' order."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from math import sqrt

import numpy as np

from minidem.errors import InputError
from minidem.kernels.columns import X, Y, Z
from minidem.record import record
from minidem.world.state import Floats, Ints

__all__ = ["STYLES", "Lattice"]

_CORNERS = ((0.0, 0.0, 0.0), (0.5, 0.5, 0.5))
_FACES = ((0.0, 0.0, 0.0), (0.5, 0.5, 0.0), (0.5, 0.0, 0.5), (0.0, 0.5, 0.5))
_HEXAGONS = ((0.0, 0.0, 0.0), (0.5, 0.5, 0.0), (0.5, 5.0 / 6.0, 0.5), (0.0, 1.0 / 3.0, 0.5))
_DIAMOND = (
    (0.0, 0.0, 0.0), (0.0, 0.5, 0.5), (0.5, 0.0, 0.5), (0.5, 0.5, 0.0),
    (0.25, 0.25, 0.25), (0.25, 0.75, 0.75), (0.75, 0.25, 0.75), (0.75, 0.75, 0.25),
)  # fmt: skip
STYLES = {
    "sc": _CORNERS[:1], "bcc": _CORNERS, "fcc": _FACES, "hcp": _HEXAGONS, "diamond": _DIAMOND,
    "custom": (),
}  # fmt: skip
"""Style to the points of its unit cell, in parts of the cell's vectors."""
_CYCLES = ((X, Y, Z), (Y, Z, X), (Z, X, Y))
_CHUNK = 1_000_000  # points worked out at once
_MOST = 1_000_000_000  # points of a lattice in the box


@record
class Lattice:
    """What the command ``lattice`` has set.

    Attributes
    ----------
    scale : float
        Box units per lattice unit, m.
    basis : ndarray, shape (m, 3)
        Points of the unit cell, in parts of its vectors; none for ``lattice none``.
    vectors : ndarray, shape (3, 3)
        Vectors of the unit cell, one a row.
    orient : ndarray, shape (3, 3)
        Directions of the box's axes in the lattice, one a row.
    origin : ndarray, shape (3,)
        Shift of the lattice, in spacings.
    spacing : ndarray, shape (3,)
        Extent of a cell along the axes of the box, m.
    """

    scale: float
    basis: Floats
    vectors: Floats
    orient: Floats
    origin: Floats
    spacing: Floats

    @classmethod
    def none(cls, scale: float = 1.0) -> Lattice:
        """Return a lattice without points, which only scales."""
        empty = np.zeros((0, 3))
        return cls(scale, empty, np.eye(3), np.eye(3), np.zeros(3), np.full(3, scale))

    def check(self) -> None:
        """Refuse what makes no lattice of space; InputError says why."""
        rows = self.orient
        if not len(self.basis):
            msg = "No basis atoms in lattice; give 'basis X Y Z'"
            raise InputError(msg)
        if any(rows[a] @ rows[b] for a, b in ((0, 1), (1, 2), (0, 2))):
            msg = "Lattice orient vectors are not orthogonal"
            raise InputError(msg)
        if np.cross(rows[0], rows[1]) @ rows[2] <= 0.0:
            msg = "Lattice orient vectors are not right-handed"
            raise InputError(msg)
        if self._determinant() == 0.0:
            msg = "Degenerate lattice primitive vectors; a1, a2 and a3 must span space"
            raise InputError(msg)

    def measure(self) -> None:
        """Work out the spacing as the extent of a cell."""
        self.spacing = np.zeros(3)
        corners = self.to_box(np.array(list(product((0.0, 1.0), repeat=3))))
        self.spacing = corners.max(axis=0) - corners.min(axis=0)

    def to_box(self, points: Floats) -> Floats:
        """Return the positions in the box of points of the lattice, shape (n, 3), m."""
        turned = _apply(self._directions(), _apply(self.vectors.T, points) * self.scale)
        return turned + self.spacing * self.origin

    def from_box(self, points: Floats) -> Floats:
        """Return the places in the lattice of positions in the box, shape (n, 3)."""
        moved = points - self.spacing * self.origin
        return _apply(self._inverse(), _apply(self._directions().T, moved) / self.scale)

    def points(self, lo: Floats, hi: Floats) -> Iterator[tuple[Floats, Ints]]:
        """Yield all points in and near a box, in LIGGGHTS' order, some at a time.

        Parameters
        ----------
        lo, hi : ndarray, shape (3,)
            Corners of the box, m.

        Yields
        ------
        ndarray, shape (n, 3)
            Positions, m.
        ndarray of int64, shape (n,)
            Which point of the unit cell each is.

        Raises
        ------
        InputError
            If there are too many.
        """
        corners = self.from_box(np.array(list(product(*zip(lo, hi, strict=True)))))
        least, most = corners.min(axis=0), corners.max(axis=0)
        first = np.trunc(least) - 1 - (least < 0.0)
        count = np.trunc(most) + 1 - first + 1
        total = float(np.prod(count)) * len(self.basis)
        if not total <= _MOST:
            msg = f"the box holds about {total:.3g} points of the lattice; make its scale larger"
            raise InputError(msg)
        nx, ny, _ = count.astype(np.int64)
        for start in range(0, int(total), _CHUNK):
            cell, which = np.divmod(
                np.arange(start, min(start + _CHUNK, int(total))), len(self.basis)
            )
            rows, i = np.divmod(cell, nx)
            k, j = np.divmod(rows, ny)
            yield self.to_box(first + np.stack([i, j, k], axis=1) + self.basis[which]), which

    def _directions(self) -> Floats:
        """Return the matrix that turns the lattice into the box."""
        lengths = [sqrt(float(row @ row)) for row in self.orient]
        found: Floats = self.orient / np.array(lengths)[:, None]
        return found

    def _determinant(self) -> float:
        p = self.vectors.T
        even = [p[X, a] * p[Y, b] * p[Z, c] for a, b, c in _CYCLES]
        odd = [p[X, a] * p[Y, c] * p[Z, b] for a, b, c in _CYCLES]
        return float(even[X] + even[Y] + even[Z] - odd[X] - odd[Y] - odd[Z])

    def _inverse(self) -> Floats:
        """Return the inverse of the matrix with the vectors as columns."""
        p = self.vectors.T
        found = np.zeros((3, 3))
        for (a, u, v), (b, r, s) in product(_CYCLES, repeat=2):
            found[a, b] = p[r, u] * p[s, v] - p[r, v] * p[s, u]
        return found / self._determinant()


def _apply(matrix: Floats, points: Floats) -> Floats:
    """Return matrix times points, each sum from left to right."""
    x, y, z = points[:, X], points[:, Y], points[:, Z]
    return np.stack([row[X] * x + row[Y] * y + row[Z] * z for row in matrix], axis=1)
