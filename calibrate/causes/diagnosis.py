"""The diagnosis of one board from end to end: evidences, table, verdict, residuals, gain."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np
import pandas as pd

from calibrate.arrays import Array
from calibrate.causes.candidates import Board
from calibrate.causes.gain import Gain, gain
from calibrate.causes.judging.levels import Levels
from calibrate.causes.judging.probabilities import answers_of
from calibrate.causes.judging.straight import straight_at
from calibrate.causes.judging.verdict import (
    Verdict,
    chances_of,
    heaviest_tangent,
    judge,
    sure_of,
)
from calibrate.causes.judging.visibility import Visibility, visibility
from calibrate.causes.next_measurement import prospect
from calibrate.causes.offers import Feasible, Prospect
from calibrate.causes.residuals import Group, Residual, groups_left_out, residual_table, residuals
from calibrate.causes.strengths.widened import widened
from calibrate.causes.sway import lasting
from calibrate.causes.weighing.evidences import Effort, Evidences
from calibrate.causes.weighing.hypotheses import Weighed
from calibrate.causes.weighing.weigh_all import weigh_all
from calibrate.inference.intervals import Interval, shortest
from calibrate.inference.sampler.importance import take
from calibrate.scales import Scale

__all__ = ["Diagnosis", "Options", "conclude", "diagnose"]

_SEEDS: Final = 2**31
_COLUMNS: Final = ["candidate", "probability", "inclusion", "log_ratio", "error", "strength",
                   "low_95", "high_95"]  # fmt: skip
SAMPLES: Final = 2000
TESTED: Final = 3
"""Leading single causes, and pairs, whose own misfit is tested."""
Progress = Callable[[str, float], None]


@dataclass(frozen=True)
class Options:
    """How much work a diagnosis does.

    Attributes
    ----------
    levels : Levels
    held_out : bool
        Whether to leave readings and places out and infer everything again.
    effort : Effort
    """

    levels: Levels = field(default_factory=Levels)
    held_out: bool = True
    effort: Effort = field(default_factory=Effort)


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """Everything a report needs.

    Attributes
    ----------
    found : Evidences
        All hypotheses after the data.
    visibility : Visibility
    verdict : Verdict
    residuals : tuple of Residual
        Of the base model; empty where nothing was to be left out.
    groups : tuple of Group
        Experiments, materials and walls left out of the base model.
    after : tuple of Residual
        With the leading cause or pair; empty without one.
    gains : tuple of Gain
        Held-out gain of the leading cause or pair; empty without one.
    levels : Levels
    seed : int
    prospect : Prospect
        What to measure next.
    """

    found: Evidences
    visibility: Visibility
    verdict: Verdict
    residuals: tuple[Residual, ...]
    groups: tuple[Group, ...]
    after: tuple[Residual, ...]
    gains: tuple[Gain, ...]
    levels: Levels
    seed: int
    prospect: Prospect

    @property
    def board(self) -> Board:
        """What was asked."""
        return self.found.board

    @property
    def base(self) -> Weighed:
        """The base model after the data."""
        return self.found.base

    @property
    def leading(self) -> tuple[str, ...]:
        """Members of the hypothesis that the verdict stands for, () without one."""
        return _hypothesis(self.found, self.verdict)

    def log_ratio(self, *names: str) -> float:
        """Return the log evidence ratio of a hypothesis against the base model."""
        return self.found.weighed[names].log_evidence - self.base.log_evidence

    def samples(self, names: Sequence[str]) -> tuple[Array, Array]:
        """Return draws of equal weight: values (n, K), and strengths (n, m) in their units."""
        one = self.found.weighed[tuple(names)]
        at = take(one.weights, SAMPLES, np.random.default_rng([self.seed, 6]))
        scales = [c.scale for c in self.board.members(names)]
        return self.found.cloud.bench.points[at], one.strengths[at] * np.array(scales)

    def best(self, names: Sequence[str]) -> tuple[Array, Array]:
        """Return the most probable draw: values (K,), strengths (m,), in units."""
        one = self.found.weighed[tuple(names)]
        at = int(np.argmax(one.log_weight + self.found.cloud.log_drawn))
        scales = np.array([c.scale for c in self.board.members(names)])
        return self.found.cloud.bench.points[at], one.strengths[at] * scales

    def strength(self, name: str, names: Sequence[str] = ()) -> float:
        """Return the median of a cause's strength, alone or with the others of a hypothesis."""
        return float(np.median(self.strengths(name, names)))

    def interval(self, name: str, level: float = 0.95, names: Sequence[str] = ()) -> Interval:
        """Return the interval of a cause's strength, alone or with others, in its unit."""
        one = self.board.candidate(name)
        if one.switch:
            return Interval(one.low, one.high, open_low=False, open_high=False)
        return shortest(self.strengths(name, names), level, one.low, one.high)

    def strengths(self, name: str, names: Sequence[str] = ()) -> Array:
        """Return how strong a cause is as far as the data say, draws of equal weight.

        What is believed before them is about whether a cause acts, and of how strong it then is
        no more than the limits: a strength that is rare but acts would else be told too small.

        Parameters
        ----------
        name : str
        names : sequence of str, optional
            Members of the hypothesis; the cause alone where they are left out.

        Returns
        -------
        (n,) float64
            In its unit; `widened` where nobody has measured it on its own.
        """
        members = tuple(names) or (name,)
        one, k = self.found.weighed[members], members.index(name)
        log = np.zeros(len(one.strengths))
        for member, x in zip(self.board.members(members), one.strengths.T, strict=True):
            log += self.board.strength_prior(member).log_evened(x)
        weights = one.weights * np.exp(log - log.max())
        at = take(weights, SAMPLES, np.random.default_rng([self.seed, 6]))
        cause = self.board.candidate(name)
        drawn = np.asarray(one.strengths[at, k] * cause.scale)
        if self.board.strength_prior(cause).measured:
            return drawn
        return widened(drawn, cause.low, cause.high)

    def table(self) -> pd.DataFrame:
        """Return a row for every candidate, the most probable first.

        Returns
        -------
        DataFrame
            Index ``candidate``; probability alone, inclusion (alone or in a pair), log_ratio with
            its error of computation, strength (median) with the ends of its 95 % interval, then
            the columns of `Visibility.table`.
        """
        answers, rows = self.verdict.answers, []
        for one in self.board.candidates:
            span = self.interval(one.name)
            error = np.hypot(self.found.weighed[one.name,].error, self.base.error)
            rows.append(
                {
                    "candidate": one.name,
                    "probability": answers.single[one.name],
                    "inclusion": answers.inclusion[one.name],
                    "log_ratio": self.log_ratio(one.name),
                    "error": float(error),
                    "strength": self.strength(one.name),
                    "low_95": span.low,
                    "high_95": span.high,
                }
            )
        table = pd.DataFrame(rows, columns=_COLUMNS).set_index("candidate")
        table = table.join(self.visibility.table())
        return table.sort_values("inclusion", ascending=False, kind="stable")

    def residual_table(self) -> pd.DataFrame:
        """Return the residuals of the base model, and of the leading cause beside them."""
        table = residual_table(self.residuals)
        if self.after:
            named = residual_table(self.after)[["simulated", "z", "z_left_out"]]
            table = table.join(named.add_suffix("_named"))
        return table


def diagnose(
    board: Board,
    rng: np.random.Generator,
    *,
    options: Options | None = None,
    scales: Mapping[str, Scale] | None = None,
    groups: Mapping[tuple[str, str], Sequence[int]] | None = None,
    progress: Progress | None = None,
) -> Diagnosis:
    """Say what the simulation gets wrong, and which cause fits.

    Parameters
    ----------
    board : Board
        Base model, candidates and data; the emulators know the effects of all candidates.
    rng : numpy Generator
    options : Options, optional
    scales : mapping, optional
        Reading to the scale of its numbers, for the tables.
    groups : mapping, optional
        See `calibrate.causes.residuals.groups_left_out`.
    progress : callable, optional
        Told what is done next, and the fraction of the work that is done.
    """
    effort = options.effort if options else None
    found = weigh_all(board, rng, progress, effort)
    seed = int(rng.integers(_SEEDS))
    return conclude(found, seed, options=options, scales=scales, groups=groups)


def conclude(
    found: Evidences,
    seed: int,
    *,
    options: Options | None = None,
    scales: Mapping[str, Scale] | None = None,
    groups: Mapping[tuple[str, str], Sequence[int]] | None = None,
    feasible: Sequence[Feasible] = (),
) -> Diagnosis:
    """Return verdict, residuals, gain and what to measure next.

    Parameters
    ----------
    found : Evidences
    seed : int
        Of imagined studies.
    options, scales, groups
        As in `diagnose`.
    feasible : sequence of Feasible
        Measurements besides those of the causes.
    """
    chosen = options or Options()
    levels, board = chosen.levels, found.board
    tangent, _ = heaviest_tangent(found, ())
    straight = straight_at(board, tangent)
    seen = visibility(board, tangent, straight, levels, seed)
    answers = answers_of(found, seen.power)
    singles = [(name,) for name in answers.inclusion if (name,) in found.weighed][:TESTED]
    pairs = list(answers.pairs)[:TESTED]
    chances = chances_of(found, straight, [*singles, *pairs], levels, seed)
    if sure_of(answers, levels):
        chances = replace(chances, lasting=lasting(found, answers.causes, seed))
    verdict = judge(answers, chances, levels, board.problem.space.size)
    before: tuple[Residual, ...] = ()
    after: tuple[Residual, ...] = ()
    left: tuple[Group, ...] = ()
    gains: tuple[Gain, ...] = ()
    if chosen.held_out:
        before = residuals(found, (), scales)
        left = tuple(groups_left_out(found, groups or {}))
        leading = _hypothesis(found, verdict)
        if leading:
            after = residuals(found, leading, scales)
            gains = (gain(found, leading, tangent, straight, seed),)
    ahead = prospect(found, answers, feasible)
    return Diagnosis(found, seen, verdict, before, left, after, gains, levels, seed, ahead)


def _hypothesis(found: Evidences, verdict: Verdict) -> tuple[str, ...]:
    """Return the hypothesis that the verdict stands for, as it was weighed; () without one."""
    names = verdict.leading
    for one in (names, tuple(reversed(names)), names[:1]):
        if one and one in found.weighed:
            return one
    return ()
