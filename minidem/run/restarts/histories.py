"""Contacts of a restart file of LIGGGHTS become the lists with which the first run begins."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from minidem.contact.history import BRIDGE, history_slots, yielding_columns
from minidem.errors import InputError
from minidem.fixes.wall import mesh_walls, primitive_walls
from minidem.kernels.columns import NORMAL, REMEMBERED
from minidem.kernels.models import THORNTON_NING
from minidem.kernels.tables import Pairs
from minidem.run.restarts.liggghts_state import LiggghtsState
from minidem.world.state import Bools, Floats, Ints
from minidem.world.world import World

__all__ = ["restore_contacts"]

_WIDEST = 100  # numbers that a contact may remember
_PAIRS = "contacthistory"
_MESH = "tracker_"
_PRIMITIVE = "history_"

Contacts = tuple[Ints, Ints, Floats]
"""Rows of particles; what they touch; histories with all columns."""


def restore_contacts(world: World, saved: LiggghtsState, width: int) -> None:
    """Make lists of the contacts there were, for the particles and walls there are.

    Parameters
    ----------
    world : World
        At the start of a run; its lists are empty.
    saved : LiggghtsState
        The restart file.
    width : int
        Numbers of a history in the list of pairs.

    Raises
    ------
    InputError
        If the file has histories of another contact model.
    """
    count = world.state.n
    _set_pairs(world, _pairs(world, saved), width)
    found = [*_primitives(world, saved), *_meshes(world, saved)]
    none = np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros((0, REMEMBERED))
    rows = np.concatenate([none[0], *(one[0] for one in found)])
    codes = np.concatenate([none[1], *(one[1] for one in found)])
    hist = np.concatenate([none[2], *(one[2] for one in found)])
    order = np.argsort(rows, kind="stable")
    lists = world.lists
    lists.all_walls[lists.turned] = lists.walls._replace(
        start=_starts(rows, count, world.state.cap),
        code=codes[order].astype(np.int32),
        touch=np.ones(len(order), np.uint8),
        hist=np.ascontiguousarray(hist[order]),
        free=np.zeros(len(order)),
    )
    lists.before = count


def _pairs(world: World, saved: LiggghtsState) -> Contacts:
    """Return the contacts of particles: rows of the owner, rows of the other, histories.

    Both particles of a contact keep it; it belongs to the one that comes first in the file.
    """
    if world.pair.switches is None or _PAIRS not in saved.kept:
        return np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros((0, REMEMBERED))
    owner, partner, values = _partners(saved, _PAIRS)
    hist, there = _columns("the pair style", world.pair.switches, values)
    order = np.argsort(saved.ids)
    at = np.minimum(np.searchsorted(saved.ids[order], partner), len(order) - 1)
    first = (saved.ids[order][at] == partner) & (owner < order[at]) if len(order) else owner < 0
    mine, other = _rows(world, saved.ids[owner]), _rows(world, partner)
    first &= there & (mine >= 0) & (other >= 0)
    return mine[first], other[first], hist[first]


def _set_pairs(world: World, contacts: Contacts, width: int) -> None:
    """Put contacts of particles into the list."""
    owner, other, hist = contacts
    order, state, lists = np.argsort(owner, kind="stable"), world.state, world.lists
    owner = owner[order].astype(np.uint32)
    lists.all_pairs[lists.turned] = Pairs(
        start=_starts(owner, state.n, state.cap),
        owner=owner,
        other=other[order].astype(np.uint32),
        touch=np.ones(len(order), np.uint8),
        hist=np.ascontiguousarray(hist[order, :width]),
        soon=np.zeros_like(owner),
        found=np.zeros(state.cap + 2, np.int64),
    )


def _primitives(world: World, saved: LiggghtsState) -> list[Contacts]:
    """Return the contacts with primitive walls, whose histories are zero without a contact."""
    found = []
    for number, wall in enumerate(primitive_walls(world)):
        name = _PRIMITIVE + wall.name
        if name not in saved.kept or not len(saved.ids):
            continue
        values = saved.of_atoms(name, int(saved.kept[name].size[0]) - 1)
        hist, there = _columns(f"wall {wall.name}", wall.switches, values)
        rows = _rows(world, saved.ids)
        touching = there & (rows >= 0) & (values != 0.0).any(axis=1)
        code = np.full(int(touching.sum()), -1 - number)
        found.append((rows[touching], code, hist[touching]))
    return found


def _meshes(world: World, saved: LiggghtsState) -> list[Contacts]:
    """Return the contacts with triangles."""
    found = []
    for wall in mesh_walls(world):
        for mesh in wall.meshes:
            if _MESH + mesh not in saved.kept:
                continue
            owner, triangle, values = _partners(saved, _MESH + mesh)
            hist, there = _columns(f"mesh {mesh}", wall.switches, values)
            lo, hi = world.meshes.span(mesh)
            rows = _rows(world, saved.ids[owner])
            known = there & (rows >= 0) & (triangle >= 0) & (triangle < hi - lo)
            found.append((rows[known], lo + triangle[known], hist[known]))
    return found


def _partners(saved: LiggghtsState, fix: str) -> Contacts:
    """Return place in the file, partner and history of all contacts that a fix keeps."""
    kept, block, bits = saved.kept[fix], saved.block, saved.block.view(np.int64)
    wrote = saved.fixes[fix][1].tolist() if fix in saved.fixes else []
    width = int(wrote[0]) if wrote and 0 <= wrote[0] <= _WIDEST else -1
    counts = bits[np.minimum(kept.start + 1, len(bits) - 1)]
    if width < 0 or (kept.size != 2 + counts * (width + 1)).any():
        msg = f"restart file of LIGGGHTS is damaged: contacts of fix {fix} make no sense"
        raise InputError(msg)
    owner = np.repeat(np.arange(len(counts)), counts)
    number = np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)
    at = kept.start[owner] + 2 + number * (width + 1)
    values: Floats = block[at[:, None] + 1 + np.arange(width)]
    return owner, bits[at], values


def _columns(what: str, switches: Sequence[int], values: Floats) -> tuple[Floats, Bools]:
    """Return histories with the columns of minidem, and which of them are of contacts or bridges.

    LIGGGHTS keeps neighbours without a bridge, too, with models that have bridges.
    """
    found, there = np.zeros((len(values), REMEMBERED)), np.ones(len(values), np.bool_)
    slots = history_slots(switches)
    if len(slots) != values.shape[1]:
        msg = (
            f"{what}: the restart file was written with another contact model, whose contacts "
            f"remember {values.shape[1]} numbers, not {len(slots)}; give the model as it was"
        )
        raise InputError(msg)
    if switches[NORMAL] == THORNTON_NING:
        found = yielding_columns(values)
    for slot, column in enumerate(slots):
        if column >= 0:
            found[:, column] = values[:, slot]
        elif column == BRIDGE:
            there = values[:, slot] == 1.0
    return found, there


def _rows(world: World, ids: Ints) -> Ints:
    """Return the rows of particles, -1 of those that are no more there."""
    now = world.state.ids[: world.state.n]
    if not len(now):
        return np.full(len(ids), -1)
    order = np.argsort(now)
    at = np.minimum(np.searchsorted(now[order], ids), len(order) - 1)
    return np.where(now[order][at] == ids, order[at], -1)


def _starts(owner: Ints, count: int, cap: int) -> Ints:
    """Return where the entries of each particle begin."""
    start = np.zeros(cap + 2, np.int64)
    start[1 : count + 1] = np.cumsum(np.bincount(owner.astype(np.int64), minlength=count))
    start[count + 1 :] = start[count]
    return start
