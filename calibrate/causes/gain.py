"""What a cause gains on data it has not seen: one place left out at a time.

In every fold everything is inferred again without the place, and its readings are predicted, by
mean and covariance, without the cause and with it; the log densities at what was measured differ by
the gain. (The evidence of all data over that without the place is the same where all is known; from
draws of the whole study it is too modest for a strong cause, since few of those that the base model
needs without a place are there: 0.3 to 0.6 of the gain on new data in suite 4, docs/challenge.md.)
A positive difference proves nothing by itself; it counts only above what imagined studies without
the cause show in 95 % of cases. What new data of the same experiments will gain is told by what the
cause, told by all data, expects of them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.judging.straight import Straight
from calibrate.causes.left_out import Expected, told_by_others, views
from calibrate.causes.weighing.evidences import Evidences
from calibrate.causes.weighing.tangent import Tangent
from calibrate.inference.sampler.importance import take

__all__ = ["Gain", "gain"]

CHANCE: Final = 0.95
"""Share of imagined studies that a gain must exceed."""
STUDIES: Final = 400
LUCK: Final = (0.05, 0.95)


@dataclass(frozen=True)
class Gain:
    """Held-out gain of some causes.

    Attributes
    ----------
    candidates : tuple of str
    log_density : float
        Difference of the log density of held-out data, with minus without, summed over places.
    chance : float
        95 % quantile of `log_density` in imagined studies without the cause.
    by_place : dict of str to float
        `log_density` of each place.
    low, high : float
        Between which the gain on new data of the same experiments lies with 90 % if it is the
        cause.
    """

    candidates: tuple[str, ...]
    log_density: float
    chance: float
    by_place: dict[str, float]
    low: float
    high: float

    @property
    def claimed(self) -> bool:
        """Whether the gain exceeds zero and what chance gives."""
        return self.log_density > max(0.0, self.chance)


def gain(
    found: Evidences, names: tuple[str, ...], tangent: Tangent, straight: Straight, seed: int
) -> Gain:
    """Return what a hypothesis gains over the base model.

    Parameters
    ----------
    found : Evidences
    names : tuple of str
        Of its members.
    tangent : Tangent
        Around the best values of the base model.
    straight : Straight
        From it.
    seed : int
        Of the imagined studies.
    """
    problem = found.board.problem
    spans, first = [], 0
    for place in problem.places:
        spans.append(list(range(first, first + len(place.readings))))
        first += len(place.readings)
    after, before = (told_by_others(found, n) for n in (names, ()))
    rng = np.random.default_rng([seed, 3])
    imagined = _Rig(names, tangent, straight, spans).gains(straight.imagine(STUDIES, rng))
    each = [float(a.log_density(a.y) - b.log_density(b.y)) for a, b in _pairs(after, before)]
    low, high = np.quantile(_on_new_data(found, names, after, before, rng), LUCK)
    by_place = {p.name: gained for p, gained in zip(problem.places, each, strict=True)}
    return Gain(
        names, sum(each), float(np.quantile(imagined, CHANCE)), by_place, float(low), float(high)
    )


def _pairs(after: list[Expected], before: list[Expected]) -> list[tuple[Expected, Expected]]:
    return list(zip(after, before, strict=True))


def _on_new_data(
    found: Evidences,
    names: tuple[str, ...],
    after: list[Expected],
    before: list[Expected],
    rng: np.random.Generator,
) -> Array:
    """Return gains on new data as the cause expects them, told by all that was measured, (n,)."""
    one = found.weighed[names]
    seen = views(found, one, take(one.weights, STUDIES, rng))
    total: Array = np.zeros(STUDIES)
    first = 0
    for a, b in _pairs(after, before):
        mine = seen[first : first + len(a.names)]
        first += len(a.names)
        y = [
            view.mean + rng.multivariate_normal(np.zeros(len(c := view.covariance)), c, STUDIES)
            for view in mine
        ]
        new = np.column_stack(y)
        total += a.log_density(new) - b.log_density(new)
    return total


class _Rig:
    """The straightened bench, on which a gain is seen in many imagined studies at once."""

    def __init__(
        self, names: tuple[str, ...], tangent: Tangent, straight: Straight, spans: list[list[int]]
    ) -> None:
        self.narrow = tangent.slopes
        at = [straight.names.index(name) for name in names]
        priors = [straight.priors[k] for k in at]
        wide = [0.0 if prior.fixed else prior.width for prior in priors]
        more = [w * straight.answers[:, [k]] for k, w in zip(at, wide, strict=True)]
        self.wider = np.column_stack([tangent.slopes, *more])
        self.rows = [
            np.concatenate([np.arange(len(tangent.left))[tangent.spans[r]] for r in own])
            for own in spans
        ]

    def gains(self, y: Array) -> Array:
        """Return the gains of studies (B, N), (B,)."""
        total: Array = np.zeros(len(y))
        for rows in self.rows:
            total += _density(self.wider, y, rows) - _density(self.narrow, y, rows)
        return total


def _density(slopes: Array, y: Array, rows: Array) -> Array:
    """Return the log density of some numbers given the others of studies (B, N), (B,)."""
    others = np.setdiff1d(np.arange(y.shape[1]), rows)
    covariance = np.eye(y.shape[1]) + slopes @ slopes.T
    known = np.linalg.inv(covariance[np.ix_(others, others)])
    turned = covariance[np.ix_(rows, others)] @ known
    left = y[:, rows] - y[:, others] @ turned.T
    own = covariance[np.ix_(rows, rows)] - turned @ covariance[np.ix_(others, rows)]
    inverse = np.linalg.inv(own)
    log_determinant = float(np.linalg.slogdet(own)[1])
    return np.asarray(-0.5 * (np.einsum("bi,ij,bj->b", left, inverse, left) + log_determinant))
