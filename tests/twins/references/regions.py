"""Which points are in a region: all styles, both sides, parts of parts, points on faces."""

from __future__ import annotations

import numpy as np

from tests.twins.references.batch import Batch
from tests.twins.references.places import GRID, HALF, atoms, dump, header, place, words

REGIONS = 24  # of a script; LIGGGHTS has 32 groups
POINTS = 400
RADIUS = 0.0001  # m


def primitive(rng: np.random.Generator) -> str:
    """Return style and numbers of a block, sphere or cylinder."""
    style = str(rng.choice(["block", "sphere", "cylinder"]))
    if style == "block":
        ends = [sorted((place(rng), place(rng))) for _ in range(3)]
        return f"block {words(np.ravel(ends))} units box"
    if style == "sphere":
        return f"sphere {words([place(rng) for _ in range(3)])} {_radius(rng)!r} units box"
    low, high = sorted((place(rng), place(rng)))
    axis = rng.choice(list("xyz"))
    across = words((place(rng), place(rng)))
    return f"cylinder {axis} {across} {_radius(rng)!r} {words((low, high))} units box"


def _radius(rng: np.random.Generator) -> float:
    return max(abs(place(rng)), GRID)


def region_lines(rng: np.random.Generator, count: int) -> list[str]:
    """Return lines that define regions r0, r1, ...; the later ones made of earlier ones."""
    lines = []
    for k in range(count):
        if k > 4 and rng.uniform() < 0.4:
            parts = rng.choice(k, size=int(rng.integers(2, 5)), replace=False)
            text = f"{rng.choice(['union', 'intersect'])} {len(parts)} "
            text += " ".join(f"r{part}" for part in parts)
        else:
            text = primitive(rng)
        lines.append(f"region r{k} {text} side {rng.choice(['in', 'out'])}")
    return lines


def batch(seed: int) -> Batch:
    """Return 24 regions and 400 points of a seed; a group of each region is dumped."""
    rng = np.random.default_rng([31, seed])
    points = np.array([[place(rng, -0.99, 0.99) for _ in range(3)] for _ in range(POINTS)])
    points = points[(np.abs(points) < HALF).all(axis=1)]
    still = np.zeros_like(points)
    lines = [*header(), *region_lines(rng, REGIONS)]
    lines += atoms(points, np.full(len(points), RADIUS), still)
    for k in range(REGIONS):
        lines += [f"group g{k} region r{k}", *dump(f"g{k}", 1, "id x", f"g{k}")]
    lines += ["fix free all nve/sphere", "run 0", ""]
    outputs = tuple(f"g{k}.dump" for k in range(REGIONS))
    return Batch(f"regions-{seed}", "\n".join(lines), outputs, REGIONS)
