"""Random points behind a planar face of triangles."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from minidem.kernels.columns import LOWER, ONLY, RIM_FROM, RIM_TO, UPPER, A, B, C, X, Y, Z
from minidem.kernels.insertion.grid import Grid, add_sphere, overlaps
from minidem.kernels.insertion.place import Batch, Generators, Rules, border_distance
from minidem.kernels.insertion.random import draw_orientation, uniform
from minidem.kernels.machine.jit import inlined, kernel
from minidem.kernels.machine.space import vector

__all__ = ["RIM", "Face", "Layer", "count_behind_face", "place_behind_face", "project_on_face"]

RIM = 6
"""Edges that are compared per triangle."""
_PATIENCE = 500
_MARGIN = 1e-8
_TOLERANCE = 1e-10


class Face(NamedTuple):
    """A planar insertion face.

    Attributes
    ----------
    nodes : (n, 3, 3) float64
        Vertices, m.
    area : (n,) float64
        Areas added up to and including each triangle, m2.
    rim : (n, 6, 2, 3) float64
        Edges that spheres keep away from with ``all_in yes``; not a number where there is none.
    least : (n,) float64
        Spheres with a smaller radius need no test, m.
    """

    nodes: NDArray[np.float64]
    area: NDArray[np.float64]
    rim: NDArray[np.float64]
    least: NDArray[np.float64]


class Layer(NamedTuple):
    """Where spheres start behind a face.

    Attributes
    ----------
    normal : (3,) float64
        Unit normal of the face.
    length : float
        Thickness of the layer behind it, m.
    """

    normal: NDArray[np.float64]
    length: float


@inlined
def _point_on_face(face: Face, state: NDArray[np.float64], p: NDArray[np.float64]) -> int:
    """Write a random point of the face to `p`; return its triangle."""
    low = 0
    high = face.area.shape[0] - 1
    target = uniform(state) * face.area[high]
    while low < high:
        middle = (low + high) // 2
        if target > face.area[middle]:
            low = middle + 1
        else:
            high = middle
    u = 1.0
    v = 1.0
    while u + v > 1.0:
        u = uniform(state)
        v = uniform(state)
    w = 1.0 - u - v
    for d in range(3):
        nodes = face.nodes[low]
        p[d] = w * nodes[A, d] + v * nodes[B, d] + u * nodes[C, d]
    return low


@inlined
def _near_rim(face: Face, t: int, p: NDArray[np.float64], r: float) -> bool:
    """Tell whether a point of triangle t is nearer than r to an edge of the face."""
    if face.least[t] >= r:
        return False
    for k in range(RIM):
        along2 = 0.0
        s = 0.0
        for d in range(3):
            along = face.rim[t, k, RIM_TO, d] - face.rim[t, k, RIM_FROM, d]
            along2 += along * along
            s += along * (p[d] - face.rim[t, k, RIM_FROM, d])
        if not along2 > 0.0:
            break
        s = min(max(s / along2, 0.0), 1.0)
        far2 = 0.0
        for d in range(3):
            along = face.rim[t, k, RIM_TO, d] - face.rim[t, k, RIM_FROM, d]
            far2 += (p[d] - face.rim[t, k, RIM_FROM, d] - s * along) ** 2
        if far2 < r * r:
            return True
    return False


@inlined
def _in_box(p: NDArray[np.float64], box: NDArray[np.float64]) -> bool:
    """Tell whether a point is in the simulation box; its planes count in with a small margin."""
    for d in range(3):
        if p[d] < box[LOWER, d] - _MARGIN or p[d] >= box[UPPER, d] + _MARGIN:
            return False
    return True


@kernel
def count_behind_face(
    face: Face,
    normal: NDArray[np.float64],
    length: float,
    box: NDArray[np.float64],
    mesh: NDArray[np.float64],
    base: NDArray[np.float64],
    tries: int,
) -> int:
    """Count random points behind the face that are in the box; advances both generators."""
    p = vector(3)
    hits = 0
    for _ in range(tries):
        _point_on_face(face, mesh, p)
        r = -1.0 * (uniform(base) * length)
        for d in range(3):
            p[d] += normal[d] * r
        if _in_box(p, box):
            hits += 1
    return hits


@kernel
def project_on_face(
    face: Face,
    normal: NDArray[np.float64],
    points: NDArray[np.float64],
    above: float,
    below: float,
    result: NDArray[np.bool_],
) -> None:
    """Write which points lie between two heights over the face and project onto it, shape (N,)."""
    reference = face.nodes[ONLY, A]
    a = vector(3)
    b = vector(3)
    c = vector(3)
    for i in range(points.shape[0]):
        result[i] = False
        height = 0.0
        for d in range(3):
            height += (points[i, d] - reference[d]) * normal[d]
        if height > above or height < below:
            continue
        for t in range(face.area.shape[0]):
            nodes = face.nodes[t]
            for d in range(3):
                a[d] = nodes[C, d] - nodes[A, d]
                b[d] = nodes[B, d] - nodes[A, d]
                c[d] = points[i, d] + height * normal[d] - nodes[A, d]
            aa = a[X] * a[X] + a[Y] * a[Y] + a[Z] * a[Z]
            ab = a[X] * b[X] + a[Y] * b[Y] + a[Z] * b[Z]
            ac = a[X] * c[X] + a[Y] * c[Y] + a[Z] * c[Z]
            bb = b[X] * b[X] + b[Y] * b[Y] + b[Z] * b[Z]
            bc = b[X] * c[X] + b[Y] * c[Y] + b[Z] * c[Z]
            scale = 1.0 / (aa * bb - ab * ab)
            u = (bb * ac - ab * bc) * scale
            v = (aa * bc - ab * ac) * scale
            if u > -_TOLERANCE and v > -_TOLERANCE and u + v < 1.0 + _TOLERANCE:
                result[i] = True
                break


@kernel
def place_behind_face(
    face: Face,
    rules: Rules,
    layer: Layer,
    box: NDArray[np.float64],
    batch: Batch,
    generators: Generators,
    grid: Grid,
) -> int:
    """Place spheres behind a face, one after the other; return how many found a place.

    Arguments as in `minidem.kernels.insertion.place.place_in_region`; points are chosen on the
    face.
    """
    mesh = generators.place
    base = generators.base
    radii = batch.radii
    attempts = batch.attempts
    normal = layer.normal
    length = layer.length
    p = vector(3)
    tried = 0
    done = 0
    for _ in range(radii.shape[0] if not rules.check_overlap else attempts + radii.shape[0]):
        if done >= radii.shape[0] or (rules.check_overlap and tried >= attempts):
            break
        r = radii[done]
        while True:
            t = _point_on_face(face, mesh, p)
            if rules.all_in:
                for _again in range(_PATIENCE - 1):
                    if not _near_rim(face, t, p, r):
                        break
                    t = _point_on_face(face, mesh, p)
            if rules.check_overlap:
                depth = -1.0 * (uniform(base) * length + r + 0.0)
            else:
                depth = -1.0 * (uniform(base) * (length - 2.0 * r) + r + 0.0)
            for d in range(3):
                p[d] += normal[d] * depth
            tried += 1
            if tried >= attempts:
                break
            if _in_box(p, box) and (not rules.check_overlap or border_distance(p, box) >= r):
                break
        if tried >= attempts:
            continue
        if rules.turned:
            draw_orientation(base)
        if rules.check_overlap:
            if overlaps(grid, p, r):
                continue
            add_sphere(grid, batch.near + done, p, r)
        for d in range(3):
            batch.position[done, d] = p[d]
        done += 1
    return done
