"""The verdict: no cause, one named cause, a set that cannot be told apart, or unknown.

Probabilities come from evidences and priors: one half for nothing, 0.4 shared by the candidates,
the rest shared by shifts of unknown origin. A candidate's share is in proportion to the chance that
these data would show it, so one that cannot be seen takes little from the others; it keeps some,
because sight is judged by straight lines and evidence is not. A cause is named if
its probability is above 0.9, if the best evidence ratio of all candidates is larger than in 97 %
of imagined studies without any of them, and if studies imagined with the cause are often as
improbable as the real one.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

import numpy as np
import pandas as pd
from scipy import special

from calibrate.arrays import Array
from calibrate.causes.bank import bank_of
from calibrate.causes.hypotheses import Board, Weighed
from calibrate.causes.imagined import expected, imagine, observed
from calibrate.causes.visibility import Visibility

__all__ = ["NONE", "UNKNOWN", "Chances", "Levels", "Verdict", "chances_of", "judge"]

Kind: TypeAlias = Literal["none", "named", "group", "unknown"]

NONE: Final = "none"
UNKNOWN: Final = "unknown"
PRIOR_NONE: Final = 0.5
PRIOR_CAUSE: Final = 0.4
"""Shared by all candidates; the rest is for what is in no library."""


@dataclass(frozen=True)
class Levels:
    """Error rates the verdict works to, and the number of imagined studies.

    Attributes
    ----------
    name : float
        Probability above which a cause is named.
    credible : float
        Probability that the set of what is possible holds.
    chance : float
        Chance that a candidate looks so good although nothing is hidden.
    explained : float
        A cause is named only if data as improbable as these are at least this likely with it.
    misfit : float
        Without a cause, a misfit less likely than this is called unknown.
    studies : int
        Imagined studies.
    """

    name: float = 0.9
    credible: float = 0.95
    chance: float = 0.03
    explained: float = 0.05
    misfit: float = 0.01
    studies: int = 200


@dataclass(frozen=True)
class Chances:
    """What imagined studies say.

    Attributes
    ----------
    p_misfit : float
        Chance of data as improbable as these if the base model is right.
    p_best : float
        Chance that the best candidate gains this much if the base model is right.
    threshold : float
        Log evidence ratio that chance reaches at the chosen level; infinite without candidates.
    p_explained : dict of str to float
        Per candidate that was tested: chance of data as improbable as these if it is the cause.
    size : float
        Effective number of draws behind an imagined study, median.
    """

    p_misfit: float
    p_best: float
    threshold: float
    p_explained: dict[str, float]
    size: float


@dataclass(frozen=True)
class Verdict:
    """What the data say.

    Attributes
    ----------
    kind : str
        ``none``, ``named``, ``group`` or ``unknown``.
    names : tuple of str
        The named cause, or the causes that cannot be told apart, the most probable first.
    probabilities : dict of str to float
        Of ``none``, every candidate and ``unknown``; sum 1, the most probable first.
    credible : tuple of str
        Smallest set of them that holds 95 %.
    where : dict of str to float
        Of what is unknown: share of each reading at which it may be.
    chances : Chances
    reason : str
        One sentence.
    """

    kind: Kind
    names: tuple[str, ...]
    probabilities: dict[str, float]
    credible: tuple[str, ...]
    where: dict[str, float]
    chances: Chances
    reason: str

    def table(self) -> pd.DataFrame:
        """Return a row for every answer with its probability, the most probable first."""
        return pd.Series(self.probabilities, name="probability").rename_axis("cause").to_frame()


def probabilities(
    board: Board, weighed: Mapping[tuple[str, ...], Weighed], seen: Visibility
) -> tuple[dict[str, float], dict[str, float]]:
    """Return the probability of every answer, and where what is unknown may be."""
    logs = {NONE: math.log(PRIOR_NONE) + weighed[()].log_evidence}
    whole = sum(one.power for one in seen.candidates)
    for one in seen.candidates:
        share = PRIOR_CAUSE * one.power / whole
        logs[one.candidate] = math.log(share) + weighed[one.candidate,].log_evidence
    rest = 1.0 - PRIOR_NONE - (PRIOR_CAUSE if seen.candidates else 0.0)
    shifts = np.array([weighed[one.name,].log_evidence for one in board.shifts])
    logs[UNKNOWN] = math.log(rest / len(shifts)) + float(special.logsumexp(shifts))
    found = special.softmax(list(logs.values()))
    order = sorted(zip(logs, map(float, found), strict=True), key=lambda pair: -pair[1])
    where = special.softmax(shifts)
    return dict(order), {s.name: float(w) for s, w in zip(board.shifts, where, strict=True)}


def chances_of(
    board: Board,
    weighed: Mapping[tuple[str, ...], Weighed],
    tested: Sequence[str],
    levels: Levels,
    seed: int,
) -> Chances:
    """Imagine studies without and with causes, and weigh all of them as the real one.

    Parameters
    ----------
    board : Board
    weighed : mapping
        Hypotheses by their members' names.
    tested : sequence of str
        Candidates whose own explanation is tested.
    levels : Levels
    seed : int
    """
    base = weighed[()]
    rng = np.random.default_rng([seed, 1])
    nulls = imagine(base.hypothesis, base.samples, levels.studies, rng)
    centre = expected(base.hypothesis, base.best)
    own = bank_of(base.hypothesis, centre, seed, base)
    none = own.log_evidences(nulls)
    best = np.full(levels.studies, -np.inf)
    for one in board.candidates:
        bank = bank_of(board.hypothesis(one.name), centre, seed, base)
        best = np.maximum(best, bank.log_evidences(nulls) - none)
    found = [weighed[one.name,].log_evidence for one in board.candidates]
    ratio = max(found, default=-math.inf) - base.log_evidence
    return Chances(
        p_misfit=_tail(-none, -_here(base)),
        p_best=_tail(best, ratio),
        threshold=float(np.quantile(best, 1.0 - levels.chance)) if found else math.inf,
        p_explained={name: _explained(weighed[name,], levels, seed) for name in tested},
        size=float(np.median(own.sizes(nulls))),
    )


def _here(one: Weighed) -> float:
    """Return the log evidence of the real data without the constant that banks leave out."""
    board = one.hypothesis.board
    errors = [one.se for one in board.problem.known] + [one.se for one in board.known.values()]
    constant = -sum(math.log(se) + 0.5 * math.log(2.0 * math.pi) for se in errors)
    return one.log_evidence - constant


def _explained(one: Weighed, levels: Levels, seed: int) -> float:
    """Return the chance of data as improbable as these if a hypothesis is right."""
    rng = np.random.default_rng([seed, 2])
    studies = imagine(one.hypothesis, one.samples, levels.studies, rng)
    bank = bank_of(one.hypothesis, observed(one.hypothesis), seed, one)
    return _tail(-bank.log_evidences(studies), -_here(one))


def _tail(draws: Array, value: float) -> float:
    """Return the chance of at least `value`, never zero: the observed case counts as one draw."""
    return float((1 + np.sum(draws >= value)) / (1 + len(draws)))


def judge(
    shares: Mapping[str, float], where: Mapping[str, float], chances: Chances, levels: Levels
) -> Verdict:
    """Reach the verdict.

    Parameters
    ----------
    shares, where : mapping of str to float
        From `probabilities`.
    chances : Chances
        Its tested candidates must contain the most probable one.
    levels : Levels
    """
    credible = _smallest(shares, levels.credible)
    causes = [name for name in shares if name not in (NONE, UNKNOWN)]
    best = causes[0] if causes else ""
    kind, names, reason = _decided(shares, credible, best, chances, levels)
    return Verdict(kind, names, dict(shares), credible, dict(where), chances, reason)


def _decided(
    shares: Mapping[str, float],
    credible: tuple[str, ...],
    best: str,
    chances: Chances,
    levels: Levels,
) -> tuple[Kind, tuple[str, ...], str]:
    """Return kind, names and reason."""
    if best and chances.p_best < levels.chance and shares[best] > shares[NONE]:
        p = chances.p_explained[best]
        if p <= levels.explained:
            return UNKNOWN, (), f"{best}, the best candidate, leaves a misfit that it cannot " \
                f"explain (p = {p:.3f})"  # fmt: skip
        if shares[best] > levels.name:
            return "named", (best,), f"{best} has a probability of {shares[best]:.2f}"
        if NONE not in credible and shares[UNKNOWN] < 0.5:
            group = tuple(name for name in credible if name != UNKNOWN)
            return "group", group, "the data do not tell these causes apart"
    if chances.p_misfit <= levels.misfit or shares[UNKNOWN] > levels.name:
        why = f"the misfit is more than chance (p = {chances.p_misfit:.3f}), but no candidate " \
            "is established"  # fmt: skip
        return UNKNOWN, (), why
    return NONE, (), "errors explain the misfit as well as any cause does"


def _smallest(shares: Mapping[str, float], level: float) -> tuple[str, ...]:
    """Return the fewest answers that together hold a probability."""
    found: list[str] = []
    total = 0.0
    for name, share in sorted(shares.items(), key=lambda pair: -pair[1]):
        if total >= level:
            break
        found.append(name)
        total += share
    return tuple(found)
