"""Small meshes of many shapes about the origin, m, before they are turned and mixed."""

from __future__ import annotations

import itertools

import numpy as np

from tests.twins.slow.triangle import unit

SIZE = 0.01  # m, about half the width of a mesh
LEAST_ANGLE = 0.26  # degrees; LIGGGHTS refuses smaller ones, its default limit of curvature


def _angles_are_allowed(nodes: np.ndarray) -> bool:
    sides = [unit(nodes[(k + 1) % 3] - nodes[k]) for k in range(3)]
    return max(-sides[k] @ sides[k - 1] for k in range(3)) < np.cos(np.radians(LEAST_ANGLE))


def _kept(nodes: np.ndarray) -> np.ndarray:
    """Leave out triangles that LIGGGHTS would refuse."""
    found = [triangle for triangle in nodes if _angles_are_allowed(triangle)]
    return np.array(found).reshape(-1, 3, 3)


def single(rng: np.random.Generator) -> np.ndarray:
    """Return one triangle of any size, two of its sides at any angle: obtuse, needles, slivers."""
    size = SIZE * 10.0 ** rng.uniform(-2.5, 0.3)
    angle = np.pi * rng.choice([rng.uniform(0.01, 0.99), rng.uniform(0.6, 0.99), 0.002, 0.9985])
    ratio = rng.choice([1.0, 10.0 ** rng.uniform(-2.0, 0.0)])
    far = ratio * np.array([np.cos(angle), np.sin(angle), 0.0])
    found = size * np.array([[(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), tuple(far)]])
    return found if _angles_are_allowed(found[0]) else single(rng)


def splinters(rng: np.random.Generator) -> np.ndarray:
    """Return a few triangles in any position, through each other even."""
    count = int(rng.integers(2, 6))
    return np.concatenate([single(rng) + rng.normal(size=3) * 0.2 * SIZE for _ in range(count)])


def box(rng: np.random.Generator) -> np.ndarray:
    """Return a closed box of twelve triangles."""
    half = SIZE * rng.uniform(0.1, 1.0, 3)
    corner = np.array(list(itertools.product((-1.0, 1.0), repeat=3))) * half
    quads = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    return np.array(
        [corner[list(k)] for a, b, c, d in quads
         for k in (((a, b, c), (a, c, d)) if rng.uniform() < 0.5 else ((a, b, d), (b, c, d)))]
    )  # fmt: skip


def cylinder(rng: np.random.Generator) -> np.ndarray:
    """Return the mantle of a cylinder or a part of it."""
    sides = int(rng.integers(3, 11))
    whole = sides if rng.uniform() < 0.5 else 40
    angle = 2.0 * np.pi / whole * np.arange(sides + 1)
    ring = SIZE * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    if whole == sides:
        ring[-1] = ring[0]
    length = SIZE * rng.uniform(0.2, 1.0)
    found = []
    for p, q in itertools.pairwise(ring):
        a, b, c, d = (*p, -length), (*q, -length), (*q, length), (*p, length)
        found += [(a, b, c), (a, c, d)]
    return np.array(found) - np.array(found).mean(axis=(0, 1)) * (whole != sides)


def fan(rng: np.random.Generator) -> np.ndarray:
    """Return triangles around a hub: a cone or a disc, whole or in part, of any angles."""
    sides = int(rng.integers(3, 13))
    angle = 2.0 * np.pi * np.arange(sides) / sides
    if rng.uniform() < 0.5:
        angle = angle + rng.uniform(-0.3, 0.3, sides) * 2.0 * np.pi / sides
    reach = SIZE * (rng.uniform(0.2, 1.0, sides) if rng.uniform() < 0.5 else np.ones(sides))
    rim = reach[:, None] * np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    hub = np.array([0.0, 0.0, rng.choice([0.0, rng.uniform(-0.5, 0.5), 1e-3]) * SIZE])
    count = sides if rng.uniform() < 0.7 else int(rng.integers(2, sides + 1))
    return _kept(np.array([(hub, rim[k], rim[(k + 1) % sides]) for k in range(count)]))


def _net(rng: np.random.Generator, height: np.ndarray) -> np.ndarray:
    """Return a net of squares, each cut along a diagonal, over a table of heights."""
    across, along = height.shape
    x = SIZE * np.sort(rng.uniform(-1.0, 1.0, across))
    y = SIZE * np.sort(rng.uniform(-1.0, 1.0, along))
    found = []
    for i, j in itertools.product(range(across - 1), range(along - 1)):
        a, b, c, d = (
            (x[p], y[q], height[p, q]) for p, q in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))
        )
        found += [(a, b, c), (a, c, d)] if rng.uniform() < 0.5 else [(a, b, d), (b, c, d)]
    return _kept(np.array(found))


def plate(rng: np.random.Generator) -> np.ndarray:
    """Return a plane cut into rectangles of any width."""
    return _net(rng, np.zeros(rng.integers(2, 5, 2)))


def hills(rng: np.random.Generator) -> np.ndarray:
    """Return a net with random heights."""
    return _net(
        rng, SIZE * 10.0 ** rng.uniform(-4.0, -0.3) * rng.normal(size=rng.integers(2, 5, 2))
    )


def saddle(rng: np.random.Generator) -> np.ndarray:
    """Return a net of four rectangles on a saddle."""
    height = np.outer([-1.0, 0.0, 1.0], [-1.0, 0.0, 1.0])
    return _net(rng, SIZE * rng.uniform(0.0, 0.5) * height)


def strip(rng: np.random.Generator) -> np.ndarray:
    """Return a zigzag of triangles, folded more or less at every edge."""
    count = int(rng.integers(2, 21))
    points = np.zeros((count + 2, 3))
    points[:, 0] = np.linspace(-1.0, 1.0, count + 2)
    points[1::2, 1] = rng.uniform(0.05, 0.6)
    points[:, 2] = rng.normal(size=count + 2) * rng.choice([0.0, 0.01, 0.3])
    return _kept(SIZE * np.stack([points[:-2], points[1:-1], points[2:]], axis=1))


def book(rng: np.random.Generator) -> np.ndarray:
    """Return three to five triangles on one edge."""
    spine = np.array([(0.0, 0.0, -1.0), (0.0, 0.0, 1.0)]) * rng.uniform(0.1, 1.0)
    found = []
    for _ in range(int(rng.integers(3, 6))):
        angle = rng.uniform(0.0, 2.0 * np.pi)
        page = (np.cos(angle), np.sin(angle), rng.uniform(-1.0, 1.0))
        found.append((*spine, page))
    return _kept(SIZE * np.array(found))


def steps(rng: np.random.Generator) -> np.ndarray:
    """Return two plates in one plane whose nodes do not meet: corners in the middle of edges."""
    one, other = plate(rng), plate(rng)
    if not len(one) or not len(other):
        return one
    other[:, :, 0] += one[:, :, 0].max() - other[:, :, 0].min()
    found = np.concatenate([one, other])
    return found - found.mean(axis=(0, 1))


SHAPES = (single, splinters, box, cylinder, fan, plate, hills, saddle, strip, book, steps)


def turned(rng: np.random.Generator, nodes: np.ndarray) -> np.ndarray:
    """Turn a mesh in space, at times; mix its triangles, their first corners and their sides."""
    if rng.uniform() < 0.8:
        turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        nodes = nodes @ turn.T
    nodes = nodes[rng.permutation(len(nodes))]
    mirrored = rng.uniform(size=len(nodes)) < rng.choice([0.0, 0.5])
    nodes[mirrored] = nodes[mirrored][:, ::-1]
    return np.array([np.roll(triangle, rng.integers(3), axis=0) for triangle in nodes])


def shape(rng: np.random.Generator) -> np.ndarray:
    """Return a mesh of any shape, at least one triangle, shape (n, 3, 3), m."""
    while True:
        nodes = SHAPES[rng.integers(len(SHAPES))](rng)
        if len(nodes):
            return turned(rng, nodes)
