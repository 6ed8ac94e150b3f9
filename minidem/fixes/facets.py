"""Forces on meshes and wear of their triangles: from the fixes to the kernels and back."""

from __future__ import annotations

import numpy as np

from minidem.fixes.mesh import MeshSurface
from minidem.kernels.columns import FORCE, LOAD, TOTAL_FORCE, WORN
from minidem.kernels.models import FINNIE
from minidem.world.mesh.facets import Facets
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["facet_rows", "load_table", "store_loads", "wear_coefficients"]


def facet_rows(world: World) -> dict[str, int]:
    """Return the row of ``Walls.load`` that triangle 0 would have, for meshes with facets.

    Triangle t of such a mesh has the t-th row from there.
    """
    rows: dict[str, int] = {}
    used = len(world.meshes.names)
    for name, facets in _with_facets(world):
        first, _ = world.meshes.span(name)
        rows[name] = used - first
        used += len(facets.worn)
    return rows


def load_table(world: World) -> Floats:
    """Return ``Walls.load`` at the start of a run: no forces, and the wear so far."""
    worn = [facets.worn for _, facets in _with_facets(world)]
    meshes = len(world.meshes.names)
    table = np.zeros((meshes + sum(map(len, worn)), FORCE))
    if worn:
        table[meshes:, WORN] = np.concatenate(worn)
    return table


def store_loads(world: World, *, setup: bool = False) -> None:
    """Keep the loads that the kernels have found in the fixes.

    As in LIGGGHTS those of the setup of a run come on top of those of the last step, and are not
    looked at before the first step.
    """
    load = world.lists.walls.load
    for i, name in enumerate(world.meshes.names):
        fix = world.fixes[name]
        if isinstance(fix, MeshSurface) and fix.stress and (fix.loaded or not setup):
            fix.load = load[i, LOAD] + (fix.load if setup else 0.0)
            fix.loaded = True
    if setup:
        return
    used = len(world.meshes.names)
    for _, facets in _with_facets(world):
        rows = load[used : used + len(facets.worn)]
        facets.force = rows[:, TOTAL_FORCE].copy()
        facets.worn = rows[:, WORN].copy()
        used += len(rows)


def wear_coefficients(world: World, table: Floats) -> None:
    """Fill in the wear coefficients for the types of meshes that wear.

    Raises
    ------
    InputError
        If ``k_finnie`` is missing.
    """
    for fix in world.of_kind(MeshSurface):
        if fix.wears:
            values = world.materials.per_pair("k_finnie", world.types, "meshmodule/stress")
            kind = fix.kind - 1
            table[kind :: world.types, FINNIE] = values[kind]


def _with_facets(world: World) -> list[tuple[str, Facets]]:
    """Return the meshes with values per triangle in the order of the mesh store."""
    found = []
    for name in world.meshes.names:
        fix = world.fixes[name]
        if isinstance(fix, MeshSurface) and fix.facets is not None:
            found.append((name, fix.facets))
    return found
