"""Random walls: planes and cylinders, meshes of several shapes, and their motions."""

from __future__ import annotations

import itertools

import numpy as np

from tests.twins.scene import AXES, Mesh, Motion
from tests.twins.slow.triangle import unit

WIDE = 0.02  # m, where spheres and meshes are, so that periodic images of meshes do not matter
TYPES = 2


def primitive(rng: np.random.Generator, shape: str, shear: bool) -> tuple[str, tuple, tuple | None]:
    """Return shape, numbers and shear of a wall near the middle of the box."""
    if shape == "plane":
        values = (float(rng.uniform(-0.5, 0.5) * WIDE),)
    else:
        values = (float(rng.uniform(0.5, 1.5) * WIDE), *map(float, rng.uniform(-0.004, 0.004, 2)))
    slides = (str(rng.choice(list(AXES))), float(rng.uniform(-5.0, 5.0))) if shear else None
    return str(rng.choice(list(AXES))) + shape, values, slides


def plate(rng: np.random.Generator) -> np.ndarray:
    """Two by two squares of two triangles each, in one plane."""
    del rng
    at = np.linspace(-0.7 * WIDE, 0.7 * WIDE, 3)
    found = []
    for x0, x1 in itertools.pairwise(at):
        for y0, y1 in itertools.pairwise(at):
            a, b, c, d = (x0, y0, 0.0), (x1, y0, 0.0), (x1, y1, 0.0), (x0, y1, 0.0)
            found += [(a, b, c), (a, c, d)]
    return np.array(found)


def fan(rng: np.random.Generator) -> np.ndarray:
    """Triangles around a corner: a pyramid without bottom, up or down."""
    sides = int(rng.integers(2, 6))
    angle = 2.0 * np.pi * np.arange(sides + 1) / max(sides, 3)
    rim = 0.7 * WIDE * np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    rim[-1] = rim[0] if sides > 2 else rim[-1]
    top = np.array([0.0, 0.0, rng.uniform(-0.6, 0.6) * WIDE])
    return np.array([(top, rim[k], rim[k + 1]) for k in range(sides)])


def gutter(rng: np.random.Generator) -> np.ndarray:
    """Facets of a part of a cylinder, 15 degrees from one to the next."""
    angle = np.radians(15.0) * np.arange(6)
    ring = WIDE * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    length = 0.5 * WIDE * rng.uniform(0.5, 1.0)
    found = []
    for p, q in itertools.pairwise(ring):
        a, b, c, d = (*p, -length), (*q, -length), (*q, length), (*p, length)
        found += [(a, b, c), (a, c, d)]
    return np.array(found) - np.array([0.5 * WIDE, 0.5 * WIDE, 0.0])


def splinters(rng: np.random.Generator) -> np.ndarray:
    """Triangles of any shape, thin and obtuse ones too, that have nothing in common."""
    found: list[np.ndarray] = []
    while len(found) < 4:
        a, b = rng.uniform(-0.7, 0.7, (2, 3)) * WIDE
        c = (
            a
            + rng.uniform(-0.5, 1.5) * (b - a)
            + rng.uniform(0.05, 0.5) * rng.normal(size=3) * WIDE
        )
        nodes = np.array([a, b, c])
        sides = [unit(nodes[(k + 1) % 3] - nodes[k]) for k in range(3)]
        # LIGGGHTS refuses angles below a few tenths of a degree
        if max(abs(sides[k] @ sides[k - 1]) for k in range(3)) < np.cos(np.radians(1.0)):
            found.append(nodes)
    return np.array(found)


SHAPES = {"plate": plate, "fan": fan, "gutter": gutter, "splinters": splinters}
MOTIONS = ("linear", "wiggle", "rotate", "riggle", "viblin", "vibrot")


def motion(rng: np.random.Generator, style: str) -> Motion:
    """Return a motion of up to about 1 m/s."""

    def some(low: float, high: float, count: int) -> tuple[float, ...]:
        return tuple(map(float, rng.uniform(low, high, count)))

    axis = {"axis": some(-1.0, 1.0, 3)}
    about = {"origin": some(-WIDE, WIDE, 3), **axis}
    waves = {"order": (2,), "amplitude": some(1e-4, 1e-3, 2), "phase": some(0.0, 3.0, 2)}
    waves |= {"period": some(0.005, 0.02, 2)}
    slow = {"period": some(0.2, 0.5, 1)}
    return Motion(
        style,
        {
            "linear": {"velocity": some(-0.5, 0.5, 3)},
            "wiggle": {"amplitude": some(-1e-3, 1e-3, 3), "period": some(0.01, 0.02, 1)},
            "rotate": about | slow,
            "riggle": about | slow | {"amplitude": some(10.0, 50.0, 1)},
            "viblin": axis | waves,
            "vibrot": about | waves | {"amplitude": some(5e-3, 3e-2, 2)},
        }[style],
    )


def mesh(rng: np.random.Generator, shape: str, way: str, curved: bool) -> Mesh:
    """Return a mesh, turned somehow, its triangles beginning with any corner."""
    nodes = SHAPES[shape](rng)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    nodes = nodes @ turn.T
    nodes = np.array([np.roll(triangle, rng.integers(3), axis=0) for triangle in nodes])
    return Mesh(
        tuple(tuple(tuple(map(float, point)) for point in triangle) for triangle in nodes),
        int(rng.integers(1, TYPES + 1)),
        20.0 if curved and shape == "gutter" else None,
        tuple(map(float, rng.uniform(-1.0, 1.0, 3))) if way == "belt" else None,
        motion(rng, way) if way in MOTIONS else None,
    )
