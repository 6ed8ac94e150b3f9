"""The diagnosis of one board from end to end: evidences, table, verdict, residuals, gain."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Final

import numpy as np
import pandas as pd

from calibrate.causes.bank import sways
from calibrate.causes.gain import Gain, gain
from calibrate.causes.hypotheses import Board, Weighed, weigh_hypothesis
from calibrate.causes.residuals import Residual, residual_table, residuals
from calibrate.causes.verdict import Levels, Verdict, chances_of, judge, probabilities
from calibrate.causes.visibility import Visibility, visibility
from calibrate.inference.intervals import Interval
from calibrate.scales import Scale

__all__ = ["Diagnosis", "Evidences", "Options", "conclude", "diagnose", "weigh_all"]

_SEEDS: Final = 2**31
_COLUMNS: Final = ["candidate", "probability", "log_ratio", "error", "sway", "strength",
                   "low_95", "high_95"]  # fmt: skip


@dataclass(frozen=True)
class Options:
    """How much work a diagnosis does.

    Attributes
    ----------
    levels : Levels
    held_out : bool
        Whether to leave readings and places out and infer everything again.
    """

    levels: Levels = field(default_factory=Levels)
    held_out: bool = True


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """Everything a report needs.

    Attributes
    ----------
    board : Board
    weighed : dict
        Hypotheses after the data, by the names of their members; () is the base model.
    visibility : Visibility
    verdict : Verdict
    residuals : tuple of Residual
        Of the base model; empty where nothing was to be left out.
    after : tuple of Residual
        With the best named cause; empty without one.
    gains : tuple of Gain
        Held-out gain of the most probable named cause; empty without one.
    levels : Levels
    sways : mapping of str to float
        Per candidate: standard deviation of its log evidence ratio between emulators from other
        runs, as many as here.
    """

    board: Board
    weighed: Mapping[tuple[str, ...], Weighed]
    visibility: Visibility
    verdict: Verdict
    residuals: tuple[Residual, ...]
    after: tuple[Residual, ...]
    gains: tuple[Gain, ...]
    levels: Levels
    sways: Mapping[str, float]

    @property
    def base(self) -> Weighed:
        """The base model after the data."""
        return self.weighed[()]

    def log_ratio(self, name: str) -> float:
        """Return the log evidence ratio of a candidate, or of a shift, against the base model."""
        return self.weighed[name,].log_evidence - self.base.log_evidence

    def strength(self, name: str) -> float:
        """Return the median of a candidate's strength if it is the cause, in its unit."""
        return float(np.median(self.weighed[name,].strength(name)))

    def interval(self, name: str, level: float = 0.95) -> Interval:
        """Return the interval of a candidate's strength if it is the cause, in its unit."""
        return self.weighed[name,].interval(name, level)

    def table(self) -> pd.DataFrame:
        """Return a row for every candidate, the most probable first.

        Returns
        -------
        DataFrame
            Index ``candidate``; probability, log_ratio with its error of computation and its
            sway with other runs, strength (median) with the ends of its 95 % interval, then the
            columns of `Visibility.table`.
        """
        rows = []
        for one in self.board.candidates:
            span = self.interval(one.name)
            found = self.weighed[one.name,]
            rows.append(
                {
                    "candidate": one.name,
                    "probability": self.verdict.probabilities[one.name],
                    "log_ratio": self.log_ratio(one.name),
                    "error": float(np.hypot(found.error, self.base.error)),
                    "sway": self.sways[one.name],
                    "strength": self.strength(one.name),
                    "low_95": span.low,
                    "high_95": span.high,
                }
            )
        table = pd.DataFrame(rows, columns=_COLUMNS).set_index("candidate")
        table = table.join(self.visibility.table())
        return table.sort_values("probability", ascending=False, kind="stable")

    def residual_table(self) -> pd.DataFrame:
        """Return the residuals of the base model, and of the best named cause beside them."""
        table = residual_table(self.residuals)
        if self.after:
            named = residual_table(self.after)[["simulated", "z", "z_left_out"]]
            table = table.join(named.add_suffix("_named"))
        return table


@dataclass(frozen=True, eq=False)
class Evidences:
    """All hypotheses after the data.

    Attributes
    ----------
    board : Board
    weighed : dict
        By the names of their members; () is the base model.
    seed : int
        Of the stream of random numbers that all of them share.
    """

    board: Board
    weighed: Mapping[tuple[str, ...], Weighed]
    seed: int

    @property
    def base(self) -> Weighed:
        """The base model after the data."""
        return self.weighed[()]


def weigh_all(
    board: Board,
    rng: np.random.Generator,
    progress: Callable[[str, float], None] | None = None,
) -> Evidences:
    """Weigh the base model, every candidate and every shift of unknown origin.

    Parameters
    ----------
    board : Board
        Base model, candidates and data; the emulators know the effects of all candidates.
    rng : numpy Generator
        One number is taken from it; all hypotheses get the same stream.
    progress : callable, optional
        Told what is done next, and the fraction of evidences that are done.
    """
    seed = int(rng.integers(_SEEDS))
    sets: list[tuple[str, ...]] = [()]
    sets += [(one.name,) for one in (*board.candidates, *board.shifts)]
    weighed: dict[tuple[str, ...], Weighed] = {}
    for number, names in enumerate(sets):
        if progress is not None:
            progress(" and ".join(names) or "base model", number / len(sets))
        weighed[names] = weigh_hypothesis(board.hypothesis(*names), seed, weighed.get(()))
    return Evidences(board, weighed, seed)


def diagnose(
    board: Board,
    rng: np.random.Generator,
    *,
    options: Options | None = None,
    scales: Mapping[str, Scale] | None = None,
    progress: Callable[[str, float], None] | None = None,
) -> Diagnosis:
    """Say what the simulation gets wrong, and which cause fits.

    Parameters
    ----------
    board, rng, progress
        As in `weigh_all`.
    options, scales
        As in `conclude`.
    """
    found = weigh_all(board, rng, progress)
    return conclude(found, options=options, scales=scales, progress=progress)


def conclude(
    evidences: Evidences,
    *,
    options: Options | None = None,
    scales: Mapping[str, Scale] | None = None,
    progress: Callable[[str, float], None] | None = None,
) -> Diagnosis:
    """Return verdict, residuals, gain and how much all of it would sway with other runs.

    Parameters
    ----------
    evidences : Evidences
        From `weigh_all`.
    options : Options, optional
    scales : mapping, optional
        Reading to the scale of its numbers, for the tables.
    progress : callable, optional
        Told what is done next, and the fraction of the work that is done.
    """
    chosen = options or Options()
    board, weighed = evidences.board, evidences.weighed
    levels, seed = chosen.levels, evidences.seed
    seen = visibility(board, weighed[()])
    shares, where = probabilities(board, weighed, seen)
    best = [one for one in shares if (one,) in weighed][:1]
    if progress is not None:
        progress("imagined studies", 1.0)
    chances = chances_of(board, weighed, best, levels, seed)
    verdict = judge(shares, where, chances, levels)
    before: tuple[Residual, ...] = ()
    after: tuple[Residual, ...] = ()
    gains: tuple[Gain, ...] = ()
    if chosen.held_out:
        if progress is not None:
            progress("left out", 1.0)
        before = residuals(weighed[()], seed, scales)
        if verdict.names:
            after = residuals(weighed[verdict.names[0],], seed, scales)
            gains = (gain(weighed[()], weighed[verdict.names[0],], levels.studies, seed),)
    found = [weighed[one.name,] for one in board.candidates]
    spread = sways(weighed[()], found, seed)
    by_name = {one.name: s for one, s in zip(board.candidates, spread, strict=True)}
    return Diagnosis(board, weighed, seen, verdict, before, after, gains, levels, by_name)
