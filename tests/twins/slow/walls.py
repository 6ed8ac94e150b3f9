"""Planes, cylinders and triangle meshes, slowly: the nearest point to a sphere, its velocity."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cos, radians, sin
from typing import NamedTuple

import numpy as np

from tests.twins.scene import AXES, Mesh, Motion, Primitive
from tests.twins.slow.triangle import active_features, nearest_feature, same_point, unit

CURVATURE = 1.0 - 1e-5


class Nearest(NamedTuple):
    """The nearest point of a wall: from it to the sphere, m; the wall's velocity there, m/s."""

    d: np.ndarray
    v: np.ndarray
    face: bool = False


# -- primitive walls -------------------------------------------------------------------------------


def nearest_of_primitive(wall: Primitive, x: np.ndarray) -> Nearest | None:
    """Return the nearest point of a plane or cylinder; None on the axis of a cylinder."""
    axis = AXES.index(wall.shape[0])
    v = np.zeros(3)
    if wall.shear:
        v[AXES.index(wall.shear[0])] = wall.shear[1]
    if wall.shape.endswith("plane"):
        d = np.zeros(3)
        d[axis] = x[axis] - wall.values[0]
        return Nearest(d, v)
    radius = wall.values[0]
    out = x.copy()
    out[axis] = 0.0
    out[(axis + 1) % 3] -= wall.values[1]
    out[(axis + 2) % 3] -= wall.values[2]
    distance = float(np.linalg.norm(out))
    if distance == 0.0:
        return None
    if wall.shear and wall.shear[0] != wall.shape[0]:
        # the cylinder turns: the number is a spin, and the velocity that of the sphere's centre
        spin = np.zeros(3)
        spin[axis] = wall.shear[1]
        v = np.cross(spin, out)
        if axis == 1:  # LIGGGHTS exchanges x and z
            v = wall.shear[1] * np.array([out[0], 0.0, -out[2]])
    return Nearest(out * (distance - radius) / distance, v)


def gap_of_primitive(wall: Primitive, x: np.ndarray) -> float:
    """Return the distance of a point to a plane or cylinder, m."""
    found = nearest_of_primitive(wall, x)
    return wall.values[0] if found is None else float(np.linalg.norm(found.d))


# -- triangle meshes -------------------------------------------------------------------------------


@dataclass
class Surface:
    """A mesh in motion.

    Attributes
    ----------
    nodes, v : ndarray, shape (n, 3, 3)
        Corners, m, and their velocities, m/s.
    limit : float
        Cosine above which facets are coplanar.
    edge_active, corner_active : ndarray of bool, shape (n, 3)
        Which edges and corners take contacts.
    """

    mesh: Mesh
    nodes: np.ndarray = field(init=False)
    v: np.ndarray = field(init=False)
    limit: float = field(init=False)
    edge_active: np.ndarray = field(init=False)
    corner_active: np.ndarray = field(init=False)

    def __post_init__(self) -> None:
        """Place the corners and find out which edges and corners are active."""
        self.nodes = np.array(self.mesh.nodes)
        self.v = np.zeros_like(self.nodes)
        curvature = self.mesh.curvature
        self.limit = CURVATURE if curvature is None else cos(radians(curvature))
        self.edge_active, self.corner_active = active_features(self.nodes, self.limit)
        if self.mesh.belt:
            for t in range(len(self.nodes)):
                self.v[t] = along_facet(np.array(self.mesh.belt), self.normal(t))

    def normal(self, t: int) -> np.ndarray:
        """Return the unit normal of a triangle."""
        a, b, c = self.nodes[t]
        return unit(np.cross(b - a, c - a))

    def coplanar_neighbours(self, a: int, b: int) -> bool:
        """Return True if two triangles share a corner and count as one plane."""
        if not abs(self.normal(a) @ self.normal(b)) > self.limit:
            return False
        return any(same_point(p, q) for p in self.nodes[a] for q in self.nodes[b])

    def nearest(self, t: int, x: np.ndarray) -> Nearest | None:
        """Return the nearest point of a triangle, None if another triangle takes it."""
        found = nearest_feature(self.nodes[t], x)
        if found.edge is not None and not self.edge_active[t, found.edge]:
            return None
        if found.corner is not None and not self.corner_active[t, found.corner]:
            return None
        return Nearest(found.d, found.weights @ self.v[t], found.face)


# -- motion ----------------------------------------------------------------------------------------


def along_facet(v: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Return a velocity laid into a facet, its size kept."""
    flat = v - (v @ normal) * normal
    return flat * np.linalg.norm(v) / np.linalg.norm(flat)


def _turned(x: np.ndarray, axis: np.ndarray, angle: float) -> np.ndarray:
    """Turn a vector about an axis (Rodrigues)."""
    turned: np.ndarray = (
        x * cos(angle) + np.cross(axis, x) * sin(angle) + axis * (axis @ x) * (1.0 - cos(angle))
    )
    return turned


def _rate(motion: Motion, t: float) -> float:
    """Return speed or spin along the axis of a motion that has one, at a time."""
    numbers = motion.numbers
    turns = 2.0 * np.pi / np.array(numbers["period"])
    if motion.style in ("viblin", "vibrot"):
        waves = zip(numbers["amplitude"], numbers["phase"], turns, strict=True)
        return -sum(a * w * sin(w * t + phase) for a, phase, w in waves)
    if motion.style == "rotate":
        return float(turns[0])
    return float(radians(numbers["amplitude"][0]) * turns[0] * cos(turns[0] * t))


def move(surface: Surface, t: float, dt: float) -> None:
    """Give the corners the velocity of time t, and let them go on with it for a step."""
    motion = surface.mesh.motion
    if motion is None:
        return
    numbers = motion.numbers
    if motion.style in ("linear", "wiggle", "viblin"):
        if motion.style == "linear":
            v = np.array(numbers["velocity"])
        elif motion.style == "wiggle":
            w = 2.0 * np.pi / numbers["period"][0]
            v = np.array(numbers["amplitude"]) * w * cos(w * t)
        else:
            v = unit(np.array(numbers["axis"])) * _rate(motion, t)
        surface.v[:] = v
        surface.nodes += v * dt
        return
    axis, origin = unit(np.array(numbers["axis"])), np.array(numbers["origin"])
    spin = _rate(motion, t)
    for node, v in zip(surface.nodes.reshape(-1, 3), surface.v.reshape(-1, 3), strict=True):
        node[:] = origin + _turned(node - origin, axis, spin * dt)
        v[:] = np.cross(spin * axis, node - origin)
