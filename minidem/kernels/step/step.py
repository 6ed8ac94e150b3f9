"""Many time steps in one call: velocity Verlet in the order of operations of LIGGGHTS.

`advance_for` makes the run loop for one choice of contact models. The choice is a compile-time
constant, so that the pair loop holds only the branches of its model; the machine code of every
choice is kept on disk. Everything that a step needs is in one function because a call from
Python costs as much as a step of some hundred particles.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import sqrt
from typing import Any

import numpy as np

from minidem.kernels.columns import (  # isort: skip
    ONLY, STEP, STOP_STEP, INSERT_STEP, ENTRY, CODE, LIST_AGE, LIST_DELAY, LIST_EVERY,
    LIST_CHECK, PARTICLES, RENEW_STEP, AIRBORNE_STEP, MOTIONS, FLOWS, POSTS, LEADING,
    NEEDS_PYTHON, TURNED, REBUILT, BUILDS, LISTED, LATE_POSTS, PAUSE_STEP, DT, TRIGGER2, MOVED2,
    SKIN, SWEPT, SORT_STEP, ALONG, TRAVEL, WAY, NEARBY, X, Y, Z,
)  # fmt: skip
from minidem.kernels.control import (  # isort: skip
    AT_FORCES, AT_POSTS, AT_SETUP, AT_SETUP_POSTS, AT_SETUP_WALLS, AT_START, AT_WALLS, DONE, DRAIN,
    OUTSIDE, PAUSE, REBUILD, REBUILD_NOW, WITH_LISTS,
)  # fmt: skip
from minidem.kernels.lists.leaving import remaining
from minidem.kernels.lists.rebuild import (
    FROM_LOOP,
    FROM_PYTHON,
    LASTED,
    MADE,
    SORTED,
    WITH_MORE,
    rebuild_for,
)
from minidem.kernels.lists.wall_lists import all_may_touch
from minidem.kernels.machine.jit import kernel
from minidem.kernels.motion.flow import count_through
from minidem.kernels.motion.integrate import AGAIN, UNSEEN, farthest, fly
from minidem.kernels.motion.motion import move_meshes, nodes_moved
from minidem.kernels.motion.post import apply_posts, lead
from minidem.kernels.near import MANY
from minidem.kernels.scene import Scene
from minidem.kernels.step.phases import ADVANCE, ONLY_PAIRS, ONLY_WALLS, SETUP, Model, alone
from minidem.kernels.step.team import shared

__all__ = ["advance_for"]

SHORT = 0.999999
"""Part of the way that asks for new lists which no sum of ways reaches by rounding."""


@cache
def advance_for(model: Model, *, several: bool = False) -> Callable[..., None]:
    """Return the run loop compiled for a model.

    Parameters
    ----------
    model : Model
        Contact law and periodicity.
    several : bool
        True for several threads.

    Returns
    -------
    callable
        ``advance(tables)``, a `minidem.kernels.scene.Tables`; it works in place and returns when
        one of the steps to return at is reached, new lists need Python, the event buffer is half
        full, or a post needs Python.
    """
    phases = (shared if several else alone)(model)
    divide, move, collide, end, list_pairs = phases
    rebuild_inside = rebuild_for(list_pairs)

    @kernel
    def advance(tables: Any) -> None:
        whole = tables.control.whole
        real = tables.control.real
        parts = tables.parts
        mesh = tables.mesh
        motions = tables.motions
        flows = tables.flows
        posts = tables.posts
        n = whole[PARTICLES]
        dt = real[DT]
        lists = tables.second if whole[TURNED] == 1 else tables.first
        scene = Scene(tables.control, parts, mesh, posts, tables.coef, tables.team)
        real[SWEPT] = np.inf  # Python may have moved particles
        real[WAY] = np.inf
        faster = np.inf  # twice the way of the last step
        real[TRAVEL] = 0.0
        if WITH_LISTS < whole[ENTRY] < REBUILD_NOW:
            all_may_touch(n, lists.walls)
            divide(scene, lists, ADVANCE)
        open_end = 0  # AGAIN if the second half kick of the last step is still to be made
        while True:
            entry = whole[ENTRY]
            fresh = entry == AT_FORCES
            must = entry == WITH_LISTS
            if must:
                whole[ENTRY] = AT_FORCES
                whole[CODE] = REBUILD
            if entry == AT_START:
                if whole[STEP] >= whole[STOP_STEP]:
                    whole[CODE] = DONE
                    return
                whole[STEP] += 1
                # how far many particles have moved is looked at only where it may be enough, since
                # their places are not in the nearest cache
                trigger = SHORT * sqrt(real[TRIGGER2])
                unseen = UNSEEN if n >= MANY and real[WAY] + faster < trigger else 0
                moved2, fastest2 = move(scene, lists, open_end + unseen)
                swept = dt * sqrt(fastest2)
                real[SWEPT] += swept
                swept += dt * sqrt(
                    real[ALONG + X] ** 2 + real[ALONG + Y] ** 2 + real[ALONG + Z] ** 2
                )
                real[WAY] += swept
                faster = 2.0 * swept
                if unseen and not real[WAY] < trigger:
                    moved2 += farthest(n, parts)
                open_end = 0
                real[MOVED2] = moved2
                if whole[MOTIONS] > 0:
                    swept += move_meshes(
                        mesh, motions, whole[MOTIONS], whole[STEP], dt, real[NEARBY]
                    )
                real[TRAVEL] += swept
                if whole[FLOWS] > 0:
                    count_through(parts, tables.more.ids, mesh, flows, whole[FLOWS], whole[STEP])
                must = whole[STEP] == whole[INSERT_STEP] or whole[STEP] == whole[RENEW_STEP]
                if not must:
                    whole[LIST_AGE] += 1
                    if (
                        whole[LIST_AGE] >= whole[LIST_DELAY]
                        and whole[LIST_AGE] % whole[LIST_EVERY] == 0
                    ):
                        must = whole[LIST_CHECK] == 0 or not moved2 <= real[TRIGGER2]
                if must:
                    whole[ENTRY] = AT_FORCES
                    whole[CODE] = REBUILD
                    if (
                        whole[STEP] == whole[INSERT_STEP]
                        or whole[STEP] >= whole[SORT_STEP]
                        or not moved2 <= real[SKIN] * real[SKIN]
                    ):
                        return
                elif whole[MOTIONS] > 0 and nodes_moved(
                    mesh, motions, whole[MOTIONS], real[TRIGGER2]
                ):
                    whole[RENEW_STEP] = whole[STEP] + 1
            if must or entry >= REBUILD_NOW:
                spare = tables.first if whole[TURNED] == 1 else tables.second
                mode = FROM_LOOP
                before = n
                if entry != AT_START:
                    before = whole[LISTED]
                    mode = FROM_PYTHON if entry == REBUILD_NOW else SORTED
                    if entry == WITH_LISTS:
                        mode = WITH_MORE
                state = rebuild_inside(mode, n, before, tables, lists, spare)
                whole[REBUILT] = state
                if state != MADE and state != LASTED:
                    return
                whole[LIST_AGE] = 0
                whole[BUILDS] += 1
                real[WAY] = 0.0
                if state == MADE:
                    whole[TURNED] = 1 - whole[TURNED]
                    if entry >= REBUILD_NOW:
                        return
                    n = remaining(n, tables)
                    lists = spare
                    real[SWEPT] = np.inf
                    divide(scene, lists, ADVANCE)
                fresh = True
            if whole[STEP] == whole[PAUSE_STEP] and entry == AT_START:
                whole[ENTRY] = AT_FORCES
                whole[CODE] = PAUSE
                return
            at_setup = entry in (AT_SETUP, AT_SETUP_POSTS, AT_SETUP_WALLS)
            update = SETUP if at_setup else ADVANCE
            if entry != AT_POSTS and entry != AT_SETUP_POSTS:
                if entry == AT_SETUP or fresh:
                    lead(n, parts, posts, whole[LEADING])
                part = 0
                if whole[LATE_POSTS] > whole[LEADING]:  # forces before the walls
                    part = ONLY_WALLS
                    if entry != AT_WALLS and entry != AT_SETUP_WALLS:
                        collide(scene, lists, ONLY_PAIRS + update)
                        if whole[NEEDS_PYTHON] != 0:
                            whole[ENTRY] = AT_SETUP_WALLS if at_setup else AT_WALLS
                            whole[CODE] = OUTSIDE
                            return
                        apply_posts(n, parts, posts, whole[LEADING], whole[LATE_POSTS])
                collide(scene, lists, part + update)
                if whole[NEEDS_PYTHON] != 0:
                    whole[ENTRY] = AT_SETUP_POSTS if at_setup else AT_POSTS
                    whole[CODE] = OUTSIDE
                    return
            if at_setup:
                # forces only
                apply_posts(n, parts, posts, whole[LATE_POSTS], whole[POSTS])
                whole[ENTRY] = AT_START
                whole[CODE] = DONE
                return
            if whole[POSTS] > whole[LATE_POSTS]:
                apply_posts(n, parts, posts, whole[LATE_POSTS], whole[POSTS])
            whole[ENTRY] = AT_START
            full = whole[FLOWS] > 0 and 2 * flows.found[ONLY] > flows.event.shape[0]
            if whole[AIRBORNE_STEP] < whole[STEP] < whole[STOP_STEP] and not full:
                open_end = AGAIN
                continue
            end(scene, lists, ADVANCE)
            if whole[AIRBORNE_STEP] >= whole[STEP]:
                fly(n, parts, whole[STEP], dt)
            if full:
                whole[CODE] = DRAIN
                return

    made: Callable[..., None] = advance
    return made
