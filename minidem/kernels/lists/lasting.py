"""Lists of few particles that outlast several requests for new ones.

LIGGGHTS makes lists anew whenever a particle has gone half the skin. For few particles that takes a
quarter of all time, while to look through a longer list takes little more: so their lists hold what
is within a skin that is wider, and serve until what LIGGGHTS would list might not be in them.
What new lists mean besides happens at every request: pairs beyond reach forget, contacts with
meshes close ranks, ways count anew.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np

from minidem.kernels.columns import (  # isort: skip
    X, Y, Z, RADIUS, ROW, BOX_LOWER, BOX_MOVES, BOX_UPPER, LASTING, LIST_CHECK,
    LIST_DELAY, LIST_EVERY, MOTIONS, NEARBY, REACH, REACH2, SKIN, SPENT, WALLS_SPENT, WIDE,
)  # fmt: skip
from minidem.kernels.contact.pair_contact import apart
from minidem.kernels.contact.wall_contact import close_ranks
from minidem.kernels.lists.wall_lists import wall_flow_list
from minidem.kernels.machine.jit import inlined, inner
from minidem.kernels.machine.space import columns
from minidem.kernels.motion.frames import facet_frames
from minidem.kernels.motion.integrate import farthest
from minidem.kernels.near import MANY

__all__ = ["last", "note_places", "widen"]

MORE = 3.5
"""Skins that lists of few are wider by, but no more than the radius of the smallest particle:"""
WORTH = 1.25
"""for what is less than so many skins they would not last once, with a step beyond half a skin."""
BESIDE = 3.0
"""Times the distance at which triangles are listed: who is beside a corner may be farther."""
SURE = 1.000001
"""For rounding."""


@inlined
def widen(n: int, largest: float, control: Any, parts: Any, box: Any) -> None:
    """Choose the skin that lists of `n` particles, of radii up to `largest`, are made with now.

    Where new lists are not asked for by the way of particles in every step, LIGGGHTS may miss
    contacts that lists of its own skin do not hold; then lists are as it would make them.
    """
    whole = control.whole
    real = control.real
    real[SPENT] = 0.0
    real[WALLS_SPENT] = 0.0
    real[WIDE] = real[SKIN]
    if (
        n < MANY  # to look through longer lists of more costs too much
        and whole[LASTING] == 1
        and whole[LIST_CHECK] == 1
        and whole[LIST_DELAY] <= 1
        and whole[LIST_EVERY] == 1
        and box[BOX_MOVES] <= 0.0
    ):
        more = MORE * real[SKIN]
        for i in range(n):
            more = min(more, parts.row[i, RADIUS])
        if more >= WORTH * real[SKIN]:
            real[WIDE] += more
    real[NEARBY] = BESIDE * (real[REACH] * largest + real[WIDE])


@inner
def last(n: int, tables: Any, lists: Any) -> bool:
    """Return True if the lists in use hold all that new ones would; they begin again then.

    That takes particles in the box, as many as the lists were made for.
    """
    control = tables.control
    real = control.real
    parts = tables.parts
    room = real[WIDE] - real[SKIN]
    if not room > 0.0 or not _inside(n, parts.row, tables.more.box):
        return False
    mesh = tables.mesh
    way = real[SPENT] + SURE * sqrt(farthest(n, parts))
    walls_way = real[WALLS_SPENT]
    if control.whole[MOTIONS] > 0:
        walls_way += SURE * sqrt(_farthest_node(mesh))
    if not (2.0 * way <= room and way + walls_way <= room):
        return False
    real[SPENT] = way
    real[WALLS_SPENT] = walls_way
    if tables.more.ranges.shape[0] > 0 and wall_flow_list(tables) > tables.flows.pair.shape[0]:
        return False
    _begin(n, tables, lists)
    return True


@inlined
def _begin(n: int, tables: Any, lists: Any) -> None:
    """Let the lists in use begin again, as lists begin that are made anew."""
    pairs = lists.pairs
    _forget_apart(tables, pairs, pairs.start[n])
    walls = lists.walls
    owner = tables.mesh.owner
    for i in range(n):
        if walls.start[i] < walls.start[i + 1]:
            close_ranks(walls, owner, walls.start[i], walls.start[i + 1])
    note_places(n, tables)


@inner
def note_places(n: int, tables: Any) -> None:
    """Note where particles and meshes are now, from where their ways count."""
    parts = tables.parts
    mesh = tables.mesh
    held = columns(parts.held, 3)
    row = columns(parts.row, ROW)
    for i in range(n):
        for c in range(3):
            held[i, c] = row[i, c]
    if tables.control.whole[MOTIONS] > 0:
        for t in range(mesh.node.shape[0]):
            for k in range(3):
                for c in range(3):
                    mesh.held[t, k, c] = mesh.node[t, k, c]
        facet_frames(mesh, 0, mesh.node.shape[0])


@inlined
def _inside(n: int, row: Any, box: Any) -> bool:
    """Return True if no particle is beyond a face of the box; one that is nowhere is beyond."""
    for i in range(n):
        for c in range(3):
            if not (box[BOX_LOWER + c] <= row[i, c] < box[BOX_UPPER + c]):
                return False
    return True


@inlined
def _farthest_node(mesh: Any) -> Any:
    """Return the largest squared move of a node since positions were held."""
    far = 0.0
    for t in range(mesh.node.shape[0]):
        for k in range(3):
            dx = mesh.node[t, k, X] - mesh.held[t, k, X]
            dy = mesh.node[t, k, Y] - mesh.held[t, k, Y]
            dz = mesh.node[t, k, Z] - mesh.held[t, k, Z]
            far = max(far, dx * dx + dy * dy + dz * dz)
    return far


@inlined
def _forget_apart(tables: Any, pairs: Any, used: Any) -> None:
    """Let pairs beyond reach forget, as where lists are made anew."""
    row = columns(tables.parts.row, ROW)
    real = tables.control.real
    wide = pairs.hist.shape[1]
    for k in range(np.uint64(used)):
        if pairs.touch[k] == 0:
            continue
        i = pairs.owner[k]
        j = pairs.other[k]
        dx, dy, dz = apart(tables, i, j)
        both = row[i, RADIUS] + row[j, RADIUS]
        if not dx * dx + dy * dy + dz * dz < real[REACH2] * both * both:
            pairs.touch[k] = 0
            for c in range(wide):
                pairs.hist[k, c] = 0.0
