"""Insertion beside grains many times as large, which LIGGGHTS overlooks from some distance on.

The large ones touch nothing, so that new ones may lie in them.
"""

from __future__ import annotations

import numpy as np

from tests.twins.references.batch import Batch
from tests.twins.references.insertions import CELL, LARGE, Cell, batch_of
from tests.twins.references.places import atoms

EACH = 2  # large grains in a cell


def large_grains(rng: np.random.Generator, cells: list[Cell]) -> list[str]:
    """Return the lines that put grains of up to eight radii of the largest new one into cells."""
    centres = np.repeat([cell.centre for cell in cells], EACH, axis=0)
    centres += rng.uniform(-0.8, 0.8, centres.shape) * CELL
    radii = LARGE * rng.uniform(1.0, 8.0, len(centres))
    made = atoms(centres, radii, np.zeros_like(centres))
    return [*made, "group large type 1", "neigh_modify exclude group large all"]


def batch(seed: int) -> Batch:
    """Return six insertion commands of a seed, each beside large grains."""
    return batch_of(f"boulders-{seed}", np.random.default_rng([45, seed]), large_grains)
