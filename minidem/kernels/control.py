"""The numbers that Python and the run loop exchange."""

from __future__ import annotations

__all__ = [
    "AT_FORCES",
    "AT_POSTS",
    "AT_SETUP",
    "AT_SETUP_POSTS",
    "AT_SETUP_WALLS",
    "AT_START",
    "AT_WALLS",
    "DONE",
    "DRAIN",
    "OUTSIDE",
    "PAUSE",
    "REALS",
    "REBUILD",
    "REBUILD_NOW",
    "REBUILD_ON",
    "WHOLES",
]

WHOLES = (
    "step", "stop", "middle", "entry", "code", "ago", "delay", "every", "check", "clear",
    "n", "nve", "renew", "airborne", "frozen", "types", "motions", "flows", "posts", "leading",
    "outside", "turned", "made", "builds",
    "before", "late", "pause",
)  # fmt: skip
"""Meaning of ``Control.whole``.

stop: step at which to return; middle: step at which to return for an insertion; entry: where to
go on; code: why it returned; ago, delay, every, check: of the neighbour list; clear: 1 if pair
history is cleared at separation; nve, frozen: group bits; renew: step at which a moving mesh wants
new lists; airborne: last step with particles in flight; leading: 1 if the first post is gravity
and comes before all walls; outside: 1 if posts need Python first; turned: which of the two sets of
lists is in use; made: what the last rebuild in the loop came to; builds: how many there were;
before: particles that the lists in use were made for; late: first post after the walls; pause: step
at which to return before the forces. From `minidem.kernels.contact.extended.MODEL_AT` on: the
switches of the pair style.
"""

REALS = ("dt", "trigger2", "reach2", "lx", "ly", "lz", "ix", "iy", "iz", "moved2", "skin", "reach")
"""Meaning of ``Control.real``.

trigger2: squared move that asks for new lists; reach2: squared ``contact_distance_factor``;
lx .. lz: periods, ix .. iz: their inverses or 0; moved2: largest squared move found;
skin, reach: of the neighbour list.
"""

AT_SETUP_WALLS, AT_WALLS, AT_START, AT_FORCES, AT_SETUP, AT_POSTS, AT_SETUP_POSTS = range(-2, 5)
REBUILD_NOW, REBUILD_ON = 5, 6
"""Values of ``ENTRY``: where the run loop goes on.

At the start of a step; at its forces, when the particles have moved; at its walls; at the posts
after the walls. At setup the same, with histories that do not advance. The last two only make
lists: from the start, or on after `minidem.kernels.lists.rebuild.INCOMPLETE`.
"""

DONE, REBUILD, DRAIN, OUTSIDE, PAUSE = range(5)
"""Values of ``CODE``: why the run loop returned.

The step to stop at is made; new lists want Python; the buffer of flow events is half full; posts
want Python; the step to pause at has come.
"""
