"""Values of single triangles that the particles of a run make: force and wear."""

from __future__ import annotations

import numpy as np

from minidem.kernels.columns import A, B, C
from minidem.world.state import Floats

__all__ = ["Facets", "areas"]


class Facets:
    """Force and wear of the triangles of a mesh.

    Parameters
    ----------
    count : int
        Number of triangles.

    Attributes
    ----------
    force : ndarray, shape (n, 3)
        Of the particles on each triangle at the end of the last step, N.
    worn : ndarray, shape (n,)
        Wear depth times area, m3.
    """

    def __init__(self, count: int) -> None:
        self.force: Floats = np.zeros((count, 3))
        self.worn: Floats = np.zeros(count)

    def stress(self, normal: Floats, area: Floats) -> tuple[Floats, Floats]:
        """Return the sizes of normal and shear stress, Pa.

        Parameters
        ----------
        normal : ndarray, shape (n, 3)
            Unit normals.
        area : ndarray, shape (n,)
            m2.
        """
        along: Floats = (self.force * normal).sum(axis=1)
        across = np.linalg.norm(self.force - along[:, None] * normal, axis=1)
        return np.abs(along) / area, across / area


def areas(nodes: Floats) -> Floats:
    """Return the areas of triangles, shape (n, 3, 3), in m2."""
    across = np.cross(nodes[:, B] - nodes[:, A], nodes[:, C] - nodes[:, B])
    found: Floats = 0.5 * np.linalg.norm(across, axis=1)
    return found
