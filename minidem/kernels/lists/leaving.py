"""Particles at the faces of the box: those that wrap around, and those that leave."""

from __future__ import annotations

from typing import Any

from minidem.kernels.columns import (  # isort: skip
    BOX_LOWER, BOX_PERIODIC, BOX_UPPER, GONE, LOST, LOST_AT, LOST_ID, LOST_STEP, NEED_COUNT,
    PARTICLES, STEP,
)  # fmt: skip
from minidem.kernels.machine.jit import inlined, inner

__all__ = ["leave", "remaining", "wrap"]


@inner
def wrap(n: int, row: Any, image: Any, box: Any) -> bool:
    """Wrap periodic directions; return True if a particle is beyond a fixed face."""
    beyond = False
    for c in range(3):
        lo = box[BOX_LOWER + c]
        hi = box[BOX_UPPER + c]
        periodic = box[BOX_PERIODIC + c] > 0.0
        for i in range(n):
            x = row[i, c]
            if lo <= x < hi:
                continue
            if not periodic:
                beyond = beyond or x < lo or x >= hi
            elif x < lo:
                row[i, c] = max(x + (hi - lo), lo)
                image[i, c] -= 1
            elif x >= hi:
                row[i, c] = max(x - (hi - lo), lo)
                image[i, c] += 1
    return beyond


@inlined
def _beyond(row: Any, i: int, c: int, box: Any) -> Any:
    """Whether a particle is beyond a fixed face; none that is no number is."""
    fixed = box[BOX_PERIODIC + c] <= 0.0
    return fixed and (row[i, c] < box[BOX_LOWER + c] or row[i, c] >= box[BOX_UPPER + c])


@inner
def leave(n: int, row: Any, more: Any, control: Any) -> bool:
    """Let the particles go that are beyond fixed faces, as LIGGGHTS goes through its list.

    It does so once per direction, as particles would change processors: the last particle of the
    list fills the place of one that goes, and is looked at next.

    Parameters
    ----------
    n : int
        Particles.
    row : float64 (cap, 8)
        Particle rows.
    more : More
        ``alive`` and ``rank`` of those that go are changed, and the ranks of the others.
    control : Control
        Told how many left, and who.

    Returns
    -------
    bool
        False, with nothing changed, if the ranks are not those of a full list.
    """
    rank = more.rank
    place = more.where
    box = more.box
    for k in range(n):
        place[k] = -1
    for i in range(n):
        at = rank[i]
        if at < 0 or at >= n or place[at] >= 0:
            return False
        place[at] = i
    count = n
    first = n
    for c in range(3):
        at = 0
        while at < count:
            i = place[at]
            if not _beyond(row, i, c, box):
                at += 1
                continue
            more.alive[i] = 0
            rank[i] = GONE
            count -= 1
            place[at] = place[count]
            first = min(first, i)
    for at in range(count):
        rank[place[at]] = at
    if count < n:
        control.whole[LOST] += n - count
        control.whole[LOST_ID] = more.ids[first]
        control.whole[LOST_STEP] = control.whole[STEP]
        for c in range(3):
            control.real[LOST_AT + c] = row[first, c]
    return True


@inner
def remaining(n: int, tables: Any) -> Any:
    """Return how many of `n` particles stayed when lists were made anew; forget the others."""
    left = tables.more.needs[NEED_COUNT]
    if left < n:
        tables.control.whole[PARTICLES] = left
        for i in range(n):
            tables.more.alive[i] = 1
    return left
