"""All families of random cases: what they are compared by, and the long campaign."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from tests.twins.references import flows, insertions, meshes, regions, walls
from tests.twins.references.batch import Batch, Tables

TOLERANCE = 1e-10
"""Of the largest number of a quantity, over all cases of a script. Coordinates round at 1e-17 m,
which is 1e-12 of an overlap of 1e-5 m and of its force; some hundred steps let that grow tenfold.
Positions of insertion, groups and passages are equal to the last bit."""
STEP, ID = 0, 1  # columns
PRINTED = 1e-3  # counters print four digits


@dataclass(frozen=True)
class Family:
    """A kind of random cases.

    Attributes
    ----------
    make : callable
        Seed to batch.
    columns : tuple of slice
        Quantities of a dump that are measured on one scale each, after step and id.
    seeds : int
        How many batches a test compares.
    """

    make: Callable[[int], Batch]
    columns: tuple[slice, ...]
    seeds: int


VECTORS = tuple(slice(k, k + 3) for k in (2, 5, 8, 11))
FAMILIES = {
    "meshes": Family(meshes.batch, VECTORS, 8),
    "walls": Family(walls.batch, VECTORS, 2),
    "regions": Family(regions.batch, (slice(2, 3),), 2),
    "flows": Family(flows.batch, VECTORS[:2], 2),
    "insertions": Family(insertions.batch, (*VECTORS[:2], slice(8, 9), slice(9, 10)), 6),
}


def apart(family: Family, found: Tables, wanted: Tables) -> dict[str, float]:
    """Return what differs by more than the tolerance, as a fraction of its largest number."""
    worst: dict[str, float] = {}
    for name, table in wanted.items():
        other = found[name]
        if table.shape != other.shape:
            worst[f"{name}: {other.shape[0]} rows, expected {table.shape[0]}"] = np.inf
            continue
        if not name.endswith(".dump"):
            if table.size and not np.allclose(other, table, rtol=PRINTED, atol=1e-9):
                worst[name] = np.inf
            continue
        if table.size and (table[:, : ID + 1] != other[:, : ID + 1]).any():
            worst[f"{name}: other particles"] = np.inf
            continue
        for part in family.columns:
            worst |= _quantity(f"{name} columns {part.start} to {part.stop}", other, table, part)
    return worst


def _quantity(name: str, found: np.ndarray, wanted: np.ndarray, part: slice) -> dict[str, float]:
    a, b = found[:, part], wanted[:, part]
    scale = float(np.abs(b).max(initial=0.0))
    differ = np.abs(a - b).max(axis=1, initial=0.0)
    bad = np.flatnonzero(~(differ <= TOLERANCE * scale))
    if not len(bad):
        return {}
    row = wanted[bad[0]]
    place = (
        f"{name}, first at step {row[STEP]:.0f} id {row[ID]:.0f}, {len(set(wanted[bad, ID]))} ids"
    )
    return {place: float(np.nanmax(differ)) / scale if scale else np.inf}
