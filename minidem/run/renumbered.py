"""What contacts remember once particles have got another order or other ids, as in LIGGGHTS.

Before it makes new lists LIGGGHTS notes with each particle the ids of those that it touches, and
what the contact remembers, of two particles with the second one with other signs, which is meant
for vectors. Then it asks the one of both that comes first by now. With ``edinburgh`` all numbers
get other signs so: overlaps below zero make a contact that has changed its order begin anew, until
it changes it again.

`delete_atoms` gives new ids in between, so that these are looked for under the old ones: most
contacts begin anew, and a few take over what another one remembers.
"""

from __future__ import annotations

import numpy as np

from minidem.kernels.columns import ADHESION, IMPACT, LARGEST, NORMAL, POSITION
from minidem.kernels.models import EDINBURGH, EDINBURGH_STIFFNESS
from minidem.world.fix import Fix, all_fixes
from minidem.world.lists import Noted
from minidem.world.state import Bools, Ints
from minidem.world.world import World

__all__ = ["compress_ids", "insert", "look_up", "note_contacts", "note_order", "order_matters"]

_SIGNED = slice(LARGEST, ADHESION + 1)
"""Numbers of ``edinburgh`` that change their sign, and should not."""


def order_matters(world: World) -> bool:
    """Tell whether contacts begin anew when two particles change their order."""
    switches = world.pair.switches
    return switches is not None and switches[NORMAL] in (EDINBURGH, EDINBURGH_STIFFNESS)


def note_order(world: World) -> None:
    """Note the order of the particles for which lists were made, where it matters."""
    state = world.state
    world.lists.rank = state.rank[: state.n].copy() if order_matters(world) else None


def note_contacts(world: World) -> Noted | None:
    """Return what particles in contact know of each other, under the ids that they have now.

    Returns
    -------
    Noted or None
        None without contacts that remember anything.
    """
    lists, ids = world.lists, world.state.ids
    pairs, n = lists.pairs, lists.before
    used = np.flatnonzero(pairs.touch[: int(pairs.start[n])]) if n else np.zeros(0, np.int64)
    if not len(used) or not pairs.hist.shape[1]:
        return None
    one = np.repeat(np.arange(n), np.diff(pairs.start[: n + 1]))[used]
    two = pairs.other[used].astype(np.int64)
    turned = pairs.hist[used].copy()
    turned[:, :IMPACT] *= -1.0  # seen from the other side
    hist = np.concatenate([pairs.hist[used], turned])
    owner, other = np.concatenate([one, two]), np.concatenate([two, one])
    if lists.rank is not None:
        hist[lists.rank[owner] > lists.rank[other], _SIGNED] *= -1.0
    return Noted(ids[owner], ids[other], np.concatenate([pairs.touch[used]] * 2), hist)


def compress_ids(world: World, noted: Noted | None) -> Noted | None:
    """Give the particles the ids 1, 2, 3 and so on, in the order of LIGGGHTS.

    Parameters
    ----------
    world : World
        Particles, fixes and computes.
    noted : Noted or None
        What contacts remember, under the ids before.

    Returns
    -------
    Noted or None
        What those that are left know, these under their new ids.
    """
    state = world.state
    place = np.argsort(state.rank[: state.n])
    new = dict(zip(state.ids[place].tolist(), range(1, state.n + 1), strict=True))
    state.ids[place] = 1 + np.arange(state.n)
    for one in (*all_fixes(world), *world.computes.values()):
        one.ids_changed(new)
    if noted is None:
        return None
    owner = np.array([new.get(number, 0) for number in noted.owner.tolist()], np.int64)
    left = owner > 0
    return Noted(owner[left], noted.other[left], noted.touch[left], noted.hist[left])


def insert(world: World, fix: Fix) -> None:
    """Let a fix insert; with its ``compress_tags yes`` all particles then get other ids."""
    before = world.state.n
    fix.insert(world)
    came = world.state.n > before
    if came and fix.compresses_ids():
        lists = world.lists
        lists.noted = compress_ids(world, lists.noted or note_contacts(world))


def look_up(world: World) -> None:
    """Give the pairs of the lists in use what LIGGGHTS finds for them, before lists are made.

    Of two particles the one that comes first in its order is asked.
    """
    lists, state = world.lists, world.state
    noted, lists.noted = lists.noted, None
    if noted is None:
        if lists.rank is not None:
            _turn(world, lists.rank)
        return
    first, second = (_places(world, ids) for ids in (noted.owner, noted.other))
    found = (first >= 0) & (second >= 0)
    found &= state.rank[first] < state.rank[second]
    first, second = first[found], second[found]
    hist = noted.hist[found]
    hist[:, :IMPACT] *= np.where(first < second, 1.0, -1.0)[:, None]
    owner, other = np.minimum(first, second), np.maximum(first, second)
    order = np.argsort(owner, kind="stable")
    lists.replace_pairs(owner[order], other[order], noted.touch[found][order], hist[order])


def _turn(world: World, before: Ints) -> None:
    """Change the signs of contacts whose two particles have changed their order."""
    pairs, n, now = world.lists.pairs, world.lists.before, world.state.rank
    used = np.flatnonzero(pairs.touch[: int(pairs.start[n])]) if n else np.zeros(0, np.int64)
    one = np.repeat(np.arange(n), np.diff(pairs.start[: n + 1]))[used]
    two = pairs.other[used].astype(np.int64)
    changed = (before[one] < before[two]) != (now[one] < now[two])
    changed &= _inside(world, one, two)
    pairs.hist[used[changed], _SIGNED] *= -1.0


def _inside(world: World, one: Ints, two: Ints) -> Bools:
    """Tell which pairs touch inside the box; through a periodic face each has its own contact."""
    apart = np.abs(world.state.row[one, POSITION] - world.state.row[two, POSITION])
    period = world.need_box().period()
    found: Bools = ((period == 0.0) | (apart < 0.5 * period)).all(axis=1)
    return found


def _places(world: World, ids: Ints) -> Ints:
    """Return the particles with these ids that the lists in use know of, -1 where there is none."""
    known = world.state.ids[: world.lists.before]
    order = np.argsort(known)
    at = np.minimum(np.searchsorted(known[order], ids), len(known) - 1)
    place = order[at]
    return np.where(known[place] == ids, place, -1)
