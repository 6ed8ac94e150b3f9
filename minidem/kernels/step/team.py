"""The loops of a step when several threads share them.

The rows of the particle table are cut into as many pieces as there are threads, by the number of
their neighbour entries. A piece works on its own rows; what its pairs do to rows of later pieces
goes to a buffer, added in the order of the pieces. So the result depends on the number of pieces
and not on which thread took which piece, or when.

A thread takes a piece by an atomic exchange. The thread that runs the loop takes whatever is
left, so that it never waits for a helper that the system has not started: it waits only for
pieces under way.

Words of ``Team.sync`` (a cache line each): round, what to do, flag, quit; then per piece the
round in which it was taken, and that in which it was done.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from minidem.kernels.columns import (  # isort: skip
    FX, TZ, HEAD, REACHED, PARTICLES, INTEGRATED, TYPES, LEADING, TURNED, DT,
)  # fmt: skip
from minidem.kernels.contact.walls import wall_forces_for
from minidem.kernels.machine.jit import claim, give_way, inner, kernel, look, publish
from minidem.kernels.motion.post import kick, second
from minidem.kernels.step.phases import ADVANCE, ONLY_PAIRS, ONLY_WALLS, Model, Phases, pairs_of

__all__ = ["LINE", "PIECES", "helper_for", "shared", "sync_words"]

LINE = 16  # words; two cache lines, because processors fetch them in pairs
ROUND, WORK, FLAG, QUIT, PIECES = (k * LINE for k in range(5))
TAKEN, FINISHED, PIECE = 0, LINE, 2 * LINE  # words of a piece, and their number
MOVE, COLLIDE, END = range(3)
PATIENCE = 2000  # looks before a waiting thread lets others run


def sync_words(threads: int) -> int:
    """Return how many words ``Team.sync`` needs."""
    return PIECES + PIECE * threads


@cache
def _piece_for(model: Model) -> Any:
    """Return the function that works on one piece."""
    pair_forces = pairs_of(model, shared=True)
    wall_forces = wall_forces_for(model.switches)

    @inner
    def piece(
        c: int, control: Any, parts: Any, pairs: Any, walls: Any, mesh: Any, posts: Any,
        coef: Any, team: Any,
    ) -> None:  # fmt: skip
        whole = control.whole
        real = control.real
        work = team.sync[WORK]
        flag = team.sync[FLAG]
        first = team.bound[c]
        last = team.bound[c + 1]
        if work == MOVE:
            team.moved[c * LINE] = kick(
                first, last, parts, posts, whole[LEADING], whole[INTEGRATED], real[DT], flag
            )
        elif work == END:
            second(first, last, parts, whole[INTEGRATED])
        else:
            team.spill[c, HEAD, REACHED] = 0.0
            update = flag & ADVANCE
            if not flag & ONLY_WALLS:
                pair_forces(first, last, parts, pairs, coef, whole, real, update, team.spill[c])
            if not flag & ONLY_PAIRS:
                wall_forces(
                    first,
                    last,
                    parts,
                    walls,
                    mesh,
                    team.load[c],
                    coef,
                    whole[TYPES],
                    update,
                    real[DT],
                )

    return piece


@cache
def shared(model: Model) -> Phases:
    """Return the phases for several threads."""
    piece = _piece_for(model)

    @inner
    def together(
        work: int, control: Any, parts: Any, pairs: Any, walls: Any, mesh: Any, posts: Any,
        coef: Any, team: Any, flag: int,
    ) -> None:  # fmt: skip
        sync = team.sync
        pieces = team.moved.shape[0] // LINE
        turn = sync[ROUND] + 1
        sync[WORK] = work
        sync[FLAG] = flag
        publish(sync, ROUND, turn)
        for c in range(pieces):
            at = PIECES + PIECE * c
            if claim(sync, at + TAKEN, turn - 1, turn):
                piece(c, control, parts, pairs, walls, mesh, posts, coef, team)
                publish(sync, at + FINISHED, turn)
        for c in range(pieces):
            looks = 0
            while look(sync, PIECES + PIECE * c + FINISHED) != turn:
                looks += 1
                if looks > PATIENCE:
                    give_way()

    @inner
    def divide(
        control: Any, parts: Any, pairs: Any, walls: Any, mesh: Any, posts: Any, coef: Any,
        team: Any, flag: int,
    ) -> None:  # fmt: skip
        n = control.whole[PARTICLES]
        start = pairs.start
        bound = team.bound
        pieces = bound.shape[0] - 1
        bound[0] = 0
        bound[pieces] = n
        for c in range(1, pieces):
            # a row costs about as much as three of its entries
            wanted = c * (start[n] + 3 * n)
            lo = bound[c - 1]
            hi = n
            while lo < hi:
                middle = (lo + hi) // 2
                if (start[middle] + 3 * middle) * pieces < wanted:
                    lo = middle + 1
                else:
                    hi = middle
            bound[c] = lo

    @inner
    def move(
        control: Any, parts: Any, pairs: Any, walls: Any, mesh: Any, posts: Any, coef: Any,
        team: Any, flag: int,
    ) -> Any:  # fmt: skip
        together(MOVE, control, parts, pairs, walls, mesh, posts, coef, team, flag)
        far = 0.0
        bad = 0.0
        for c in range(team.bound.shape[0] - 1):
            far = max(far, team.moved[c * LINE])
            bad += team.moved[c * LINE] * 0.0
        return far + bad

    @inner
    def collide(
        control: Any, parts: Any, pairs: Any, walls: Any, mesh: Any, posts: Any, coef: Any,
        team: Any, flag: int,
    ) -> None:  # fmt: skip
        together(COLLIDE, control, parts, pairs, walls, mesh, posts, coef, team, flag)
        force = parts.force
        spill = team.spill
        load = walls.load
        pieces = team.bound.shape[0] - 1
        for c in range(pieces - 1):
            for i in range(team.bound[c + 1], np.int64(spill[c, HEAD, REACHED])):
                for f in range(FX, TZ + 1):
                    force[i, f] += spill[c, i, f]
                    spill[c, i, f] = 0.0
        for m in range(load.shape[0]):
            for f in range(FX, TZ + 1):
                load[m, f] = 0.0
                for c in range(pieces):
                    load[m, f] += team.load[c, m, f]

    @inner
    def end(
        control: Any, parts: Any, pairs: Any, walls: Any, mesh: Any, posts: Any, coef: Any,
        team: Any, flag: int,
    ) -> None:  # fmt: skip
        together(END, control, parts, pairs, walls, mesh, posts, coef, team, flag)

    return Phases(divide, move, collide, end)


@cache
def helper_for(model: Model) -> Any:
    """Return the kernel of a helping thread.

    Returns
    -------
    callable
        ``help_out(control, parts, pairs_a, pairs_b, walls_a, walls_b, mesh, posts, coef, team)``;
        it works on pieces until the run loop returns.
    """
    piece = _piece_for(model)

    @kernel
    def help_out(
        control: Any, parts: Any, pairs_a: Any, pairs_b: Any, walls_a: Any, walls_b: Any,
        mesh: Any, posts: Any, coef: Any, team: Any,
    ) -> None:  # fmt: skip
        sync = team.sync
        pieces = team.moved.shape[0] // LINE
        seen = np.int64(0)
        while True:
            looks = 0
            while look(sync, ROUND) == seen:
                if look(sync, QUIT) != 0:
                    return
                looks += 1
                if looks > PATIENCE:
                    give_way()
            seen = look(sync, ROUND)
            for back in range(pieces):
                c = pieces - 1 - back
                at = PIECES + PIECE * c
                if claim(sync, at + TAKEN, seen - 1, seen):
                    turned = control.whole[TURNED] == 1
                    piece(
                        c, control, parts, pairs_b if turned else pairs_a,
                        walls_b if turned else walls_a, mesh, posts, coef, team,
                    )  # fmt: skip
                    publish(sync, at + FINISHED, seen)

    return help_out
