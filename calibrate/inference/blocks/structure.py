"""Blocks of a problem that are independent of each other once a few common unknowns are given.

Materials have their own unknowns; what joins them are the means and spreads of ties, errors that
readings share, and what is one for all. Given these, each material is a problem of its own.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from calibrate.arrays import Array
from calibrate.inference.priors import Prior
from calibrate.inference.problem import Known, Place, Problem, Reading, Source
from calibrate.inference.space import Space, Unknown

__all__ = ["Block", "Split", "split"]


@dataclass(frozen=True, eq=False)
class Block:
    """A problem of its own, given the common unknowns.

    Attributes
    ----------
    problem : Problem
        Its unknowns, own ones first, then the common ones that act here. There are no ties: a
        tied unknown is flat over its range.
    own, shared : (d,), (e,) int
        Their columns in the whole problem.
    ties : (d,) int
        Column of the mean of the tie of each own unknown (its spread is the next), -1 without.
    """

    problem: Problem
    own: Array
    shared: Array
    ties: Array


@dataclass(frozen=True, eq=False)
class Split:
    """A problem cut into blocks.

    Attributes
    ----------
    problem : Problem
        The whole.
    common : (g,) int
        Columns of what the blocks have in common, mean and spread of every tie among them.
    blocks : tuple of Block
    free : (f,) int
        Columns that no data see but by their ties.
    rest : Problem
        What was measured of common unknowns alone.
    """

    problem: Problem
    common: Array
    blocks: tuple[Block, ...]
    free: Array
    rest: Problem


def split(problem: Problem) -> Split | None:
    """Cut a problem so that few unknowns are common and no block is large; None if that fails.

    Means and spreads of ties are common; so becomes what touches most other unknowns, one after
    another, as long as it makes the common unknowns and the largest block together fewer.
    """
    count = len(problem.space.unknowns)
    touching = np.zeros((count, count), dtype=bool)
    for place in problem.places:
        touching[np.ix_(place.indices, place.indices)] = True
    np.fill_diagonal(touching, val=False)
    common: list[int] = []
    most, best = problem.space.size, None
    while len(common) < count:
        _, label = _components(touching, common)
        size = len(common) + 2 * len(problem.space.ties) + int(np.bincount(label[label >= 0]).max())
        if size < most:
            most, best = size, (list(common), label)
        degree = touching.sum(axis=1)
        degree[common] = -1
        hub = int(np.argmax(degree))
        common.append(hub)
        touching[hub] = touching[:, hub] = False
    return _cut(problem, *best) if best else None


def _components(touching: Array, common: list[int]) -> tuple[int, Array]:
    """Return how many components there are, and that of every unknown; -1 for common ones."""
    number, label = connected_components(coo_matrix(touching), directed=False)
    label = label.copy()
    label[common] = -1
    return number, label


def _cut(problem: Problem, common: list[int], label: Array) -> Split | None:
    """Return the split by components; None if fewer than two of them have data."""
    space, count = problem.space, len(problem.space.unknowns)
    tie_of = np.full(count, -1)
    for number, tie in enumerate(space.ties):
        tie_of[list(tie.members)] = count + 2 * number
    blocks, free = [], []
    inside = set(common)
    for component in sorted({*label[label >= 0].tolist()}):
        own = np.flatnonzero(label == component)
        places = [p for p in problem.places if not inside.issuperset(p.indices)]
        places = [p for p in places if set(own.tolist()) & set(p.indices)]
        known = [k for k in problem.known if k.index in own]
        if places or known:
            blocks.append(_block(space, own, tie_of, places, known))
        else:
            free += own.tolist()
    alone = tuple(p for p in problem.places if inside.issuperset(p.indices))
    hyper = range(count, space.size)
    of_common = tuple(k for k in problem.known if k.index in inside or k.index >= count)
    if len(blocks) < 2:
        return None
    return Split(
        problem,
        np.array(sorted([*common, *hyper]), dtype=int),
        tuple(blocks),
        np.array(free, dtype=int),
        Problem(space, alone, of_common),
    )


def _block(
    space: Space, own: Array, tie_of: Array, places: list[Place], known: list[Known]
) -> Block:
    used = {i for place in places for i in place.indices}
    shared = np.array(sorted(used - set(own.tolist())), dtype=int)
    columns = [*own.tolist(), *shared.tolist()]
    at = {column: k for k, column in enumerate(columns)}
    unknowns = tuple(_alone(space.unknowns[i], tied=bool(tie_of[i] >= 0)) for i in columns)
    moved = tuple(_moved(place, at) for place in places)
    mine = tuple(replace(one, index=at[one.index]) for one in known)
    return Block(Problem(Space(unknowns), moved, mine), own, shared, tie_of[own])


def _alone(unknown: Unknown, *, tied: bool) -> Unknown:
    """Return an unknown without its tie."""
    if not tied:
        return unknown
    prior = unknown.prior
    return replace(unknown, prior=Prior.uniform(prior.low, prior.high, prior.spacing))


def _moved(place: Place, at: dict[int, int]) -> Place:
    """Return a place whose unknowns stand in other columns."""

    def source(one: Source) -> Source:
        return one if one.index is None else replace(one, index=at[one.index])

    def reading(one: Reading) -> Reading:
        return replace(one, shared=tuple((at[i], loading) for i, loading in one.shared))

    return replace(
        place,
        u=tuple(source(one) for one in place.u),
        strengths=tuple(source(one) for one in place.strengths),
        readings=tuple(reading(one) for one in place.readings),
    )
