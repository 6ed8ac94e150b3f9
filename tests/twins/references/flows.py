"""Counting planes: points that pass faces, edges and corners of a mesh, from both sides."""

from __future__ import annotations

import numpy as np

from tests.twins.references.batch import Batch
from tests.twins.references.places import HALF, atoms, dump, header, words
from tests.twins.references.shapes import SIZE, fan, plate
from tests.twins.scene import Mesh, stl_text
from tests.twins.slow.triangle import unit

PLANES = 4
EACH = 60  # particles that fly through each
STEPS = 400
DT = 1e-5  # s
APART = 0.05  # m


def batch(seed: int) -> Batch:
    """Return four counting planes of a seed and 240 particles that fly at them."""
    rng = np.random.default_rng([41, seed])
    lines, files, points, speeds = header(skin=float(rng.uniform(0.001, 0.004))), {}, [], []
    flows = []
    for k in range(PLANES):
        centre = np.array([(k % 2 - 0.5) * APART, (k // 2 - 0.5) * APART, 0.0])
        turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        shape = plate(rng) if rng.uniform() < 0.5 else fan(rng) * np.array([1.0, 1.0, 0.0])
        nodes = shape @ turn.T + centre
        files[f"f{k}.stl"] = stl_text(Mesh(tuple(map(tuple, nodes.tolist()))))
        normal = turn[:, 2]
        style = str(rng.choice(["mesh/surface", "mesh/surface/planar"]))
        lines.append(f"fix m{k} all {style} file f{k}.stl type 1")
        count = rng.choice(["once", "multiple"])
        gone = "delete_atoms yes" if count == "once" and rng.uniform() < 0.5 else ""
        flows.append(
            f"fix f{k} all massflow/mesh mesh m{k} count {count} vec_side {words(normal)} "
            f"file flow{k}.txt writeTime {gone}"
        )
        for _ in range(EACH):
            x, v = _shot(rng, nodes, normal)
            points.append(x)
            speeds.append(v)
    lines += atoms(np.array(points), rng.uniform(0.0002, 0.0006, len(points)), np.array(speeds))
    lines += [*flows, "fix free all nve/sphere", "region way block 0 1 0 1 0 1 units box"]
    lines += [*dump("out", 50, "id x y z vx vy vz"), f"run {STEPS}", ""]
    outputs = ("out.dump", *(f"flow{k}.txt" for k in range(PLANES)))
    return Batch(f"flows-{seed}", "\n".join(lines), outputs, PLANES * EACH, files)


def _shot(
    rng: np.random.Generator, nodes: np.ndarray, normal: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return a place and a velocity that leads through the mesh or past it."""
    weights = rng.dirichlet([1.0] * 3) * rng.choice([0.0, 1.0, 1.0], size=3)
    aim = (weights / max(weights.sum(), 1e-3)) @ nodes[rng.integers(len(nodes))]
    if rng.uniform() < 0.2:
        aim = aim + rng.normal(size=3) * SIZE
    v = unit(normal * rng.choice([-1.0, 1.0]) + 0.5 * rng.normal(size=3)) * rng.uniform(0.5, 4.0)
    x = aim - v * DT * rng.uniform(0.0, 1.2 * STEPS)
    return (x, v) if (np.abs(x) < 0.9 * HALF).all() else _shot(rng, nodes, normal)
