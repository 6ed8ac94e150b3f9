"""What a cause gains on data it has not seen: one place left out at a time.

In every fold everything is inferred again without the place, and its readings are predicted:
log p(place | others) = log evidence of all data - log evidence without the place. A positive
difference proves nothing by itself; it counts only above what imagined studies without the cause
show in 95 % of cases.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.bank import Bank, bank_of
from calibrate.causes.hypotheses import Weighed, weigh_hypothesis
from calibrate.causes.imagined import Studies, expected, imagine
from calibrate.causes.residuals import predicted, without

__all__ = ["Gain", "gain"]

CHANCE: float = 0.95
"""Share of imagined studies that a gain must exceed."""


@dataclass(frozen=True)
class Gain:
    """Held-out gain of some causes.

    Attributes
    ----------
    candidates : tuple of str
    z_before, z_after : float
        Root mean square of held-out residuals in standard deviations.
    log_density : float
        Difference of the log density of held-out data, with minus without, summed over places.
    chance : float
        95 % quantile of `log_density` in imagined studies without the cause.
    by_place : dict of str to float
        `log_density` of each place.
    """

    candidates: tuple[str, ...]
    z_before: float
    z_after: float
    log_density: float
    chance: float
    by_place: dict[str, float]

    @property
    def claimed(self) -> bool:
        """Whether the gain exceeds zero and what chance gives."""
        return self.log_density > max(0.0, self.chance)


def gain(base: Weighed, extended: Weighed, studies: int, seed: int) -> Gain:
    """Return what an extended hypothesis gains over the base model.

    Parameters
    ----------
    base, extended : Weighed
    studies : int
        Imagined studies.
    seed : int
    """
    before, z_before = _held_out(base, seed)
    after, z_after = _held_out(extended, seed)
    rng = np.random.default_rng([seed, 3])
    nulls = imagine(base.hypothesis, base.samples, studies, rng)
    centre = expected(base.hypothesis, base.best)
    chance = [
        _sum_of_folds(bank_of(one.hypothesis, centre, seed, base), nulls)
        for one in (extended, base)
    ]
    names = [place.name for place in base.problem.places]
    return Gain(
        extended.hypothesis.names,
        z_before,
        z_after,
        float(np.sum(after - before)),
        float(np.quantile(chance[0] - chance[1], CHANCE)),
        {n: float(d) for n, d in zip(names, after - before, strict=True)},
    )


def _held_out(one: Weighed, seed: int) -> tuple[Array, float]:
    """Return the log density of each place given the others, (places,), and the rms z."""
    density, squares = [], []
    for k, place in enumerate(one.problem.places):
        left = without(one.hypothesis.board, k)
        rest = weigh_hypothesis(left.hypothesis(*one.hypothesis.names), seed, one)
        density.append(one.log_evidence - rest.log_evidence)
        for reading in place.readings:
            mean, variance = predicted(place, reading, rest.samples)
            squares += list((reading.y - mean) ** 2 / (variance + reading.se**2))
    return np.array(density), float(np.sqrt(np.mean(squares)))


def _sum_of_folds(bank: Bank, studies: Studies) -> Array:
    """Return the log density of held-out places, summed over them, of imagined studies, (B,)."""
    terms, known = bank.terms(studies), bank.known(studies)
    whole = terms.sum(axis=0)
    every = bank.evidences_of(whole, known)
    folds = [every - bank.evidences_of(whole - own, known) for own in terms]
    return np.asarray(np.sum(folds, axis=0))
