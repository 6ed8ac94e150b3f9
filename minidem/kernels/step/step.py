"""Many time steps in one call: velocity Verlet in the order of operations of LIGGGHTS.

`advance_for` makes the run loop for one choice of contact models. The choice is a compile-time
constant, so that the pair loop holds only the branches of its model; the machine code of every
choice is kept on disk. Everything that a step needs is in one function because a call from
Python costs as much as a step of some hundred particles.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

from minidem.kernels.lists.rebuild import rebuild_inside
from minidem.kernels.machine.jit import kernel
from minidem.kernels.motion.flow import count_through
from minidem.kernels.motion.motion import move_meshes, nodes_moved
from minidem.kernels.motion.post import apply_posts, fly, lead
from minidem.kernels.step.phases import PAIRS, WALLS, Model, alone
from minidem.kernels.step.team import shared

__all__ = ["advance_for"]


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
        ``advance(control, parts, more, pairs, spare_pairs, walls, spare_walls, mesh, motions,
        flows, posts, coef, team)``; it works in place and returns when ``stop`` or ``middle`` is
        reached, new lists need Python, the event buffer is half full, or a post needs Python.
    """
    phases = (shared if several else alone)(model)
    divide, move, collide, end = phases

    @kernel
    def advance(
        control: Any, parts: Any, more: Any, pairs_a: Any, pairs_b: Any, walls_a: Any,
        walls_b: Any, mesh: Any, motions: Any, flows: Any, posts: Any, coef: Any,
        team: Any,
    ) -> None:  # fmt: skip
        whole = control.whole
        real = control.real
        n = whole[10]
        dt = real[0]
        turned = whole[21]
        pairs = pairs_b if turned == 1 else pairs_a
        walls = walls_b if turned == 1 else walls_a
        if whole[3] < 5:
            divide(control, parts, pairs, walls, mesh, posts, coef, team, 1)
        open_end = 0  # 1 if the second half kick of the last step is still to be made
        while True:
            entry = whole[3]
            fresh = entry == 1
            must = False
            if entry == 0:
                if whole[0] >= whole[1]:
                    whole[4] = 0
                    return
                whole[0] += 1
                moved2 = move(control, parts, pairs, walls, mesh, posts, coef, team, open_end)
                open_end = 0
                real[9] = moved2
                if whole[16] > 0:
                    move_meshes(mesh, motions, whole[16], whole[0], dt)
                if whole[17] > 0:
                    count_through(parts, mesh, flows, whole[17], whole[0])
                must = whole[0] == whole[2] or whole[0] == whole[12]
                if not must:
                    whole[5] += 1
                    if whole[5] >= whole[6] and whole[5] % whole[7] == 0:
                        must = whole[8] == 0 or not moved2 <= real[1]
                if must:
                    whole[3] = 1
                    whole[4] = 1
                    if whole[0] == whole[2] or not moved2 <= real[10] * real[10]:
                        return
                    if whole[17] > 0 and flows.found[0] > 0:
                        return
                elif whole[16] > 0 and nodes_moved(mesh, motions, whole[16], real[1]):
                    whole[12] = whole[0] + 1
            if must or entry >= 5:
                spare_pairs = pairs_a if turned == 1 else pairs_b
                spare_walls = walls_a if turned == 1 else walls_b
                state = rebuild_inside(
                    0 if must else entry - 4, n, n if must else whole[24], dt, real[10], real[11],
                    parts, more, pairs, spare_pairs, walls, spare_walls, mesh,
                    1 if whole[16] > 0 else 0, flows, 1 if whole[13] >= whole[0] else 0,
                )  # fmt: skip
                whole[22] = state
                if state == 0:
                    whole[5] = 0
                    whole[23] += 1
                    turned = 1 - turned
                    whole[21] = turned
                if state != 0 or entry >= 5:
                    return
                pairs = spare_pairs
                walls = spare_walls
                divide(control, parts, pairs, walls, mesh, posts, coef, team, 1)
                fresh = True
            if whole[0] == whole[26] and entry == 0:
                whole[3] = 1
                whole[4] = 4
                return
            update = 0 if entry == 2 or entry == 4 or entry == -2 else 1
            if entry != 3 and entry != 4:
                if entry == 2 or fresh:
                    lead(n, parts, posts, whole[19])
                part = 0
                if whole[25] > whole[19]:  # forces before the walls
                    part = WALLS
                    if entry >= 0:
                        collide(
                            control, parts, pairs, walls, mesh, posts, coef, team, PAIRS + update
                        )
                        if whole[20] != 0:
                            whole[3] = -2 if update == 0 else -1
                            whole[4] = 3
                            return
                        apply_posts(n, parts, posts, whole[19], whole[25])
                collide(control, parts, pairs, walls, mesh, posts, coef, team, part + update)
                if whole[20] != 0:
                    whole[3] = 4 if update == 0 else 3
                    whole[4] = 3
                    return
            if update == 0:
                # setup: forces only
                apply_posts(n, parts, posts, whole[25], whole[18])
                whole[3] = 0
                whole[4] = 0
                return
            if whole[18] > whole[25]:
                apply_posts(n, parts, posts, whole[25], whole[18])
            whole[3] = 0
            full = whole[17] > 0 and 2 * flows.found[0] > flows.event.shape[0]
            if whole[13] < whole[0] < whole[1] and not full:
                open_end = 1
                continue
            end(control, parts, pairs, walls, mesh, posts, coef, team, 1)
            if whole[13] >= whole[0]:
                fly(n, parts, whole[0], dt)
            if full:
                whole[4] = 2
                return

    made: Callable[..., None] = advance
    return made
