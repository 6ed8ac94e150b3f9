"""Insertion beside grains many times as large, which LIGGGHTS overlooks from some distance on.

The large ones touch nothing, so that new ones may lie in them.
"""

from __future__ import annotations

import numpy as np

from tests.twins.references.batch import Batch
from tests.twins.references.insertions import CELL, CELLS, LARGE, STEPS, Cell, primes
from tests.twins.references.places import HALF, atoms, dump, header

EACH = 2  # large grains in a cell


def batch(seed: int) -> Batch:
    """Return six insertion commands of a seed, each beside large grains."""
    rng = np.random.default_rng([45, seed])
    numbers = primes(200)
    cells = [Cell(rng, k, numbers) for k in range(CELLS)]
    boundary = str(rng.choice(["f f f", "p p p", "p f p"]))
    lines = header(boundary, HALF, 0.001)
    centres = np.repeat([cell.centre for cell in cells], EACH, axis=0)
    centres += rng.uniform(-0.8, 0.8, centres.shape) * CELL
    radii = LARGE * rng.uniform(1.0, 8.0, len(centres))
    lines += atoms(centres, radii, np.zeros_like(centres))
    lines += ["group large type 1", "neigh_modify exclude group large all"]
    files: dict[str, str] = {}
    for cell in cells:
        lines += cell.make()
        files |= cell.files
    lines += ["fix free all nve/sphere", *dump("out", 20, "id x y z vx vy vz radius mass")]
    lines += [f"run {STEPS}", ""]
    return Batch(f"boulders-{seed}", "\n".join(lines), ("out.dump",), CELLS, files)
