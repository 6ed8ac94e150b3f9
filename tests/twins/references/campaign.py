"""All families of random cases: how they are compared, stored, and run in large numbers.

``python -m tests.twins.references.campaign FAMILY FIRST LAST`` compares both engines on the batches
of these seeds and prints what differs; ``[FAMILY] --write`` makes the stored references anew with
LIGGGHTS.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from minidem.errors import DemError
from tests.paths import DATA
from tests.twins.references import (
    boulders,
    flows,
    forces,
    insertions,
    meshes,
    regions,
    sharing,
    walls,
)
from tests.twins.references.batch import Batch, Tables, run

TOLERANCE = 1e-10
"""Of the largest number of a quantity, over all cases of a script. Coordinates round at 1e-17 m,
which is 1e-12 of an overlap of 1e-5 m and of its force; some hundred steps let that grow tenfold.
Positions of insertion, groups and passages are equal to the last bit."""
STEP, ID = 0, 1  # columns
PRINTED = 1.1e-3  # counters print four digits; the last one may round either way


@dataclass(frozen=True)
class Family:
    """A kind of random cases.

    Attributes
    ----------
    make : callable
        Seed to batch.
    columns : tuple of slice
        Quantities of a dump that are measured on one scale each, after step and id.
    seeds : tuple of int
        The batches that tests compare, with stored references.
    """

    make: Callable[[int], Batch]
    columns: tuple[slice, ...]
    seeds: tuple[int, ...]


VECTORS = tuple(slice(k, k + 3) for k in (2, 5, 8, 11))
INSERTED = (*VECTORS[:2], slice(8, 9), slice(9, 10))
FAMILIES = {
    "meshes": Family(meshes.batch, VECTORS, tuple(range(8))),
    "walls": Family(walls.batch, VECTORS, (0, 1)),
    "regions": Family(regions.batch, (slice(2, 3),), (0, 1)),
    "flows": Family(flows.batch, VECTORS[:2], (0, 1, 112)),
    "insertions": Family(insertions.batch, INSERTED, (10, 11, 13, 14, 15, 16, 19)),
    "boulders": Family(boulders.batch, INSERTED, (2, 5)),
    "sharing": Family(sharing.batch, INSERTED, (0, 1)),
    "forces": Family(forces.batch, (*VECTORS, slice(14, 17)), tuple(range(8))),
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
            # lines of one step stand in the order of LIGGGHTS' bins
            if table.size and not np.allclose(
                *(rows[np.lexsort(rows[:, 1::-1].T)] for rows in (other, table)),
                rtol=PRINTED, atol=1e-9 * max(1.0, np.abs(table).max()),
            ):  # fmt: skip
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


# -- stored references -----------------------------------------------------------------------------

FOLDER = DATA / "twins"
DIGEST = "digest"


def last_frames(tables: Tables) -> Tables:
    """Return what is stored: of each dump the rows of its last step."""
    return {
        name: table[table[:, STEP] == table[-1, STEP]]
        if name.endswith(".dump") and table.size
        else table
        for name, table in tables.items()
    }


def stored(name: str, batch: Batch) -> Tables:
    """Return the reference of a batch.

    Raises
    ------
    AssertionError
        If the inputs are not those of the reference.
    """
    with np.load(FOLDER / f"{name}.npz") as file:
        assert str(file[f"{batch.name}/{DIGEST}"]) == batch.digest(), (
            f"the inputs of {batch.name} have changed; make the references anew with "
            "python -m tests.twins.references.campaign --write"
        )
        return {output: file[f"{batch.name}/{output}"] for output in batch.outputs}


def write(names: Iterable[str]) -> None:
    """Make the stored references of some families with LIGGGHTS."""
    FOLDER.mkdir(exist_ok=True)
    for name in names:
        family = FAMILIES[name]
        arrays: dict[str, np.ndarray] = {}
        for seed in family.seeds:
            batch = family.make(seed)
            arrays[f"{batch.name}/{DIGEST}"] = np.array(batch.digest())
            for output, table in last_frames(run(batch, "liggghts")).items():
                arrays[f"{batch.name}/{output}"] = table
        np.savez_compressed(FOLDER / f"{name}.npz", **arrays)


# -- the long campaign -----------------------------------------------------------------------------


def compare(name: str, first: int, last: int) -> None:
    """Run both engines on the batches of a range of seeds and print what differs."""
    family = FAMILIES[name]
    cases = refused = differ = 0
    for seed in range(first, last):
        batch = family.make(seed)
        try:
            wanted = run(batch, "liggghts")
        except AssertionError as err:
            refused += 1
            print(f"{batch.name}: refused by LIGGGHTS: {str(err)[-200:]!r}", flush=True)
            continue
        cases += batch.cases
        try:
            worst = apart(family, run(batch, "minidem"), wanted)
        except DemError as err:
            worst = {str(err): np.inf}
        if worst:
            differ += 1
            print(f"{batch.name}: {worst}", flush=True)
    print(f"{name}: {cases} cases, {differ} batches differ, {refused} batches refused by LIGGGHTS")


def main() -> None:
    """Compare a range of seeds, or write the references."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("family", nargs="?", choices=FAMILIES)
    parser.add_argument("first", nargs="?", type=int, default=1000)
    parser.add_argument("last", nargs="?", type=int, default=1010)
    parser.add_argument("--write", action="store_true")
    given = parser.parse_args()
    names = [given.family] if given.family else list(FAMILIES)
    if given.write:
        write(names)
        return
    for name in names:
        compare(name, given.first, given.last)


if __name__ == "__main__":
    main()
