"""Edges, normals and flags of triangles, from their nodes."""

from __future__ import annotations

from math import sqrt
from typing import Any

from minidem.kernels.columns import AB, BC, CA, OBTUSE_BIT, A, B, C, X, Y, Z
from minidem.kernels.machine.jit import kernel

__all__ = ["facet_frames"]

OBTUSE = 1 << OBTUSE_BIT


@kernel
def facet_frames(mesh: Any, lo: int, hi: int) -> None:
    """Work out edges, normals, bounding radius and the obtuse flag of triangles lo to hi."""
    for t in range(lo, hi):
        for k in range(3):
            j = (k + 1) % 3
            dx = mesh.node[t, j, X] - mesh.node[t, k, X]
            dy = mesh.node[t, j, Y] - mesh.node[t, k, Y]
            dz = mesh.node[t, j, Z] - mesh.node[t, k, Z]
            size = sqrt(dx * dx + dy * dy + dz * dz)
            mesh.length[t, k] = size
            inv = 1.0 / size
            mesh.edge[t, k, X] = dx * inv
            mesh.edge[t, k, Y] = dy * inv
            mesh.edge[t, k, Z] = dz * inv
        e = mesh.edge[t]
        nx = e[AB, Y] * e[BC, Z] - e[AB, Z] * e[BC, Y]
        ny = e[AB, Z] * e[BC, X] - e[AB, X] * e[BC, Z]
        nz = e[AB, X] * e[BC, Y] - e[AB, Y] * e[BC, X]
        size = sqrt(nx * nx + ny * ny + nz * nz)
        if size < 1.0e-15:
            mesh.normal[t, X] = -e[AB, Y]
            mesh.normal[t, Y] = e[AB, X]
            mesh.normal[t, Z] = e[AB, Z]
        else:
            inv = 1.0 / size
            mesh.normal[t, X] = nx * inv
            mesh.normal[t, Y] = ny * inv
            mesh.normal[t, Z] = nz * inv
        dot = e[CA, X] * e[BC, X] + e[CA, Y] * e[BC, Y] + e[CA, Z] * e[BC, Z]
        mesh.flags[t] = (mesh.flags[t] & ~OBTUSE) | (OBTUSE if dot > 0.0 else 0)
        far = 0.0
        for k in range(3):
            d2 = 0.0
            for c in range(3):
                mid = (mesh.node[t, A, c] + mesh.node[t, B, c] + mesh.node[t, C, c]) / 3.0
                d2 += (mesh.node[t, k, c] - mid) ** 2
            far = max(far, sqrt(d2))
        mesh.bound[t] = far
