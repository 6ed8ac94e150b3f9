"""What to measure next: how much each feasible measurement is expected to tell of the cause.

Only what measures a cause or an unknown directly: what a further experiment would give, nobody
can say without running it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.candidates import Board, Candidate
from calibrate.causes.information import Expected, entropy, information, shares_after
from calibrate.causes.judging.probabilities import NONE, UNKNOWN, Answers
from calibrate.causes.weighing.evidences import Evidences

__all__ = ["Feasible", "Offer", "Outcome", "Prospect", "measured_causes", "prospect"]

Names: TypeAlias = tuple[str, ...]

LITTLE: Final = 1e-4
"""Probability below which an answer is left out."""
LEAST: Final = 0.05
"""Nats below which a measurement tells nothing worth an hour."""
SHOWN: Final = 3
"""Results of a measurement, and answers after each, that are told."""
NOTICED: Final = 0.01
"""Probability from which the result that an answer expects is told."""
APART: Final = 1.0
"""Standard deviations, of the vaguer one, by which results differ that are told side by side."""
SAID: Final = 0.02
"""Probability after a result from which an answer is told, besides the first."""
RARE: Final = 1e-3
"""Share of a sign below which it is left out."""


@dataclass(frozen=True)
class Feasible:
    """A measurement that a laboratory could make of one number.

    Attributes
    ----------
    name : str
        As a candidate or a parameter is called; with ":" and where, if it differs between places.
    words : str
        What is done.
    unit : str
    se : float
        Standard error of the result, in the unit.
    hours : float
        Hours that it takes.
    effect : str
        Effect whose strength is measured, empty for an unknown of the base model.
    places : frozenset of int
        Places where a cause of that effect must act for the result to be its strength.
    unknown : str
        Name of the unknown that is measured.
    """

    name: str
    words: str
    unit: str
    se: float
    hours: float
    effect: str = ""
    places: frozenset[int] = frozenset()
    unknown: str = ""

    def measures(self, one: Candidate) -> bool:
        """Whether the result is the strength of a candidate."""
        return one.effect == self.effect and any(k in self.places for k, _ in one.acts)


@dataclass(frozen=True)
class Outcome:
    """What a result would mean.

    Attributes
    ----------
    value : float
        In the unit of what is measured.
    probability : dict of str to float
        Of the answers that lead after it.
    """

    value: float
    probability: dict[str, float]


@dataclass(frozen=True)
class Offer:
    """A measurement and what it is worth.

    Attributes
    ----------
    measurement : Feasible
    information : float
        Expected information on which answer holds, nats.
    outcomes : tuple of Outcome
        Of the results that leading answers expect.
    """

    measurement: Feasible
    information: float
    outcomes: tuple[Outcome, ...]

    @property
    def per_hour(self) -> float:
        """Information over effort, nats per hour."""
        return self.information / self.measurement.hours


@dataclass(frozen=True)
class Prospect:
    """What measurements could still tell.

    Attributes
    ----------
    entropy : float
        How open it is which answer holds, nats: more nothing can tell.
    offers : tuple of Offer
        What tells most per hour first; those that tell next to nothing are left out.
    """

    entropy: float
    offers: tuple[Offer, ...]


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
    shares = _shares(found, answers)
    ranked = []
    for one in (*measured_causes(found.board), *more):
        if not _made(found.board, one):
            expected = [_expected(found, answers, names, one) for names in shares]
            told = information(list(shares.values()), expected)
            if told >= LEAST:
                ranked.append(Offer(one, told, _outcomes(shares, expected)))
    ranked.sort(key=lambda one: -one.per_hour)
    return Prospect(entropy(list(shares.values())), tuple(ranked))


def _shares(found: Evidences, answers: Answers) -> dict[Names, float]:
    """Return the probabilities of the answers that matter, by members; unknown by its name."""
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
    told: list[tuple[float, float]] = []
    for share, one in zip(shares.values(), expected, strict=True):
        mean, sd = one.likeliest
        apart = all(abs(mean - value) > APART * max(sd, other) for value, other in told)
        if share > NOTICED and apart and len(told) < SHOWN:
            told.append((mean, sd))
    words = [" and ".join(names) or NONE for names in shares]
    found = []
    for value, _ in told:
        after = shares_after(value, list(shares.values()), expected)
        best = sorted(zip(words, map(float, after), strict=True), key=lambda one: -one[1])
        lead, *others = best[:SHOWN]
        found.append(Outcome(value, dict([lead, *(one for one in others if one[1] >= SAID)])))
    return tuple(found)
