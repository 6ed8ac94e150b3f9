"""The loops of a step when several threads share them.

The rows of the particle table are cut into as many pieces as there are threads, by the number of
their neighbour entries. A piece works on its own rows; what its pairs do to rows of later pieces
goes to a buffer, added in the order of the pieces. So the result depends on the number of pieces
and not on which thread took which piece, or when. A pair list is made in pieces, too, each of which
fills a part of it; the parts are then moved together, which gives the list of one thread.

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
    FX, HEAD, LIQUID_FLUX, NEED_COUNT, PARTICLES, REACHED, SPILT, TURNED, TZ, WET,
)  # fmt: skip
from minidem.kernels.contact.laws.liquid import begin_flux, settle
from minidem.kernels.contact.mesh_loads import wear_down
from minidem.kernels.contact.walls import wall_forces_for
from minidem.kernels.lists.neighbor import pair_list
from minidem.kernels.machine.jit import inner, kernel
from minidem.kernels.machine.space import claim, give_way, look, publish
from minidem.kernels.motion.integrate import kick, second
from minidem.kernels.near import looked
from minidem.kernels.scene import Bodies, Scene
from minidem.kernels.step.phases import ADVANCE, ONLY_PAIRS, ONLY_WALLS, Model, Phases, pairs_of

__all__ = ["LINE", "PIECES", "helper_for", "shared", "sync_words"]

LINE = 16  # words; two cache lines, because processors fetch them in pairs
ROUND, WORK, FLAG, QUIT, PIECES = (k * LINE for k in range(5))
TAKEN, FINISHED, PIECE = 0, LINE, 2 * LINE  # words of a piece, and their number
MOVE, COLLIDE, END, LIST = range(4)
SPEED = 1  # word of ``Team.moved`` behind the move
PATIENCE = 2000  # looks before a waiting thread lets others run


def sync_words(threads: int) -> int:
    """Return how many words ``Team.sync`` needs."""
    return PIECES + PIECE * threads


@cache
def _piece_for(model: Model) -> Any:
    """Return the function that works on one piece."""
    pair_forces = pairs_of(model, shared=True)
    wall_forces = wall_forces_for(model.switches, general=model.general)

    @inner
    def piece(c: int, scene: Any, lists: Any) -> None:
        team = scene.team
        work = team.sync[WORK]
        flag = team.sync[FLAG]
        first = team.bound[c]
        last = team.bound[c + 1]
        if work == MOVE:
            far, fast = kick(first, last, scene.control, scene.parts, scene.posts, flag)
            team.moved[c * LINE] = far
            team.moved[c * LINE + SPEED] = fast
        elif work == END:
            second(first, last, scene.control, scene.parts)
        else:
            spill = team.spill[c]
            spill[HEAD, REACHED] = 0.0
            update = flag & ADVANCE
            bodies = Bodies(scene.control, scene.parts, scene.coef)
            if not flag & ONLY_WALLS:
                pair_forces(first, last, bodies, lists.pairs, update, spill)
            if not flag & ONLY_PAIRS:
                wall_forces(first, last, bodies, lists.walls, scene.mesh, update, team.load[c])

    return piece


@inner
def _offer(sync: Any, work: int, flag: int) -> Any:
    """Begin a round: let the helpers see its work; return its number."""
    turn = sync[ROUND] + 1
    sync[WORK] = work
    sync[FLAG] = flag
    publish(sync, ROUND, turn)
    return turn


@inner
def _wait(sync: Any, pieces: int, turn: int) -> None:
    """Wait until all pieces of a round are done."""
    for c in range(pieces):
        looks = 0
        while look(sync, PIECES + PIECE * c + FINISHED) != turn:
            looks += 1
            if looks > PATIENCE:
                give_way()


@inner
def _list_piece(c: int, tables: Any) -> None:
    """Make one part of the pair list; ``moved`` says how many entries it needs."""
    team = tables.team
    turned = tables.control.whole[TURNED] == 1
    lists = tables.second if turned else tables.first
    fresh = tables.first.pairs if turned else tables.second.pairs
    pieces = team.bound.shape[0] - 1
    n = tables.more.needs[NEED_COUNT]
    room = fresh.other.shape[0] // pieces
    before = team.sync[FLAG]
    team.moved[c * LINE] = pair_list(
        n * c // pieces, n * (c + 1) // pieces, c * room, (c + 1) * room, before, tables,
        lists.pairs, fresh,
    )  # fmt: skip


@inner
def _move_together(n: int, team: Any, fresh: Any) -> Any:
    """Close the gaps between the parts of a pair list; return how many entries it needs."""
    pieces = team.bound.shape[0] - 1
    room = fresh.other.shape[0] // pieces
    longest = 0.0
    for c in range(pieces):
        longest = max(longest, team.moved[c * LINE])
    if longest > room:
        return pieces * np.int64(longest)  # more than there is room for
    end = np.int64(0)
    for c in range(pieces):
        back = c * room - end
        count = np.int64(team.moved[c * LINE])
        if back > 0:
            for p in range(end, end + count):
                fresh.owner[p] = fresh.owner[p + back]
                fresh.other[p] = fresh.other[p + back]
                fresh.touch[p] = fresh.touch[p + back]
                for k in range(fresh.hist.shape[1]):
                    fresh.hist[p, k] = fresh.hist[p + back, k]
            for a in range(n * c // pieces, n * (c + 1) // pieces):
                fresh.start[a] -= back
        end += count
    fresh.start[n] = end
    return end


@cache
def shared(model: Model) -> Phases:
    """Return the phases for several threads."""
    piece = _piece_for(model)

    @inner
    def together(work: int, scene: Any, lists: Any, flag: int) -> None:
        team = scene.team
        sync = team.sync
        pieces = team.moved.shape[0] // LINE
        turn = _offer(sync, work, flag)
        for c in range(pieces):
            at = PIECES + PIECE * c
            if claim(sync, at + TAKEN, turn - 1, turn):
                piece(c, scene, lists)
                publish(sync, at + FINISHED, turn)
        _wait(sync, pieces, turn)

    @inner
    def divide(scene: Any, lists: Any, flag: int) -> None:
        n = scene.control.whole[PARTICLES]
        start = lists.pairs.start
        bound = scene.team.bound
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
    def move(scene: Any, lists: Any, flag: int) -> Any:
        together(MOVE, scene, lists, flag)
        team = scene.team
        far = 0.0
        bad = 0.0
        fast = 0.0
        for c in range(team.bound.shape[0] - 1):
            far = max(far, team.moved[c * LINE])
            bad += team.moved[c * LINE] * 0.0
            fast = max(fast, team.moved[c * LINE + SPEED])
        return far + bad, fast

    @inner
    def collide(scene: Any, lists: Any, flag: int) -> None:
        n = scene.control.whole[PARTICLES]
        wet = flag & ADVANCE != 0 and scene.control.whole[WET] == 1
        if wet and not flag & ONLY_WALLS:
            begin_flux(n, scene.parts)
        together(COLLIDE, scene, lists, flag)
        if not flag & ONLY_WALLS:
            looked(n, scene.parts.row, scene.control.real)
        team = scene.team
        force = scene.parts.force
        spill = team.spill
        load = lists.walls.load
        pieces = team.bound.shape[0] - 1
        for c in range(pieces - 1):
            for i in range(team.bound[c + 1], np.int64(spill[c, HEAD, REACHED])):
                for f in range(FX, TZ + 1):
                    force[i, f] += spill[c, i, f]
                    spill[c, i, f] = 0.0
                if spill[c, i, SPILT] != 0.0:
                    scene.parts.liquid[i, LIQUID_FLUX] += spill[c, i, SPILT]
                    spill[c, i, SPILT] = 0.0
        for m in range(load.shape[0]):
            for f in range(FX, TZ + 1):
                load[m, f] = 0.0
                for c in range(pieces):
                    load[m, f] += team.load[c, m, f]
        if flag & ADVANCE and not flag & ONLY_PAIRS:
            wear_down(load, lists.walls.mesh.shape[0])
        if wet and not flag & ONLY_PAIRS:
            settle(n, scene.control, scene.parts)

    @inner
    def end(scene: Any, lists: Any, flag: int) -> None:
        together(END, scene, lists, flag)

    @inner
    def list_pairs(before: int, tables: Any, lists: Any, spare: Any) -> Any:
        team = tables.team
        sync = team.sync
        pieces = team.moved.shape[0] // LINE
        turn = _offer(sync, LIST, before)
        for c in range(pieces):
            at = PIECES + PIECE * c
            if claim(sync, at + TAKEN, turn - 1, turn):
                _list_piece(c, tables)
                publish(sync, at + FINISHED, turn)
        _wait(sync, pieces, turn)
        return _move_together(tables.more.needs[NEED_COUNT], team, spare.pairs)

    return Phases(divide, move, collide, end, list_pairs)


@cache
def helper_for(model: Model) -> Any:
    """Return the kernel of a helping thread.

    Returns
    -------
    callable
        ``help_out(tables)``, the `Tables` of the run loop; it works on pieces until that returns.
    """
    piece = _piece_for(model)

    @kernel
    def help_out(tables: Any) -> None:
        team = tables.team
        scene = Scene(tables.control, tables.parts, tables.mesh, tables.posts, tables.coef, team)
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
                    if sync[WORK] == LIST:
                        _list_piece(c, tables)
                    else:
                        turned = tables.control.whole[TURNED] == 1
                        piece(c, scene, tables.second if turned else tables.first)
                    publish(sync, at + FINISHED, seen)

    return help_out
