"""What the data could show at all: absorbed shares, detection limits, look-alikes, bias.

Printed before any verdict. All numbers come from slopes and errors where the base model fits best,
not from the measured values. With K = 1 + J J^T and the answer a to a cause (see `straight`):
I = a^T K^-1 a, absorbed = 1 - I / a^T a, linear limit 2.8 / sqrt(I), bias of the parameters
J^T K^-1 a. The limit that is really reached comes from imagined studies judged as the real one: it
is larger, since look-alikes and the search over all causes cost power, and it must be a strength
that other parameters do not imitate from wherever they are.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from scipy import stats
from scipy.cluster.hierarchy import fcluster, linkage
from scipy.spatial.distance import squareform

from calibrate.arrays import Array
from calibrate.causes.candidates import Board
from calibrate.causes.judging.instead import POWER80, TRIED, Instead, imitated
from calibrate.causes.judging.levels import Levels
from calibrate.causes.judging.probabilities import PRIOR_NONE, PRIOR_SINGLE, prior_shares
from calibrate.causes.judging.straight import Straight
from calibrate.causes.weighing.tangent import Tangent

__all__ = ["Visibility", "Visible", "visibility", "visible_limits"]

TWO_SIDED: Final = 1.96
"""Standard deviations that chance exceeds in 5 % of cases."""
STRENGTHS: Final = 200
"""Strengths that stand for the prior of one."""
ALIKE: Final = 0.9
"""Residual answers closer than this cannot be told apart by realistic data."""
USUAL: Final = 2.5
"""Ordinary strengths at which a bent answer is looked at."""
STUDIES: Final = 60
"""Imagined studies for each cause and strength: 80 % is told to 5 %."""
WANTED: Final = 0.8
SET: Final = 2
_NOTHING: Final = 1e-12
_SHOWN: Final = ("absorbed", "detectable", "achieved", "limit", "visible", "power")


@dataclass(frozen=True)
class Visible:
    """What the data can say about one candidate.

    Attributes
    ----------
    candidate : str
    absorbed : float
        Share of its squared answer that the base parameters imitate, 0 to 1.
    detectable : float
        Smallest strength found with 80 % power in a 5 % test, were it the only cause there is, in
        the candidate's unit; infinite for one that changes nothing.
    achieved : float
        Smallest strength that is named, or in a set of two, in 80 % of imagined studies, and that
        no parameters of the base model imitate.
    instead : Instead or None
        What does the same as the cause at the largest strength of `TRIED` at which something does.
    limit : float
        Largest strength that is possible.
    power : float
        Chance that a 5 % test finds it at a strength drawn from its prior, 0.05 to 1.
    bias : dict of str to float
        Unknown to its change on [0, 1] per unit of strength when the cause is real and ignored.
    alike : tuple of str
        Candidates whose residual answer looks the same (absolute cosine above 0.9, average
        linkage).
    """

    candidate: str
    absorbed: float
    detectable: float
    achieved: float
    limit: float
    power: float
    bias: dict[str, float]
    alike: tuple[str, ...]
    instead: Instead | None = None

    @property
    def visible(self) -> bool:
        """Whether it would be seen at a possible strength."""
        return self.detectable <= self.limit


@dataclass(frozen=True, eq=False)
class Visibility:
    """Visibility of every candidate.

    Attributes
    ----------
    candidates : tuple of Visible
    cosines : (c, c) float64
        Between their residual answers.
    """

    candidates: tuple[Visible, ...]
    cosines: Array

    @property
    def power(self) -> dict[str, float]:
        """Chance of each cause that these data show it, at a strength drawn from its prior."""
        return {one.candidate: one.power for one in self.candidates}

    def of(self, candidate: str) -> Visible:
        """Return the row of one candidate."""
        return next(one for one in self.candidates if one.candidate == candidate)

    def table(self) -> pd.DataFrame:
        """Return a row for every candidate: the attributes of `Visible` but for the bias."""
        rows = [
            {
                "candidate": one.candidate,
                **{name: getattr(one, name) for name in _SHOWN},
                "alike": ", ".join(one.alike),
            }
            for one in self.candidates
        ]
        columns = ["candidate", *_SHOWN, "alike"]
        return pd.DataFrame(rows, columns=columns).set_index("candidate")


def visible_limits(straight: Straight) -> Array:
    """Return the linear limits of all causes, in ordinary strengths, (c,)."""
    a = _usual(straight)
    kept = np.sum(a * (straight.inverse @ a), axis=0)
    return np.asarray(POWER80 / np.sqrt(np.maximum(kept, _NOTHING)))


def _usual(straight: Straight) -> Array:
    """Return the answers per strength at ordinary strengths, (N, c)."""
    bent = np.array([straight.bent(k) for k in range(len(straight.names))], dtype=float)
    return np.asarray(straight.answers + USUAL * straight.bends * bent)


def visibility(
    board: Board, tangent: Tangent, straight: Straight, levels: Levels, seed: int
) -> Visibility:
    """Return what the data can say about every candidate.

    Parameters
    ----------
    board : Board
    tangent : Tangent
        Around the best values of the base model.
    straight : Straight
        From it.
    levels : Levels
        Of the verdict that judges imagined studies.
    seed : int
        Of the imagined studies.
    """
    a = _usual(straight)
    turned = straight.inverse @ a
    kept = np.maximum(np.sum(a * turned, axis=0), 0.0)
    whole = np.sum(a**2, axis=0)
    seen = kept > _NOTHING
    length = np.sqrt(np.maximum(kept, _NOTHING))
    cosines = np.where(np.outer(seen, seen), a.T @ turned / np.outer(length, length), 0.0)
    np.fill_diagonal(cosines, 1.0)
    labels = _groups(np.abs(np.clip(cosines, -1.0, 1.0)))
    power = {name: _power(straight, k, kept[k]) for k, name in enumerate(straight.names)}
    reached = _achieved(board, straight, power, levels, seed)
    instead = imitated(board, tangent.z, reached, np.random.default_rng([seed, 7]))
    moved = straight.slopes.T @ turned * _per_unit(board, tangent)[:, None]
    names = board.problem.space.names
    rows = []
    for k, one in enumerate(board.candidates):
        changes = {n: float(x) / one.scale for n, x in zip(names, moved[:, k], strict=True)}
        rows.append(
            Visible(
                one.name,
                float(1.0 - kept[k] / whole[k]) if whole[k] > _NOTHING else 0.0,
                one.scale * POWER80 / length[k] if seen[k] else float("inf"),
                one.scale * reached[k],
                one.limit,
                power[one.name],
                changes,
                tuple(
                    other.name
                    for j, other in enumerate(board.candidates)
                    if j != k and labels[j] == labels[k]
                ),
                instead.get(k),
            )
        )
    return Visibility(tuple(rows), cosines)


def _per_unit(board: Board, tangent: Tangent) -> Array:
    """Return by how much each unknown changes on its unit range per unit of z, (K,)."""
    space, step = board.problem.space, 1e-4
    points = tangent.z + np.vstack([step * np.eye(len(tangent.z)), -step * np.eye(len(tangent.z))])
    units = space.units(space.from_normal(points))
    size = len(tangent.z)
    return np.asarray(np.diag(units[:size] - units[size:]) / (2.0 * step))


def _power(straight: Straight, k: int, kept: float) -> float:
    """Return the chance that a 5 % test finds a cause of a strength drawn from its prior."""
    x = np.abs(straight.priors[k].draw(STRENGTHS, np.random.default_rng(k)))
    spread = np.sqrt(1.0 + straight.doubts[k] * x**2)
    away = x * np.sqrt(kept)
    above = stats.norm.sf((TWO_SIDED - away) / spread) + stats.norm.cdf(
        (-TWO_SIDED - away) / spread
    )
    return float(np.clip(np.mean(above), 0.05, 1.0))


def _achieved(
    board: Board, straight: Straight, power: dict[str, float], levels: Levels, seed: int
) -> list[float]:
    """Return the smallest ordinary strength of each cause that is found in 80 % of studies."""
    if not straight.names:
        return []
    rng = np.random.default_rng([seed, 5])
    shares = prior_shares(board, power)
    log_prior = np.log([max(PRIOR_SINGLE * shares[n], _NOTHING) for n in straight.names])
    chance = straight.log_ratios(straight.imagine(400, rng)).max(axis=1, initial=-np.inf)
    threshold = float(np.quantile(chance, 1.0 - levels.chance))
    found = []
    for k, prior in enumerate(straight.priors):
        reached = float("inf")
        tried = np.array([1.0]) if prior.fixed else TRIED
        for x in tried:
            sign = 1.0 if prior.high > 0.0 else -1.0
            if not prior.low <= sign * x <= prior.high:
                break
            y = straight.with_cause(k, np.full(STUDIES, sign * x), rng)
            told = _told(straight.log_ratios(y), k, log_prior, threshold, levels)
            if np.mean(told) >= WANTED:
                reached = float(x)
                break
        found.append(reached)
    return found


def _told(ratios: Array, k: int, log_prior: Array, threshold: float, levels: Levels) -> Array:
    """Return whether a cause is named, or in a set of two, (B,) bool."""
    logs = np.column_stack([np.full(len(ratios), np.log(PRIOR_NONE)), ratios + log_prior])
    p = np.exp(logs - logs.max(axis=1, keepdims=True))
    p /= p.sum(axis=1, keepdims=True)
    causes = p[:, 1:]
    order = np.argsort(-causes, axis=1)[:, :SET]
    held = np.take_along_axis(causes, order, axis=1).sum(axis=1)
    inside = (order == k).any(axis=1)
    named = causes[:, k] > levels.name
    good = ratios.max(axis=1) > threshold
    small = held > levels.credible * (1.0 - p[:, 0])
    return np.asarray(good & (named | (inside & small & (p[:, 0] < levels.other))))


def _groups(alike: Array) -> Array:
    """Return cluster labels by average linkage on one minus the absolute cosine."""
    if len(alike) < 2:
        return np.zeros(len(alike))
    distance = np.clip(1.0 - alike, 0.0, None)
    np.fill_diagonal(distance, 0.0)
    tree = linkage(squareform(distance, checks=False), method="average")
    return np.asarray(fcluster(tree, 1.0 - ALIKE, criterion="distance"))
