"""What single contacts do at this moment: for output of contacts and stresses."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from minidem.kernels.columns import (
    COHESION,
    FORCE,
    FX,
    HALF_KICK,
    HALF_TURN,
    IMPACT,
    INTEGRATED,
    INVERSE,
    LENGTH,
    OMEGA,
    PARTICLE,
    POSITION,
    RADIUS,
    REMEMBERED,
    TOTAL_FORCE,
    TOTAL_TORQUE,
    TOUCHED,
    VELOCITY,
    three,
)
from minidem.kernels.contact.single import ARM, WALL_SPEED, pair_actions, wall_actions
from minidem.kernels.models import EASO, FRICTION, STATIC_FRICTION
from minidem.kernels.scene import Bodies
from minidem.kernels.tables import Control, Particles
from minidem.record import record
from minidem.world.state import Bools, Floats, Ints
from minidem.world.values.seen import Seen
from minidem.world.world import World

__all__ = ["Actions", "mesh_contacts", "neighbours", "pair_contacts"]

# a sliding contact keeps the spring force at which it slides; rounding must not make it hold
_SLIDES = 1.0 - 1.0e-10
_NOTHING = 1.0e-12  # of a force: its normal part, as it is rounded


@record(frozen=True)
class Actions:
    """Contacts and what they do, n of them.

    Attributes
    ----------
    who : ndarray of int64, shape (n, 2)
        Row of the particle, and that of the other one or the triangle.
    force, torque : ndarray, shape (n, 3)
        On the particle, N and N m.
    arm : ndarray, shape (n, 3)
        From the other, or the nearest point of the wall, to the particle, m.
    memory : ndarray, shape (n, 13)
        Histories, see `minidem.kernels.columns`.
    speed : ndarray, shape (n, 3)
        Velocity of the wall, m/s; 0 for pairs.
    across : ndarray of bool, shape (n,)
        Whether the contact is through a periodic face.
    """

    who: Ints
    force: Floats
    torque: Floats
    arm: Floats
    memory: Floats
    speed: Floats
    across: NDArray[np.bool_]

    def chosen(self, keep: NDArray[np.bool_]) -> Actions:
        """Return some of the contacts."""
        return Actions(
            self.who[keep], self.force[keep], self.torque[keep], self.arm[keep],
            self.memory[keep], self.speed[keep], self.across[keep],
        )  # fmt: skip


def neighbours(world: World) -> tuple[Ints, Floats, NDArray[np.bool_]]:
    """Return the pairs of the neighbour list.

    Returns
    -------
    ndarray of int64, shape (n, 2)
        Rows of the particles, in the order in which LIGGGHTS would number the two: by place in
        the output, through a periodic face the higher id first.
    ndarray, shape (n, 3)
        From the second to the first, m.
    ndarray of bool, shape (n,)
        Whether they meet through a periodic face.
    """
    who, arm, across, _ = _listed(world, None)
    return who, arm, across


def _listed(world: World, seen: Seen | None) -> tuple[Ints, Floats, NDArray[np.bool_], Ints]:
    """Return what `neighbours` does, and the entry of each pair, -1 - entry if it is turned."""
    state, pairs = world.state, world.lists.pairs
    n = state.n
    if world.law is None or world.lists.before != n:
        return (
            np.zeros((0, 2), np.int64),
            np.zeros((0, 3)),
            np.zeros(0, bool),
            np.zeros(0, np.int64),
        )
    used = int(pairs.start[n])
    one = np.repeat(np.arange(n), np.diff(pairs.start[: n + 1]))
    other = pairs.other[:used].astype(np.int64)
    row, real = state.row if seen is None else seen.row, world.law[0].real
    period, inverse = real[three(LENGTH)], real[three(INVERSE)]
    if seen is not None:
        period, inverse = seen.period, seen.inverse
    arm = row[one, POSITION] - row[other, POSITION]
    turns = np.rint(arm * inverse)
    arm -= period * turns
    across = (turns != 0.0).any(axis=1)
    order, ids = state.rank, state.ids
    swapped = np.where(across, ids[one] < ids[other], order[one] > order[other])
    who = np.where(swapped[:, None], np.stack([other, one], 1), np.stack([one, other], 1))
    entry = np.arange(used)
    return who, np.where(swapped[:, None], -arm, arm), across, np.where(swapped, -1 - entry, entry)


def pair_contacts(world: World, *, in_step: bool = False) -> Actions:
    """Return the pairs in contact, or joined by a bridge, sorted by their places in the output.

    Parameters
    ----------
    world : World
        Between two steps of a run.
    in_step : bool
        As the contacts were in the step that has just ended, where velocities are those of the
        middle of the step; else with the velocities of its end, as computes of LIGGGHTS have it.
    """
    seen = _seen(world) if in_step else None
    who, arm, across, entry = _listed(world, seen)
    row = world.state.row if seen is None else seen.row
    both = row[who[:, PARTICLE], RADIUS] + row[who[:, TOUCHED], RADIUS]
    square = (arm * arm).sum(axis=1)
    chosen = (square < both * both) | _may_be_bridged(world, square, both, entry)
    who, across, entry = who[chosen], across[chosen], entry[chosen]
    order = np.lexsort((world.state.rank[who[:, TOUCHED]], world.state.rank[who[:, PARTICLE]]))
    who, across, entry = np.ascontiguousarray(who[order]), across[order], entry[order]
    memory = np.zeros((len(who), REMEMBERED))
    out = np.zeros((len(who), WALL_SPEED))
    if world.law is not None and len(who):
        at = np.where(entry < 0, -1 - entry, entry)
        hist = world.lists.pairs.hist[at]
        memory[:, : hist.shape[1]] = hist
        memory[entry < 0, :IMPACT] *= -1.0
        pair_actions(_bodies(world, world.law, in_step=in_step), who, memory, out)
        if in_step and _has_stepped(world):
            out[_unpressed(out), :ARM] = 0.0
    return Actions(
        who, out[:, TOTAL_FORCE], out[:, TOTAL_TORQUE], out[:, ARM:], memory,
        np.zeros((len(who), 3)), across,
    ).chosen(~np.isnan(out[:, FX]))  # fmt: skip


def _seen(world: World) -> Seen | None:
    """Return what the forces of the step that has just ended saw, None if it was not kept."""
    seen: Seen | None = world.seen
    state = world.state
    if seen is None or seen.step != world.step or not _has_stepped(world):
        return None
    return seen if np.array_equal(seen.ids, state.ids[: state.n]) else None


def _has_stepped(world: World) -> bool:
    """Tell whether forces are those of a step, not of the set-up of a run."""
    return world.set_up_at != world.step


def _unpressed(out: Floats) -> Bools:
    """Return which pairs press with no force, so that friction in the step was nothing.

    ``limitForce`` cuts an attractive force to zero, and with it the spring: then no spring is there
    to slide, and the damping beside it would act alone.
    """
    force, arm = out[:, TOTAL_FORCE], out[:, ARM:WALL_SPEED]
    normal = (force * arm).sum(axis=1)
    size = np.linalg.norm(force, axis=1) * np.linalg.norm(arm, axis=1)
    found: Bools = np.abs(normal) < _NOTHING * size
    return found


def _may_be_bridged(world: World, square: Floats, both: Floats, entry: Ints) -> Bools:
    """Return which pairs may have a liquid bridge between them."""
    cohesion = world.pair.switches[COHESION] if world.pair.switches is not None else 0
    if cohesion < EASO:
        return np.zeros(len(entry), bool)
    rows = np.where(entry < 0, -1 - entry, entry)
    touch = world.lists.pairs.touch[rows]
    reach = world.neighbor.reach * both
    near: Bools = (square < reach * reach) & ((touch != 0) | (cohesion != EASO))
    return near


def mesh_contacts(world: World, meshes: tuple[str, ...]) -> Actions:
    """Return the contacts with some meshes, mesh after mesh and triangle after triangle."""
    state, walls, store = world.state, world.lists.walls, world.meshes
    n = state.n
    if world.law is None or world.lists.before != n:
        n = 0
    used = int(walls.start[n]) if n else 0
    code = walls.code[:used].astype(np.int64)
    one = np.repeat(np.arange(n), np.diff(walls.start[: n + 1])) if n else np.zeros(0, np.int64)
    entry = np.flatnonzero((code >= 0) & (walls.touch[:used] != 0))
    places = np.full(len(store.names), -1)
    for place, name in enumerate(meshes):
        places[store.names.index(name)] = place
    owner = store.table.owner[code[entry]]
    entry = entry[places[owner] >= 0]
    who = np.stack([one[entry], code[entry]], axis=1)
    triangle = store.table.base[who[:, TOUCHED]]
    place = places[store.table.owner[triangle]]
    order = np.lexsort((state.rank[who[:, PARTICLE]], triangle, place))
    who, entry = np.ascontiguousarray(who[order]), entry[order]
    out = np.zeros((len(who), WALL_SPEED + 3))
    memory = np.ascontiguousarray(walls.hist[entry])
    if world.law is not None and len(who):
        bodies = _bodies(world, world.law)
        wall_actions(bodies, walls._replace(hist=memory), store.table, who, out)
    near = (out[:, ARM:WALL_SPEED] ** 2).sum(axis=1) <= state.row[who[:, PARTICLE], RADIUS] ** 2
    who[:, TOUCHED] = store.table.base[who[:, TOUCHED]]
    return Actions(
        who[near], out[near, TOTAL_FORCE], out[near, TOTAL_TORQUE], out[near, ARM:WALL_SPEED],
        memory[near], out[near, WALL_SPEED:], np.zeros(int(near.sum()), bool),
    )  # fmt: skip


def _bodies(world: World, law: tuple[Control, Floats], *, in_step: bool = False) -> Bodies:
    """Return what kernels need of particles; forces are not those of the world."""
    control, coefficients = law
    state = world.state
    parts = state.table()._replace(force=np.zeros((len(state.force), FORCE)))
    if in_step and _has_stepped(world):
        seen = _seen(world)
        if seen is None:
            parts = _half_a_step_back(world, control, parts)
        else:
            parts = parts._replace(row=seen.row.copy(), spin=seen.spin.copy())
            control = control._replace(real=control.real.copy())
            control.real[three(LENGTH)], control.real[three(INVERSE)] = seen.period, seen.inverse
        coefficients = coefficients.copy()
        coefficients[:, (FRICTION, STATIC_FRICTION)] *= _SLIDES
    return Bodies(control, parts, coefficients)


def _half_a_step_back(world: World, control: Control, parts: Particles) -> Particles:
    """Return particles without the second half kick: nothing else of the step is known."""
    state, nve = world.state, int(control.whole[INTEGRATED])
    row, spin = parts.row.copy(), parts.spin.copy()
    who = np.flatnonzero((state.mask[: state.n] & nve) != 0)
    force = state.force[who]
    row[who, VELOCITY] -= force[:, HALF_KICK, None] * force[:, TOTAL_FORCE]
    spin[who, OMEGA] -= force[:, HALF_TURN, None] * force[:, TOTAL_TORQUE]
    return parts._replace(row=row, spin=spin)
