"""What a cause gains on data it has not seen: one place left out at a time.

In every fold everything is inferred again without the place, and its readings are predicted:
log p(place | others) = log evidence of all data - log evidence without the place. A positive
difference proves nothing by itself; it counts only above what imagined studies without the cause
show in 95 % of cases.
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
from calibrate.causes.weighing.modes import Tangent

__all__ = ["Gain", "gain"]

CHANCE: Final = 0.95
"""Share of imagined studies that a gain must exceed."""
STUDIES: Final = 400


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
    """

    candidates: tuple[str, ...]
    log_density: float
    chance: float
    by_place: dict[str, float]

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
    chance = _by_chance(names, tangent, straight, spans, np.random.default_rng([seed, 3]))
    by_place = {p.name: float(d) for p, d in zip(problem.places, after - before, strict=True)}
    return Gain(names, float(np.sum(after - before)), chance, by_place)


def _held_out(one: Weighed, spans: list[list[int]]) -> Array:
    """Return the log density of each place given the others, (places,)."""
    every = special.logsumexp(one.log_weight)
    return np.array(
        [every - special.logsumexp(one.log_weight - one.terms[:, own].sum(axis=1)) for own in spans]
    )


def _by_chance(
    names: tuple[str, ...],
    tangent: Tangent,
    straight: Straight,
    spans: list[list[int]],
    rng: np.random.Generator,
) -> float:
    """Return the gain that imagined studies without a cause reach in 5 % of cases."""
    at = [straight.names.index(name) for name in names]
    slopes = [tangent.slopes]
    for k in at:
        prior = straight.priors[k]
        wide = 0.0 if prior.fixed else prior.width
        slopes.append(wide * straight.answers[:, [k]])
    wider = np.column_stack(slopes)
    studies = straight.imagine(STUDIES, rng)
    total: Array = np.zeros(STUDIES)
    for own in spans:
        rows = np.concatenate([np.arange(len(tangent.left))[tangent.spans[r]] for r in own])
        total += _density(wider, studies, rows) - _density(tangent.slopes, studies, rows)
    return float(np.quantile(total, CHANCE))


def _density(slopes: Array, y: Array, rows: Array) -> Array:
    """Return the log density of some numbers given the others, for studies (B, N), (B,)."""
    others = np.setdiff1d(np.arange(y.shape[1]), rows)
    covariance = np.eye(y.shape[1]) + slopes @ slopes.T
    known = np.linalg.inv(covariance[np.ix_(others, others)])
    turned = covariance[np.ix_(rows, others)] @ known
    left = y[:, rows] - y[:, others] @ turned.T
    own = covariance[np.ix_(rows, rows)] - turned @ covariance[np.ix_(others, rows)]
    inverse = np.linalg.inv(own)
    log_determinant = float(np.linalg.slogdet(own)[1])
    return np.asarray(-0.5 * (np.einsum("bi,ij,bj->b", left, inverse, left) + log_determinant))
