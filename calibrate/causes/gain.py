"""What a cause gains on data it has not seen: one place left out at a time.

In every fold everything is inferred again without the place, and its readings are predicted:
log p(place | others) = log evidence of all data - log evidence without the place. A positive
difference proves nothing by itself; it counts only above what imagined studies without the cause
show in 95 % of cases. What would be gained on new data of the same experiments differs from it by
the luck of the data at hand; imagined studies with the cause say by how much.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy import special

from calibrate.arrays import Array
from calibrate.causes.judging.straight import Straight
from calibrate.causes.weighing.evidences import Evidences
from calibrate.causes.weighing.hypotheses import Weighed
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
        Between which the gain on new data of the same experiments lies in 90 % of imagined studies
        with the cause.
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
    after, before = (_held_out(found.weighed[n], spans) for n in (names, ()))
    rig = _Rig(names, tangent, straight, spans)
    rng = np.random.default_rng([seed, 3])
    chance = float(np.quantile(rig.gains(straight.imagine(STUDIES, rng)), CHANCE))
    luck = rig.luck(_likely(found, names, rng), rng)
    total = float(np.sum(after - before))
    low, high = total - np.quantile(luck, [LUCK[1], LUCK[0]])
    by_place = {p.name: float(d) for p, d in zip(problem.places, after - before, strict=True)}
    return Gain(names, total, chance, by_place, float(low), float(high))


def _held_out(one: Weighed, spans: list[list[int]]) -> Array:
    """Return the log density of each place given the others, (places,)."""
    every = special.logsumexp(one.log_weight)
    return np.array(
        [every - special.logsumexp(one.log_weight - one.terms[:, own].sum(axis=1)) for own in spans]
    )


def _likely(found: Evidences, names: tuple[str, ...], rng: np.random.Generator) -> Array:
    """Return strengths that are probable after the data, ordinary ones, (STUDIES, m)."""
    one = found.weighed[names]
    return np.asarray(one.strengths[take(one.weights, STUDIES, rng)])


class _Rig:
    """The straightened bench, on which a gain is seen in many imagined studies at once."""

    def __init__(
        self, names: tuple[str, ...], tangent: Tangent, straight: Straight, spans: list[list[int]]
    ) -> None:
        self.straight, self.narrow = straight, tangent.slopes
        self.at = [straight.names.index(name) for name in names]
        priors = [straight.priors[k] for k in self.at]
        wide = [0.0 if prior.fixed else prior.width for prior in priors]
        more = [w * straight.answers[:, [k]] for k, w in zip(self.at, wide, strict=True)]
        self.wider = np.column_stack([tangent.slopes, *more])
        self.rows = [
            np.concatenate([np.arange(len(tangent.left))[tangent.spans[r]] for r in own])
            for own in spans
        ]

    def gains(self, y: Array, new: Array | None = None) -> Array:
        """Return the gains of studies (B, N), on new data of each place if there are any, (B,)."""
        fresh = y if new is None else new
        total: Array = np.zeros(len(y))
        for rows in self.rows:
            total += _density(self.wider, y, fresh, rows) - _density(self.narrow, y, fresh, rows)
        return total

    def luck(self, strengths: Array, rng: np.random.Generator) -> Array:
        """Return by how much gains exceed those on new data, in studies with the cause, (B,)."""
        count, (numbers, unknowns) = len(strengths), self.narrow.shape
        mean = rng.standard_normal((count, unknowns)) @ self.narrow.T
        for k, x in zip(self.at, strengths.T, strict=True):
            mean += self.straight.added(k, x)
        y, new = (mean + rng.standard_normal((count, numbers)) for _ in range(2))
        return np.asarray(self.gains(y) - self.gains(y, new))


def _density(slopes: Array, y: Array, new: Array, rows: Array) -> Array:
    """Return the log density of new numbers given the others of studies, all (B, N), (B,)."""
    others = np.setdiff1d(np.arange(y.shape[1]), rows)
    covariance = np.eye(y.shape[1]) + slopes @ slopes.T
    known = np.linalg.inv(covariance[np.ix_(others, others)])
    turned = covariance[np.ix_(rows, others)] @ known
    left = new[:, rows] - y[:, others] @ turned.T
    own = covariance[np.ix_(rows, rows)] - turned @ covariance[np.ix_(others, rows)]
    inverse = np.linalg.inv(own)
    log_determinant = float(np.linalg.slogdet(own)[1])
    return np.asarray(-0.5 * (np.einsum("bi,ij,bj->b", left, inverse, left) + log_determinant))
