"""What contacts remember once `delete_atoms` has given particles other ids, as in LIGGGHTS.

Before particles go, LIGGGHTS notes with each of them the ids of those that it touches, and what the
contact remembers. It looks for these ids when it makes new lists, by then under the new ids: most
contacts begin anew, and a few take over what another one remembers.
"""

from __future__ import annotations

import numpy as np

from minidem.kernels.columns import IMPACT
from minidem.world.lists import Noted
from minidem.world.state import Ints
from minidem.world.world import World

__all__ = ["look_up", "note_contacts"]


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
    return Noted(
        ids[np.concatenate([one, two])],
        ids[np.concatenate([two, one])],
        np.concatenate([pairs.touch[used]] * 2),
        np.concatenate([pairs.hist[used], turned]),
    )


def look_up(world: World) -> None:
    """Give the pairs of the lists in use what LIGGGHTS finds for them under the new ids.

    Of two particles the one that comes first in its order is asked.
    """
    lists, state = world.lists, world.state
    noted, lists.noted = lists.noted, None
    if noted is None:
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


def _places(world: World, ids: Ints) -> Ints:
    """Return the particles with these ids that the lists in use know of, -1 where there is none."""
    known = world.state.ids[: world.lists.before]
    order = np.argsort(known)
    at = np.minimum(np.searchsorted(known[order], ids), len(known) - 1)
    place = order[at]
    return np.where(known[place] == ids, place, -1)
