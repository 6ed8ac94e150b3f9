"""Translation of a region and its parts to the table that the kernels read."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError
from minidem.insertion.region.tets import NO_TETS, Tets, tet_table
from minidem.kernels.insertion.regions import RegionTable
from minidem.kernels.insertion.shape_columns import SHAPE
from minidem.kernels.insertion.shapes import UNION
from minidem.record import record

__all__ = ["Part", "build_table"]

MAX_ROWS = 2000


@record(frozen=True)
class Part:
    """A shape, or a union or intersection of parts.

    Attributes
    ----------
    kind : int
        See `minidem.kernels.insertion.shapes`.
    interior : bool
        True for side in.
    shape : tuple of float
        Numbers of a primitive, see `minidem.kernels.insertion.shape_columns`.
    parts : tuple of Part
        What a union or intersection is made of.
    tets : Tets
        Tetrahedra of a mesh.
    """

    kind: int
    interior: bool
    shape: tuple[float, ...] = ()
    parts: tuple[Part, ...] = ()
    tets: Tets = NO_TETS


@record(frozen=True)
class _Leaf:
    row: int
    outer: bool
    conditions: tuple[tuple[int, bool], ...]


class _Builder:
    """Numbers the parts from the leaves up."""

    def __init__(self) -> None:
        self.rows: list[Part] = []
        self.children: list[list[int]] = []

    def add(self, part: Part) -> int:
        children = [self.add(child) for child in part.parts]
        if len(self.rows) >= MAX_ROWS:
            msg = f"region has more than {MAX_ROWS} parts"
            raise InputError(msg)
        self.rows.append(part)
        self.children.append(children)
        return len(self.rows) - 1

    def leaves(
        self, row: int, outer: bool, conditions: tuple[tuple[int, bool], ...]
    ) -> list[_Leaf]:
        """List the primitive surfaces that make up the inner or outer surface of a row."""
        part = self.rows[row]
        if part.kind < UNION:
            return [_Leaf(row, outer, conditions)]
        found: list[_Leaf] = []
        for child in self.children[row]:
            # A surface point of one part counts if no other part of a union covers it, or if
            # all other parts of an intersection hold it. Seen from outside all sides flip.
            wanted = part.kind != UNION
            more = tuple((other, wanted) for other in self.children[row] if other != child)
            flipped = self.rows[child].interior == outer
            found += self.leaves(child, flipped, conditions + more)
        return found


def build_table(part: Part) -> RegionTable:
    """Return a part and all it is made of as arrays, itself last."""
    builder = _Builder()
    root = builder.add(part)
    inner = builder.leaves(root, False, ())
    leaves = inner + builder.leaves(root, True, ())
    shape = np.zeros((len(builder.rows), SHAPE))
    for k, row in enumerate(builder.rows):
        shape[k, : len(row.shape)] = row.shape
    conditions = [condition for leaf in leaves for condition in leaf.conditions]
    return RegionTable(
        kind=_integers(row.kind for row in builder.rows),
        interior=_integers(row.interior for row in builder.rows),
        shape=shape,
        child_start=_starts(len(children) for children in builder.children),
        child=_integers(child for children in builder.children for child in children),
        leaf_start=_integers((0, len(inner), len(leaves))),
        leaf=_integers(leaf.row for leaf in leaves),
        leaf_outer=_integers(leaf.outer for leaf in leaves),
        condition_start=_starts(len(leaf.conditions) for leaf in leaves),
        condition=_integers(row for row, _ in conditions),
        wanted=_integers(value for _, value in conditions),
        found=np.zeros(len(builder.rows), dtype=np.bool_),
        tets=tet_table([row.tets for row in builder.rows]),
    )


def _integers(values: Iterable[int]) -> NDArray[np.int64]:
    return np.array([int(value) for value in values], dtype=np.int64)


def _starts(counts: Iterable[int]) -> NDArray[np.int64]:
    return np.concatenate([[0], np.cumsum(_integers(counts))]).astype(np.int64)
