"""Which walls and flow meshes each particle may reach before the next rebuild."""

from __future__ import annotations

from typing import Any

from minidem.kernels.columns import (  # isort: skip
    X, Y, Z, ONLY, RADIUS, CELL_CORNER, CELL_SIZE, CELL_COUNT, CELL_LARGEST, RANGE_FIRST,
    RANGE_END, RANGE_MOVES, WALL_SHAPE, WALL_AXIS, PLANE, MESH_GROUP, WALL_PLACE, WALL_CENTRE,
    WALL_CENTRE_NEXT, A, B, C, NEAR_FLOW, NEAR_TRIANGLE, NEAR_PARTICLE, SKIN, REACH, REMEMBERED,
    SPENT, WIDE,
)  # fmt: skip
from minidem.kernels.contact.triangle import near
from minidem.kernels.contact.wall_contact import close_ranks
from minidem.kernels.lists.cells import cell_of
from minidem.kernels.machine.jit import inlined, inner
from minidem.kernels.machine.space import columns

__all__ = ["all_may_touch", "wall_flow_list", "wall_list"]

NOTED_WALL, NOTED_PARTICLE = 0, 1  # columns of what a contact remembers, until it does


@inlined
def _span(cells: Any, mesh: Any, t: int, c: int, reach: float) -> Any:
    """Return the range of cells along direction c that triangle t reaches."""
    lo = min(mesh.node[t, A, c], min(mesh.node[t, B, c], mesh.node[t, C, c])) - reach
    hi = max(mesh.node[t, A, c], max(mesh.node[t, B, c], mesh.node[t, C, c])) + reach
    if (
        hi < cells[CELL_CORNER + c]
        or lo > cells[CELL_CORNER + c] + cells[CELL_SIZE + c] * cells[CELL_COUNT + c]
    ):
        return 1, 0
    return cell_of(cells, c, lo), cell_of(cells, c, hi)


@inlined
def _primitive_near(walls: Any, w: int, row: Any, i: int, reach: float) -> Any:
    """Return True if particle i may touch primitive wall w before the next rebuild."""
    axis = walls.prim[w, WALL_AXIS]
    if walls.prim[w, WALL_SHAPE] == PLANE:
        gap = abs(row[i, axis] - walls.value[w, WALL_PLACE])
    else:
        across = (axis + 1) % 3
        beside = (axis + 2) % 3
        u = row[i, across] - walls.value[w, WALL_CENTRE]
        v = row[i, beside] - walls.value[w, WALL_CENTRE_NEXT]
        gap = abs((u * u + v * v) ** 0.5 - walls.value[w, WALL_PLACE])
    return gap <= row[i, RADIUS] + reach


@inlined
def _recall(i: int, old: Any, before: int, mesh: Any, walls: Any, fresh: Any) -> None:
    """Fill in what the entries of particle `i` remember; it was the one of index `old`."""
    start = fresh.start
    hist = columns(fresh.hist, REMEMBERED)
    known = columns(walls.hist, REMEMBERED)
    for k in range(start[i], start[i + 1]):
        fresh.touch[k] = 0
        fresh.free[k] = 0.0
        for c in range(REMEMBERED):
            hist[k, c] = 0.0
        if old < before:
            for q in range(walls.start[old], walls.start[old + 1]):
                # a particle that was wrapped meets the image of the triangle it touched
                same = walls.code[q] == fresh.code[k] or (
                    fresh.touch[k] == 0
                    and walls.code[q] >= 0
                    and fresh.code[k] >= 0
                    and mesh.base[walls.code[q]] == mesh.base[fresh.code[k]]
                )
                if same:
                    fresh.touch[k] = walls.touch[q]
                    for c in range(REMEMBERED):
                        hist[k, c] = known[q, c]
    if start[i] < start[i + 1]:
        close_ranks(fresh, mesh.owner, start[i], start[i + 1])


@inlined
def all_may_touch(n: Any, walls: Any) -> None:
    """Forget how far particles are from walls: Python may have moved both."""
    for k in range(walls.start[n]):
        walls.free[k] = 0.0


@inner
def wall_list(n: int, before: int, tables: Any, walls: Any, fresh: Any) -> Any:
    """Make the list of walls that each particle may touch before the next rebuild.

    Triangles of meshes without a wall are skipped.

    Parameters
    ----------
    n, before, tables
        As for `minidem.kernels.lists.neighbor.pair_list`.
    walls, fresh : Walls
        Old list, and the one to fill (they share the tables).

    Returns
    -------
    int
        Entries needed; if more than `fresh` holds, the list is incomplete.
    """
    row = tables.parts.row
    mask = tables.parts.mask
    mesh = tables.mesh
    cells = tables.more.cells
    first = tables.more.first
    order = tables.more.order
    skin = tables.control.real[WIDE]
    factor = tables.control.real[REACH]
    prims = walls.prim.shape[0]
    room = fresh.code.shape[0]
    start = fresh.start
    for i in range(n + 2):
        start[i] = 0
    # what is found is noted in working space, then put in order: triangles by their numbers
    noted = fresh.hist
    found = 0
    for i in range(n):
        for w in range(prims):
            if _primitive_near(walls, w, row, i, skin):
                if found < room:
                    noted[found, NOTED_WALL] = -1 - w
                    noted[found, NOTED_PARTICLE] = i
                start[i + 2] += 1
                found += 1
    for t in range(mesh.node.shape[0]):
        group = walls.mesh[mesh.owner[t], MESH_GROUP]
        if group == 0:
            continue
        reach = cells[CELL_LARGEST] * factor + skin
        x0, x1 = _span(cells, mesh, t, X, reach)
        y0, y1 = _span(cells, mesh, t, Y, reach)
        z0, z1 = _span(cells, mesh, t, Z, reach)
        for cz in range(z0, z1 + 1):
            for cy in range(y0, y1 + 1):
                base = (cz * int(cells[CELL_COUNT + Y]) + cy) * int(cells[CELL_COUNT + X])
                if x1 < x0:
                    continue
                for i in range(first[base + x0], first[base + x1 + 1]):
                    far = row[i, RADIUS] * factor + skin
                    if mask[i] & group == 0:
                        continue
                    if near(mesh, t, row[i, X], row[i, Y], row[i, Z], far):
                        if found < room:
                            noted[found, NOTED_WALL] = t
                            noted[found, NOTED_PARTICLE] = i
                        start[i + 2] += 1
                        found += 1
    if found > room:
        return found
    for i in range(n):
        start[i + 2] += start[i + 1]
    for k in range(found):
        i = int(noted[k, NOTED_PARTICLE])
        fresh.code[start[i + 1]] = int(noted[k, NOTED_WALL])
        start[i + 1] += 1
    for i in range(n):
        _recall(i, order[i], before, mesh, walls, fresh)
    return found


@inner
def wall_flow_list(tables: Any) -> Any:
    """List the particles near flow meshes; return the entries needed.

    Meshes at rest look half as far as moving ones, as in LIGGGHTS.
    """
    row = tables.parts.row
    mesh = tables.mesh
    flows = tables.flows
    cells = tables.more.cells
    first = tables.more.first
    ranges = tables.more.ranges
    skin = tables.control.real[SKIN]
    p = 0
    for f in range(ranges.shape[0]):
        far = skin if ranges[f, RANGE_MOVES] == 1 else 0.5 * skin
        for t in range(ranges[f, RANGE_FIRST], ranges[f, RANGE_END]):
            # cells are as they were when lists were made
            reach = cells[CELL_LARGEST] + far + tables.control.real[SPENT]
            x0, x1 = _span(cells, mesh, t, X, reach)
            y0, y1 = _span(cells, mesh, t, Y, reach)
            z0, z1 = _span(cells, mesh, t, Z, reach)
            if x1 < x0:
                continue
            for cz in range(z0, z1 + 1):
                for cy in range(y0, y1 + 1):
                    base = (cz * int(cells[CELL_COUNT + Y]) + cy) * int(cells[CELL_COUNT + X])
                    for i in range(first[base + x0], first[base + x1 + 1]):
                        if near(mesh, t, row[i, X], row[i, Y], row[i, Z], row[i, RADIUS] + far):
                            if p < flows.pair.shape[0]:
                                flows.pair[p, NEAR_FLOW] = f
                                flows.pair[p, NEAR_TRIANGLE] = t
                                flows.pair[p, NEAR_PARTICLE] = i
                            p += 1
    flows.count[ONLY] = min(p, flows.pair.shape[0])
    return p
