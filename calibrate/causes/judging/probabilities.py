"""How probable every answer is: none, each cause, each pair, unknown.

Before the data: none one half, a single cause a third, a pair 0.07, unknown 0.1. Causes share
theirs in proportion to the chance that these data would show them, so that one that cannot be seen
takes little from the others; instances of one effect share its part.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final

import numpy as np
from scipy import special

from calibrate.causes.candidates import Board
from calibrate.causes.weighing.evidences import Evidences, without
from calibrate.causes.weighing.unknown import slabs_of

__all__ = ["NONE", "UNKNOWN", "Answers", "answers_of", "inclusion_of", "prior_shares"]

NONE: Final = "none"
UNKNOWN: Final = "unknown"
PRIOR_NONE: Final = 0.5
PRIOR_SINGLE: Final = 0.33
PRIOR_PAIR: Final = 0.07
PRIOR_UNKNOWN: Final = 0.1


@dataclass(frozen=True)
class Answers:
    """Probabilities after the data.

    Attributes
    ----------
    single : dict of str to float
        Of none, every cause alone, unknown.
    pairs : dict of (str, str) to float
        Of pairs that could be seen to matter; those of all others are nothing.
    where : dict of str to float
        Of what is unknown: shares of the slabs.
    doubts : dict of str to float
        What each cause would have more, were the doubts about its answer credited to it.
    """

    single: dict[str, float]
    pairs: dict[tuple[str, str], float]
    where: dict[str, float]
    doubts: dict[str, float] = field(default_factory=dict)

    @property
    def causes(self) -> dict[tuple[str, ...], float]:
        """Probability of every cause alone and of every pair, by the names that act."""
        found: dict[tuple[str, ...], float] = {}
        found.update({(n,): p for n, p in self.single.items() if n not in (NONE, UNKNOWN)})
        found.update(self.pairs.items())
        return found

    @property
    def inclusion(self) -> dict[str, float]:
        """Probability that a cause acts, alone or with another, the most probable first."""
        return inclusion_of(self.causes)

    @property
    def none(self) -> float:
        """Probability that nothing is missing."""
        return self.single[NONE]

    @property
    def unknown(self) -> float:
        """Probability of something that is in no library."""
        return self.single[UNKNOWN]


def inclusion_of(shares: Mapping[tuple[str, ...], float]) -> dict[str, float]:
    """Return the probability that each cause acts, the most probable first.

    Parameters
    ----------
    shares : mapping
        Names of the causes that act together to the probability that they do.
    """
    found: dict[str, float] = {}
    for names, share in shares.items():
        for name in names:
            found[name] = found.get(name, 0.0) + share
    return dict(sorted(found.items(), key=lambda one: -one[1]))


def prior_shares(board: Board, power: Mapping[str, float]) -> dict[str, float]:
    """Return the share of each cause among single causes before the data, sum 1.

    Parameters
    ----------
    board : Board
    power : mapping
        Chance that these data would show it.
    """
    instances: dict[str, int] = {}
    for one in board.candidates:
        instances[one.effect] = instances.get(one.effect, 0) + 1
    raw = {one.name: power[one.name] / instances[one.effect] for one in board.candidates}
    total = sum(raw.values())
    return {name: one / total for name, one in raw.items()} if total else raw


def answers_of(found: Evidences, power: Mapping[str, float]) -> Answers:
    """Return how probable every answer is.

    Parameters
    ----------
    found : Evidences
    power : mapping
        Chance of every cause that these data would show it.
    """
    board = found.board
    shares = prior_shares(board, power)
    known = {one.name for one in board.candidates}
    logs: dict[tuple[str, ...], float] = {(): math.log(PRIOR_NONE) + found.base.log_evidence}
    slabs = [n for n in found.weighed if len(n) == 1 and n[0] not in known]
    pairs = [n for n in found.weighed if len(n) == 2]
    whole = _pair_total(board, shares)
    for names, one in found.weighed.items():
        if len(names) == 1 and names[0] in known:
            logs[names] = math.log(PRIOR_SINGLE * shares[names[0]]) + one.log_evidence
        elif len(names) == 2:
            share = shares[names[0]] * shares[names[1]] / whole
            logs[names] = math.log(PRIOR_PAIR * share) + one.log_evidence
        elif names in slabs:
            logs[names] = math.log(PRIOR_UNKNOWN / len(slabs)) + one.log_evidence
    p = dict(zip(logs, map(float, special.softmax(list(logs.values()))), strict=True))
    doubts = _credit(found, p)
    single = {NONE: p[()], **{n[0]: p[n] for n in logs if len(n) == 1 and n[0] in known}}
    single[UNKNOWN] = float(sum(p[n] for n in slabs))
    ordered = dict(sorted(single.items(), key=lambda one: -one[1]))
    where = {n[0]: p[n] / max(single[UNKNOWN], 1e-300) for n in slabs}
    twos = sorted(((n[0], n[1]), p[n]) for n in pairs)
    return Answers(
        ordered,
        dict(sorted(twos, key=lambda one: -one[1])),
        dict(sorted(where.items(), key=lambda one: -one[1])),
        dict(sorted(doubts.items(), key=lambda one: -one[1])),
    )


def _credit(found: Evidences, p: dict[tuple[str, ...], float]) -> dict[str, float]:
    """Give what doubts alone explain to the hypotheses without them, or to what is unknown.

    Of the evidence of a hypothesis, with E its logarithm, exp(D - E) is what the doubt about a
    member's answer would reach by itself, exp(E0 - E) what is reached without any of that member;
    the difference is evidence of something, and not of this member.

    Parameters
    ----------
    found : Evidences
    p : dict
        Probability of every hypothesis; changed, its sum stays.

    Returns
    -------
    dict of str to float
        What each cause loses.
    """
    lost: dict[str, float] = {}
    for names, doubts in found.doubts.items():
        own = found.weighed[names].log_evidence
        parts = []
        for rest, doubt in zip(without(names), doubts, strict=True):
            less = found.weighed[rest].log_evidence
            parts.append(max(math.exp(min(doubt - own, 0.0)) - math.exp(less - own), 0.0))
        scale = p[names] / max(sum(parts), 1.0)
        for name, rest, part in zip(names, without(names), parts, strict=True):
            heir = rest or (_slab_around(found.board, name),)
            p[heir] += scale * part
            p[names] -= scale * part
            lost[name] = lost.get(name, 0.0) + scale * part
    return lost


def _slab_around(board: Board, name: str) -> str:
    """Return the smallest slab of all that a cause touches."""
    sizes = [len(place.readings) for place in board.problem.places]
    first = np.cumsum([0, *sizes])
    touched = {
        number
        for k, _ in board.candidate(name).acts
        for number in range(first[k], first[k] + sizes[k])
    }
    around = [one for one in slabs_of(board.problem) if touched <= set(one.readings)]
    return min(around, key=lambda one: len(one.readings)).name


def _pair_total(board: Board, shares: Mapping[str, float]) -> float:
    """Return the sum over all pairs of the products of their shares."""
    names = [one.name for one in board.candidates]
    total = sum(
        shares[a] * shares[b]
        for i, a in enumerate(names)
        for b in names[i + 1 :]
        if board.together(a, b)
    )
    return max(total, float(np.finfo(float).tiny))
