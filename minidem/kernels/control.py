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
    "REBUILD",
    "REBUILD_NOW",
    "REBUILD_ON",
    "WITH_LISTS",
]

AT_SETUP_WALLS, AT_WALLS, AT_START, AT_FORCES, AT_SETUP, AT_POSTS, AT_SETUP_POSTS = range(-2, 5)
REBUILD_NOW, REBUILD_ON = 5, 6
WITH_LISTS = -3
"""Values of ``ENTRY``: where the run loop goes on.

At the start of a step; at its forces, when the particles have moved; at its walls; at the posts
after the walls. At setup the same, with histories that do not advance. The next two only make
lists: from the start, or on after `minidem.kernels.lists.rebuild.INCOMPLETE`. With the last one
lists are made as in the loop, with the particles that Python has added, and forces follow.
"""

DONE, REBUILD, DRAIN, OUTSIDE, PAUSE = range(5)
"""Values of ``CODE``: why the run loop returned.

The step to stop at is made; new lists want Python; the buffer of flow events is half full; posts
want Python; the step to pause at has come.
"""
