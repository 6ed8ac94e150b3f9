"""The verdict: nothing, one name, the smallest set that holds the cause, or unknown.

A cause is named where the probability that it acts is above 0.95, two where each has more than 0.9
(and 0.75 on average over imagined other runs), evidence as large as the largest comes in less than
3 % of imagined studies without any cause, and data as far from the model as these are not rare if
it is the cause (p > 0.05). Else the smallest set of which one acts with 95 % is given, if "none"
could not be it; that the cause may also be in no library is said where it is so. Where "none" is
improbable and nothing of that holds, it is unknown what is wrong.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

import numpy as np
import pandas as pd

from calibrate.arrays import Array
from calibrate.causes.judging.levels import Levels
from calibrate.causes.judging.probabilities import Answers, inclusion_of
from calibrate.causes.judging.straight import Straight
from calibrate.causes.weighing.effects import added_by
from calibrate.causes.weighing.evidences import Evidences
from calibrate.causes.weighing.tangent import Tangent, tangent_at

__all__ = [
    "Chances",
    "Verdict",
    "chances_of",
    "heaviest_tangent",
    "judge",
    "smallest_set",
    "sure_of",
]

Kind: TypeAlias = Literal["none", "named", "set", "unknown"]


@dataclass(frozen=True)
class Chances:
    """What imagined studies say.

    Attributes
    ----------
    p_misfit : float
        Chance of data as far from the base model as these if it is right.
    p_best : float
        Chance that the best candidate gains this much if the base model is right.
    threshold : float
        Log evidence ratio that chance reaches at the chosen level.
    p_explained : dict of tuple to float
        By members of leading hypotheses: chance of data as far from them if they are right.
    lasting : dict of tuple to float
        By members: how probable leading hypotheses are on average over other runs, see
        `calibrate.causes.sway.lasting`; empty where nothing is sure.
    """

    p_misfit: float
    p_best: float
    threshold: float
    p_explained: dict[tuple[str, ...], float]
    lasting: dict[tuple[str, ...], float] = field(default_factory=dict)


@dataclass(frozen=True)
class Verdict:
    """What the data say.

    Attributes
    ----------
    kind : str
        ``none``, ``named``, ``set`` or ``unknown``.
    names : tuple of str
        The named cause, or both of a pair; the causes of a set, the most probable first.
    answers : Answers
        Probabilities.
    chances : Chances
    reason : str
        One sentence.
    """

    kind: Kind
    names: tuple[str, ...]
    answers: Answers
    chances: Chances
    reason: str

    @property
    def leading(self) -> tuple[str, ...]:
        """Members of the hypothesis that a name stands for; the best cause of a set."""
        return self.names if self.kind == "named" else self.names[:1]

    def table(self) -> pd.DataFrame:
        """Return a row for every answer with its probability, the most probable first."""
        rows = dict(self.answers.single)
        rows |= {" and ".join(pair): p for pair, p in self.answers.pairs.items()}
        return pd.Series(rows, name="probability").rename_axis("cause").to_frame()


def heaviest_tangent(found: Evidences, names: tuple[str, ...]) -> tuple[Tangent, Array]:
    """Return the bench, straight around the best draw of a hypothesis, and its strengths."""
    one = found.weighed[names]
    # Weight times the density it was drawn with is the posterior; a draw of a thin region has both.
    height = one.log_weight + found.cloud.log_drawn
    at = int(np.argmax(height))
    return tangent_at(found.board.problem, found.cloud.z[at]), one.strengths[at]


def chances_of(
    found: Evidences, straight: Straight, leading: list[tuple[str, ...]], levels: Levels, seed: int
) -> Chances:
    """Imagine studies without causes and with the leading ones, and compare the real one.

    Parameters
    ----------
    found : Evidences
    straight : Straight
        Around the best values of the base model.
    leading : list of tuple of str
        Hypotheses whose own misfit is tested.
    levels : Levels
    seed : int
    """
    rng = np.random.default_rng([seed, 1])
    nulls = straight.imagine(levels.studies, rng)
    best = straight.log_ratios(nulls).max(axis=1, initial=-np.inf)
    singles = [found.weighed[n].log_evidence for n in found.weighed if n in _candidates(found)]
    ratio = max(singles, default=-np.inf) - found.base.log_evidence
    explained = {n: _misfit(found, n, levels.studies, rng) for n in leading}
    return Chances(
        _misfit(found, (), levels.studies, rng),
        _tail(best, ratio),
        float(np.quantile(best, 1.0 - levels.chance)) if singles else float("inf"),
        explained,
    )


def _candidates(found: Evidences) -> set[tuple[str, ...]]:
    return {(one.name,) for one in found.board.candidates}


def _misfit(
    found: Evidences, names: tuple[str, ...], studies: int, rng: np.random.Generator
) -> float:
    """Return the chance of data as far from a hypothesis as these, its unknowns fitted."""
    tangent, strengths = heaviest_tangent(found, names)
    board = found.board
    left, slopes, spread = tangent.left.copy(), [tangent.slopes], np.ones(len(tangent.left))
    for one, x in zip(board.members(names), strengths, strict=True):
        added = added_by(tangent.bench, one)
        a, c = tangent.stacked(added)
        for k, grown in added.doubts.items():
            spread[tangent.spans[k]] += x**2 * grown[0]
        prior = board.strength_prior(one)
        left -= x * (a + x * c)
        slopes.append((0.0 if prior.fixed else prior.width) * (a + 2.0 * x * c)[:, None])
    # In errors that count how well the answers to the causes are known.
    root = np.sqrt(spread)
    left /= root
    together = np.column_stack(slopes) / root[:, None]
    covariance = np.eye(len(left)) + together @ together.T
    # What a fit leaves of y is K^-1 y; its length is compared with that of imagined studies.
    prior_part = np.concatenate([tangent.z, np.zeros(together.shape[1] - len(tangent.z))])
    y = left + together @ prior_part
    inverse = np.linalg.inv(covariance)
    imagined = rng.standard_normal((studies, len(left))) @ np.linalg.cholesky(covariance).T
    here = float(np.sum((inverse @ y) ** 2))
    return _tail(np.sum((imagined @ inverse) ** 2, axis=1), here)


def _tail(draws: Array, value: float) -> float:
    """Return the chance of at least `value`, never zero: the observed case counts as one draw."""
    return float((1 + np.sum(draws >= value)) / (1 + len(draws)))


def judge(answers: Answers, chances: Chances, levels: Levels, unknowns: int = 0) -> Verdict:
    """Reach the verdict.

    Parameters
    ----------
    answers : Answers
    chances : Chances
        Its tested hypotheses must contain the leading one and the leading pair.
    levels : Levels
    unknowns : int
        Of the base model; with more than `levels.unknowns` nothing is said of causes.
    """
    kind, names, reason = _decided(answers, chances, levels)
    if unknowns > levels.unknowns:
        kind, names = "unknown", ()
        reason = (
            f"{unknowns} unknowns are more than the {levels.unknowns} among which the best values "
            "are found; diagnose fewer materials, or hold parameters that are known"
        )
    return Verdict(kind, names, answers, chances, reason)


def sure_of(answers: Answers, levels: Levels) -> tuple[str, ...]:
    """Return the causes that are as probable as a name has to be, alone or two side by side."""
    together = tuple(name for name, p in answers.inclusion.items() if p > levels.both)
    if len(together) > 1:
        return together
    return tuple(name for name in together if answers.inclusion[name] > levels.name)


def _decided(
    answers: Answers, chances: Chances, levels: Levels
) -> tuple[Kind, tuple[str, ...], str]:
    """Return kind, names and reason."""
    sure = sure_of(answers, levels)
    if sure and chances.p_best < levels.chance:
        # A cause that acts with a second one need not explain the data alone.
        tested = [p for names, p in chances.p_explained.items() if set(sure) <= set(names)]
        p = max(tested, default=0.0)
        if p <= levels.explained:
            words = " and ".join(sure)
            return "unknown", (), f"{words} leaves a misfit that it cannot explain (p = {p:.3f})"
        lasting = inclusion_of(chances.lasting)
        if any(share <= levels.lasting for name, share in lasting.items() if name in sure):
            rivals = smallest_set(chances.lasting, levels.credible)
            return "set", rivals, "from other runs another of these might be named"
        words = ", ".join(
            f"{name} acts with probability {answers.inclusion[name]:.2f}" for name in sure
        )
        return "named", sure, words
    if answers.unknown > levels.unknown:
        return (
            "unknown",
            (),
            f"no cause of the library fits as well as one that is in none ({answers.unknown:.2f})",
        )
    if chances.p_best < levels.chance and answers.none < levels.other:
        if (p := max(chances.p_explained.values())) <= levels.explained:
            return (
                "unknown",
                (),
                f"every cause leaves a misfit that it cannot explain (p = {p:.3f})",
            )
        return (
            "set",
            smallest_set(answers.causes, levels.credible),
            "the data do not tell these causes apart",
        )
    if chances.p_misfit <= levels.misfit:
        why = f"more than chance (p = {chances.p_misfit:.3f}), but no cause is established"
        return "unknown", (), why
    if answers.none < levels.doubt:
        return "unknown", (), _doubtful(answers)
    return "none", (), "errors explain the misfit as well as any cause does"


def _doubtful(answers: Answers) -> str:
    """Say that something is wrong, and what leads."""
    words = f"something is likely wrong ({1.0 - answers.none:.2f}), but the data do not tell what"
    if not answers.inclusion:
        return words
    name, p = max(answers.inclusion.items(), key=lambda pair: pair[1])
    return f"{words}; {name} leads with {p:.2f}"


def smallest_set(shares: Mapping[tuple[str, ...], float], level: float) -> tuple[str, ...]:
    """Return few causes of which one acts with the probability that is asked for.

    The cause that adds most comes next, so that the other one of a pair is not listed for what its
    partner holds already.

    Parameters
    ----------
    shares : mapping
        Names of the causes that act together to the probability that they do.
    level : float
        Part of all that is shared.
    """
    left, found = dict(shares), list[str]()
    most = (1.0 - level) * sum(left.values())
    while left and sum(left.values()) > most:
        found.append(next(iter(inclusion_of(left))))
        left = {names: share for names, share in left.items() if found[-1] not in names}
    return tuple(found)
