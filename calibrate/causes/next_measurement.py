"""What to measure next: how much each feasible measurement is expected to tell of the cause.

What measures a cause or an unknown directly is weighed here. What a further experiment would give,
nobody can say without running it: `calibrate.causes.studies.further` does.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.candidates import Board, Candidate
from calibrate.causes.information import Expected, entropy, information, shares_after
from calibrate.causes.judging.probabilities import NONE, UNKNOWN, Answers
from calibrate.causes.offers import (
    APART,
    Feasible,
    Names,
    Offer,
    Outcome,
    Prospect,
    outcomes_of,
    ranked,
)
from calibrate.causes.weighing.evidences import Evidences

__all__ = ["answer_shares", "measured_causes", "prospect"]

LITTLE: Final = 1e-4
"""Probability below which an answer is left out."""
RARE: Final = 1e-3
"""Share of a sign below which it is left out."""


def measured_causes(board: Board) -> tuple[Feasible, ...]:
    """Return the independent measurement of every cause, one for each place where it differs.

    Parameters
    ----------
    board : Board
    """
    found: dict[str, list[Candidate]] = {}
    for one in board.candidates:
        found.setdefault(one.effect, []).append(one)
    return tuple(
        Feasible(
            one.name,
            one.settled_by or f"measure {one.name}",
            one.unit,
            one.settled_se,
            one.settled_hours,
            effect,
            frozenset(k for k, _ in one.acts),
        )
        for effect, listed in found.items()
        for one in ([c for c in listed if c.name != effect] or listed)
        if one.settled_se > 0.0
    )


def prospect(found: Evidences, answers: Answers, more: Sequence[Feasible] = ()) -> Prospect:
    """Return what the feasible measurements are worth.

    Those that were made already, as well or better, are left out.

    Parameters
    ----------
    found : Evidences
    answers : Answers
    more : sequence of Feasible
        Besides those of `measured_causes`.
    """
    shares = answer_shares(answers)
    offers = []
    for one in (*measured_causes(found.board), *more):
        if not _made(found.board, one):
            expected = [_expected(found, answers, names, one) for names in shares]
            told = information(list(shares.values()), expected)
            offers.append(Offer(one, told, _outcomes(shares, expected)))
    return Prospect(entropy(list(shares.values())), ranked(offers))


def answer_shares(answers: Answers) -> dict[Names, float]:
    """Return the probabilities of the answers that matter, the largest first; their sum is 1."""
    shares: dict[Names, float] = {(): answers.none, (UNKNOWN,): answers.unknown}
    shares |= {(n,): p for n, p in answers.single.items() if n not in (NONE, UNKNOWN)}
    shares |= {(a, b): p for (a, b), p in answers.pairs.items()}
    kept = {names: p for names, p in shares.items() if p > LITTLE}
    total = sum(kept.values())
    ordered = sorted(kept.items(), key=lambda one: -one[1])
    return {names: p / total for names, p in ordered}


def _made(board: Board, one: Feasible) -> bool:
    """Whether a measurement was made already, as well or better."""
    if one.unknown:
        index = board.problem.space.index(one.unknown)
        return any(known.index == index and known.se <= one.se for known in board.problem.known)
    return any(
        known.se <= one.se and (known.places is None or one.places <= known.places)
        for known in board.known.get(one.effect, ())
    )


def _expected(found: Evidences, answers: Answers, names: Names, one: Feasible) -> Expected:
    """Return the result that an answer expects."""
    if one.unknown:
        column = found.cloud.bench.points[:, found.board.problem.space.index(one.unknown)]
        slabs = {(slab,): p for slab, p in answers.where.items() if p > 0.0}
        own = slabs if names == (UNKNOWN,) else {names: 1.0}
        return Expected(
            tuple(
                (p / sum(own.values()), *_normal(column, found.weighed[key].weights, one.se))
                for key, p in own.items()
            )
        )
    members = () if names == (UNKNOWN,) else found.board.members(names)
    for k, member in enumerate(members):
        if one.measures(member):
            weighed = found.weighed[names]
            return _by_sign(weighed.strengths[:, k] * member.scale, weighed.weights, one.se)
    return Expected(((1.0, 0.0, one.se),))


def _by_sign(x: Array, weights: Array, se: float) -> Expected:
    """Return a strength as it is measured: a normal for each sign, since none is near zero."""
    parts = []
    for side in (x < 0.0, x >= 0.0):
        share = float(weights[side].sum())
        if share > RARE:
            parts.append((share, *_normal(x[side], weights[side] / share, se)))
    total = sum(share for share, _, _ in parts)
    return Expected(tuple((share / total, mean, sd) for share, mean, sd in parts))


def _normal(x: Array, weights: Array, se: float) -> tuple[float, float]:
    """Return mean and standard deviation of a number that is measured with an error."""
    mean = float(weights @ x)
    return mean, float(np.sqrt(weights @ (x - mean) ** 2 + se**2))


def _outcomes(shares: Mapping[Names, float], expected: Sequence[Expected]) -> tuple[Outcome, ...]:
    """Return the results that leading answers expect, as far as they differ."""
    normals = [one.likeliest for one in expected]

    def apart(one: int, other: int) -> bool:
        (mean, sd), (told, vague) = normals[one], normals[other]
        return abs(mean - told) > APART * max(sd, vague)

    def after(one: int) -> Array:
        return shares_after(normals[one][0], list(shares.values()), expected)

    return outcomes_of(shares, [(mean,) for mean, _ in normals], apart, after)
