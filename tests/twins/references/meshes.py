"""Spheres on meshes: a sphere and a mesh per case, in cells far from each other.

Each row of cells is one mesh for LIGGGHTS, with its own curvature limit and motion.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from tests.twins.references.batch import Batch
from tests.twins.references.shapes import shape
from tests.twins.scene import Mesh, Model, Motion, Scene, Sphere, stl_text
from tests.twins.slow.search import distance_to_triangle
from tests.twins.slow.shapes import motion
from tests.twins.slow.triangle import unit
from tests.twins.strategies import materials

PITCH = 0.05  # m, from cell to cell
CELLS = (10, 5, 5)
CASES = int(np.prod(CELLS))
CURVATURES = (None, None, 1e-5, 1e-5, 5.0, 30.0)
WAYS = (
    "still",
    "still",
    "still",
    "belt",
    "linear",
    "wiggle",
    "rotate",
    "rotate",
    "riggle",
    "vibrot",
)
"""How the rows of cells move."""
CALM = ("still", "belt") * 5
SHIFTED = ("still", "belt", "linear", "wiggle", "still") * 2
"""In a periodic box: images of turning meshes have wrong velocities in LIGGGHTS, spin x (r + L)."""

FORMS = "%d" + " %.17g" * 12
COLUMNS = "id x y z vx vy vz fx fy fz tqx tqy tqz"
FORCE, TORQUE = slice(8, 11), slice(11, 14)  # of a row of a dump, after the step
DEEPEST = 0.8  # of a radius: no triangle is nearer to a centre at the start
MODEL = Model({"model": "hertz", "tangential": "history", "rolling_friction": "epsd2"})
"""That of our experiments, with two histories and no direction that rounding decides."""
PULLS = 6  # groups of spheres, pulled along the axes


@dataclass(frozen=True)
class Case:
    """A mesh, its sphere, and which of the pulls holds it there."""

    nodes: np.ndarray
    sphere: Sphere
    pull: int


def _target(rng: np.random.Generator, nodes: np.ndarray) -> np.ndarray:
    """Return a point of a mesh: on a face, an edge or a corner."""
    weights = rng.dirichlet([1.0] * 3)
    kind = rng.integers(4)
    if kind == 1:
        weights[rng.integers(3)] = 0.0
    elif kind == 2:
        weights = np.eye(3)[rng.integers(3)]
    return weights / weights.sum() @ nodes[rng.integers(len(nodes))]


def case(rng: np.random.Generator, centre: np.ndarray, half: np.ndarray) -> Case:
    """Return a random mesh around a point and a sphere that touches it or soon will.

    Sphere and centres of triangles lie in the box, of which `half` is given, m.
    """
    while True:
        nodes = shape(rng) + centre
        nodes = nodes[(np.abs(nodes.mean(axis=1)) < 0.999 * half).all(axis=1)]
        if not len(nodes):
            continue
        radius = float(10.0 ** rng.uniform(-3.3, -2.2))
        for _ in range(20):
            way = unit(rng.normal(size=3))
            near = radius * (1.0 + rng.choice([-rng.uniform(0.0, 0.02), rng.uniform(0.0, 0.01)]))
            x = _target(rng, nodes) + near * way
            gap = min(distance_to_triangle(triangle, x) for triangle in nodes)
            inside = (np.abs(x) < 0.99 * half).all()
            if inside and DEEPEST * radius < gap < 1.02 * radius:
                return Case(nodes, _sphere(rng, x, radius), _against(way))


def _against(way: np.ndarray) -> int:
    """Return the number of the pull that is most against a direction: -x, +x, -y and so on."""
    axis = int(np.argmax(np.abs(way)))
    return 2 * axis + int(way[axis] < 0.0)


def _sphere(rng: np.random.Generator, x: np.ndarray, radius: float) -> Sphere:
    speed = 10.0 ** rng.uniform(-2.0, 0.3)
    v = rng.normal(size=3) * speed
    w = rng.normal(size=3) * speed / radius * rng.choice([0.0, 1.0])
    vectors = (tuple(map(float, vector)) for vector in (x, v, w))
    return Sphere(*vectors, radius, float(rng.uniform(1000.0, 3000.0)), 1)


def _row(rng: np.random.Generator, way: str, cases: list[Case], middle: np.ndarray) -> Mesh:
    """Return the meshes of a row of cells as one."""
    nodes = np.concatenate([case.nodes for case in cases])
    moves = None
    if way not in ("still", "belt"):
        moves = motion(rng, way)
        if "origin" in moves.numbers:
            origin = {"origin": tuple(map(float, middle + rng.normal(size=3) * 0.01))}
            moves = Motion(way, {**moves.numbers, **origin})
    curvature = CURVATURES[rng.integers(len(CURVATURES))]
    belt = tuple(map(float, rng.uniform(-1.0, 1.0, 3))) if way == "belt" else None
    return Mesh(tuple(map(tuple, nodes.tolist())), 2, curvature, belt, moves)


def batch(seed: int, steps: int = 150, frames: int = 3) -> Batch:
    """Return 250 cases of a seed.

    In every fourth batch the faces of the box go through meshes, in every fourth they are periodic.
    """
    rng = np.random.default_rng([20191111, seed])
    closed, periodic = seed % 4 == 1, seed % 4 == 3
    grid = (np.indices(CELLS).reshape(3, -1).T - (np.array(CELLS) - 1) / 2.0) * PITCH
    half = 0.5 * PITCH * (np.array(CELLS) - 1.0 if closed or periodic else np.array(CELLS) + 2.0)
    centres = grid + rng.uniform(-0.3, 0.3, grid.shape) * PITCH
    cases = [case(rng, np.clip(centre, -half, half), half) for centre in centres]
    each = CASES // len(WAYS)
    rows = [
        _row(
            rng, way, cases[k * each : (k + 1) * each], grid[k * each : (k + 1) * each].mean(axis=0)
        )
        for k, way in enumerate(CALM if closed else SHIFTED if periodic else WAYS)
    ]
    scene = Scene(
        MODEL, materials(rng), tuple(case.sphere for case in cases), MODEL, meshes=tuple(rows),
        size=tuple(map(float, half)), skin=float(10.0 ** rng.uniform(-3.5, -2.0)),
        moves_first=bool(rng.integers(2)), periodic=(periodic,) * 3,
        factor=float(rng.choice([1.0, 1.0, 1.1])),
    )  # fmt: skip
    every = steps // frames
    lines = [
        *_pulls(cases, float(10.0 ** rng.uniform(1.0, 2.7))),
        *_dump("first", 1), "run 1", "undump first", *_dump("later", every), f"run {steps - 1}",
    ]  # fmt: skip
    script = replace(scene, runs=()).script(tuple(lines)).replace("lost error", "lost ignore")
    files = {f"mesh{k}.stl": stl_text(row) for k, row in enumerate(rows)}
    return Batch(f"meshes-{seed}", script, ("first.dump", "later.dump"), CASES, files)


def _pulls(cases: list[Case], strength: float) -> list[str]:
    lines = []
    for k in range(PULLS):
        ids = " ".join(str(i) for i, case in enumerate(cases, start=1) if case.pull == k)
        if not ids:
            continue
        way = ["0", "0", "0"]
        way[k // 2] = "1" if k % 2 else "-1"
        lines += [
            f"group pull{k} id {ids}",
            f"fix pull{k} pull{k} gravity {strength!r} vector {' '.join(way)}",
        ]
    return lines


def _dump(name: str, every: int) -> list[str]:
    return [
        f"dump {name} all custom {every} {name}.dump {COLUMNS}",
        f'dump_modify {name} sort id first yes format "{FORMS}"',
    ]
