"""From a few runs of each answer to what it expects of a further experiment.

Runs of one answer differ by luck and by the parameters that it leaves open, both with a covariance
that all answers share. Few runs tell both poorly: means are drawn together by what luck alone would
set between them, correlations towards none, and the covariance is that of a next run, whose mean
and covariance are known from as many runs only (that of Student's distribution).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy import stats

from calibrate.arrays import Array
from calibrate.causes.joint_information import Together, joint_information, joint_shares_after
from calibrate.causes.judging.probabilities import UNKNOWN
from calibrate.causes.offers import APART, Names, Offer, Trial, outcomes_of
from calibrate.scales import Scale, backward, forward, slope

__all__ = ["Seen", "expected_of", "offer_of"]


CHANCE: Final = 1.0 / 3.0
"""Experiments at which all answers expect the same, and luck sets their means apart all the same:
the others are worth nothing."""


@dataclass(frozen=True, eq=False)
class Seen:
    """What runs of a further experiment gave.

    Attributes
    ----------
    results : dict
        Answer to its runs, (n, d), in the units of the observables; nan where one failed.
    scales : tuple of Scale
        On which each observable is modelled.
    se : tuple of float
        Standard error with which it is measured, in its unit.
    """

    results: Mapping[Names, Array]
    scales: tuple[Scale, ...]
    se: tuple[float, ...]


def expected_of(seen: Seen, unknown: bool) -> dict[Names, Together] | None:
    """Return what each answer expects on the model scales; None where too few runs succeeded.

    Parameters
    ----------
    seen : Seen
    unknown : bool
        Whether what is in no library is an answer. It expects what none does, and is wider by as
        much as the others differ from that: it may do what any of them does.
    """
    runs = {names: _modelled(seen, rows) for names, rows in seen.results.items()}
    counts = [len(rows) for rows in runs.values()]
    dof = sum(counts) - len(runs)
    if len(runs) < 2 or min(counts) < 2 or dof <= 2:
        return None
    off = np.vstack([y - y.mean(axis=0) for y in runs.values()])
    within = off.T @ off / dof
    means = _drawn_together(list(runs.values()), np.diag(within))
    width = len(within)
    kept = np.where(np.eye(width, dtype=bool), 1.0, dof / (dof + width))
    everything = np.vstack(list(runs.values())).T
    errors = [_error(*one) for one in zip(everything, seen.se, seen.scales, strict=True)]
    whole = within * kept * (1.0 + 1.0 / min(counts)) * dof / (dof - 2) + np.diag(errors) ** 2
    found = {names: Together(mean, whole) for names, mean in zip(runs, means, strict=True)}
    if unknown:
        none = found[()].mean
        away = np.array([one.mean for names, one in found.items() if names]) - none
        found[UNKNOWN,] = Together(none, whole + away.T @ away / len(away))
    return found


def _modelled(seen: Seen, rows: Array) -> Array:
    """Return the runs that gave all numbers, on the model scales."""
    columns = [forward(scale, y) for scale, y in zip(seen.scales, rows.T, strict=True)]
    y = np.column_stack(columns)
    return np.asarray(y[np.isfinite(y).all(axis=1)])


def _drawn_together(runs: Sequence[Array], within: Array) -> Array:
    """Return the mean of each answer, (H, d), nearer to that of all by what luck explains."""
    counts = np.array([len(y) for y in runs], dtype=float)
    means = np.array([y.mean(axis=0) for y in runs])
    middle = counts @ means / counts.sum()
    between = counts @ (means - middle) ** 2 / (len(runs) - 1)
    # The ratio of both that luck alone exceeds, in any of the numbers, with probability CHANCE.
    level = (1.0 - CHANCE) ** (1.0 / len(within))
    limit = float(stats.f.ppf(level, len(runs) - 1, counts.sum() - len(runs)))
    rest = np.maximum(between - max(limit, 1.0) * within, 0.0)
    share = np.divide(rest, between, out=np.zeros_like(rest), where=between > 0.0)
    return np.asarray(middle + share * (means - middle))


def _error(y: Array, se: float, scale: Scale) -> float:
    """Return an error of measurement on the model scale, at the middle of all runs."""
    return se * slope(scale, float(backward(scale, np.array(np.median(y)))))


def offer_of(
    trial: Trial, shares: Mapping[Names, float], seen: Seen, rng: np.random.Generator
) -> Offer | None:
    """Return what a further experiment is worth; None where too few runs succeeded.

    Of answers that were not tried it is taken to tell nothing.

    Parameters
    ----------
    trial : Trial
    shares : mapping
        Probability of every answer, the largest first.
    seen : Seen
    rng : numpy Generator
    """
    unknown = () in seen.results and (UNKNOWN,) in shares
    expected = expected_of(seen, unknown)
    if expected is None:
        return None
    tried = {names: p for names, p in shares.items() if names in expected}
    total = sum(tried.values())
    parts = [p / total for p in tried.values()]
    normals = [expected[names] for names in tried]

    def apart(one: int, other: int) -> bool:
        off = np.abs(normals[one].mean - normals[other].mean)
        spread = [np.diag(normals[k].covariance) for k in (one, other)]
        return bool((off > APART * np.sqrt(np.maximum(*spread))).any())

    def after(one: int) -> Array:
        return joint_shares_after(normals[one].mean, parts, normals)

    results = [
        tuple(float(backward(s, x)) for s, x in zip(seen.scales, one.mean, strict=True))
        for one in normals
    ]
    told = total * joint_information(parts, normals, rng)
    return Offer(trial, told, outcomes_of(tried, results, apart, after))
