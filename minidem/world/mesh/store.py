"""All triangles of a simulation in one set of arrays, mesh after mesh."""

from __future__ import annotations

import numpy as np

from minidem.kernels.motion.frames import facet_frames
from minidem.kernels.tables import Mesh
from minidem.record import field, record
from minidem.world.mesh.edges import EQUAL
from minidem.world.mesh.surface import corners_outside
from minidem.world.state import Floats, Ints

__all__ = ["MeshStore"]


@record
class MeshStore:
    """Triangles of all meshes.

    Attributes
    ----------
    names : list of str
        Ids of the mesh fixes, in order.
    table : Mesh
        The arrays, see `minidem.kernels.tables`; images beyond periodic faces come last.
    limits : list of float
        Per mesh the cosine above which facets are coplanar.
    equal : list of float
        Per mesh the distance below which nodes are one, m.
    images : int
        Number of images.
    settled : int
        Number of meshes that were there in an earlier run.
    """

    names: list[str] = field(default_factory=list)
    limits: list[float] = field(default_factory=list)
    equal: list[float] = field(default_factory=list)
    table: Mesh = field(default_factory=lambda: _empty(0, 0))
    images: int = 0
    settled: int = 0

    @property
    def count(self) -> int:
        """Number of triangles without images."""
        return len(self.table.node) - self.images

    def span(self, name: str) -> tuple[int, int]:
        """Return first and last + 1 triangle of a mesh."""
        own = np.flatnonzero(self.table.owner[: self.count] == self.names.index(name))
        return (int(own[0]), int(own[-1]) + 1) if len(own) else (0, 0)

    def add(
        self, name: str, nodes: Floats, flags: Ints, limit: float, equal: float = EQUAL
    ) -> None:
        """Append a mesh; there are no images then."""
        count = len(nodes)
        new = _empty(count, 1)
        new.node[:] = nodes
        new.held[:] = nodes
        new.flags[:] = flags
        new.owner[:] = len(self.names)
        new.base[:] = self.count + np.arange(count)
        joined = [np.concatenate(pair) for pair in zip(self.table, new, strict=True)]
        self.table = Mesh._make(joined)
        self.names.append(name)
        self.limits.append(limit)
        self.equal.append(equal)
        facet_frames(self.table, self.count - count, self.count)

    def remove(self, name: str) -> Ints:
        """Take a mesh out; return the new number of every old triangle (-1 if gone)."""
        number = self.names.index(name)
        keep = self.table.owner != number
        renumbered = np.where(keep, np.cumsum(keep) - 1, -1).astype(np.int64)
        *arrays, origin = self.table
        rows = [np.ascontiguousarray(a[keep]) for a in arrays]
        self.table = Mesh._make([*rows, np.delete(origin, number, axis=0)])
        self.table.owner[self.table.owner > number] -= 1
        self.table.base[:] = np.arange(len(keep.nonzero()[0]))
        del self.names[number], self.limits[number], self.equal[number]
        self.settled -= int(number < self.settled)
        return renumbered

    def settle(self, lo: Floats, hi: Floats) -> int:
        """Decide about corners outside the box, m, of meshes that are in a run for the first time.

        There are no images then. Returns the number of the first of these meshes.
        """
        earlier = self.settled
        new = self.table.owner >= self.settled
        self.table.flags[new] |= corners_outside(self.table.node[new], lo, hi)
        self.settled = len(self.names)
        return earlier

    def drop_images(self) -> Ints:
        """Take all images out; return the triangle of every row there was."""
        count = self.count
        base: Ints = self.table.base.copy()
        if self.images:
            *arrays, origin = self.table
            rows = [np.ascontiguousarray(a[:count]) for a in arrays]
            self.table = Mesh._make([*rows, origin])
            self.images = 0
        return base

    def add_images(self, base: Ints, shift: Floats) -> None:
        """Append images of triangles `base`, moved by `shift`, shape (m, 3), m."""
        *arrays, origin = self.table  # one per mesh, the others one per triangle
        rows = [np.concatenate([a, a[base]]) for a in arrays]
        self.table = Mesh._make([*rows, origin])
        self.images = len(base)
        self.table.shift[self.count :] = shift
        self.table.node[self.count :] += shift[:, None, :]
        self.table.held[self.count :] += shift[:, None, :]


def _empty(count: int, meshes: int) -> Mesh:
    """Return tables for a number of triangles and meshes."""
    return Mesh(
        node=np.zeros((count, 3, 3)),
        vel=np.zeros((count, 3, 3)),
        edge=np.zeros((count, 3, 3)),
        length=np.zeros((count, 3)),
        normal=np.zeros((count, 3)),
        flags=np.zeros(count, np.int64),
        bound=np.zeros(count),
        owner=np.zeros(count, np.int64),
        held=np.zeros((count, 3, 3)),
        base=np.zeros(count, np.int64),
        shift=np.zeros((count, 3)),
        origin=np.zeros((meshes, 3)),
    )
