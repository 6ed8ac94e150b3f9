"""Spheres on planes and cylinders: either side, inside and outside, several at once, sheared."""

from __future__ import annotations

import numpy as np

from tests.twins.references.batch import Batch
from tests.twins.references.places import HALF, atoms, dump, header, words
from tests.twins.scene import Model, Primitive
from tests.twins.slow.shapes import primitive
from tests.twins.slow.walls import nearest_of_primitive

SPHERES = 200
WALLS = 6
MODEL = "model hertz tangential history"
LEAST, MOST = 0.001, 0.004  # m, radii
COLUMNS = "id x y z vx vy vz fx fy fz tqx tqy tqz"


def batch(seed: int) -> Batch:
    """Return 200 spheres of a seed, each near one of six walls and perhaps near others."""
    rng = np.random.default_rng([37, seed])
    walls = [_wall(rng) for _ in range(WALLS)]
    points, radii = [], []
    while len(points) < SPHERES:
        radius = rng.uniform(LEAST, MOST)
        x = rng.uniform(-0.9, 0.9, 3) * HALF
        found = nearest_of_primitive(walls[rng.integers(WALLS)], x)
        if found is None:
            continue
        near = radius * (1.0 - rng.uniform(-0.01, 0.02))
        gap = np.linalg.norm(found.d)
        x += (near - gap) / gap * found.d
        gaps = [nearest_of_primitive(wall, x) for wall in walls]
        clear = all(g is not None and np.linalg.norm(g.d) > 0.8 * radius for g in gaps)
        apart = all(np.linalg.norm(x - p) > radius + r for p, r in zip(points, radii, strict=True))
        if clear and apart and (np.abs(x) < 0.95 * HALF).all():
            points.append(x)
            radii.append(radius)
    v = rng.normal(size=(SPHERES, 3)) * 0.3
    lines = [*header(), *atoms(np.array(points), np.array(radii), v)]
    lines += [f"fix w{k} all wall/gran {MODEL} {_words(wall)}" for k, wall in enumerate(walls)]
    way = rng.normal(size=3)
    lines += [f"fix g all gravity 100 vector {words(way)}", "fix free all nve/sphere"]
    lines += [*dump("out", 40, COLUMNS), "run 1", "run 199", ""]
    return Batch(f"walls-{seed}", "\n".join(lines), ("out.dump",), SPHERES)


def _wall(rng: np.random.Generator) -> Primitive:
    shape = str(rng.choice(["plane", "cylinder"]))
    word, values, shear = primitive(rng, shape, bool(rng.integers(2)))
    scaled = tuple(2.0 * value for value in values)
    return Primitive(Model({}), word, scaled, 1, shear)


def _words(wall: Primitive) -> str:
    shear = f" shear {wall.shear[0]} {wall.shear[1]!r}" if wall.shear else ""
    return f"primitive type 1 {wall.shape} {words(wall.values)}{shear}"
