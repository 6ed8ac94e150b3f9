"""How much log evidence ratios sway between emulators from other runs, as many as here.

Other runs would have given other expected values. Those are drawn from what the emulators say of
their own errors, with the same luck for all hypotheses. Where emulators make up a share f^2 of all
variance, a ratio R sways by about f sqrt(2 R), so that a large one is never sharp while they are
less certain than the measurements.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
from scipy import special

from calibrate.arrays import Array
from calibrate.causes.weighing.evidences import Evidences
from calibrate.causes.weighing.switched import predicted_at
from calibrate.emulator.types import Prediction
from calibrate.inference.likelihood import misfit, variances

__all__ = ["lasting", "sways"]

OTHERS: Final = 200
"""Imagined emulators from other runs, half of them the mirror images of the others: with 100, none
mirrored, how probable a cause is over other runs differed by 0.035 between seeds."""
DRAWS: Final = 400
"""Of each hypothesis, those that count most."""
RIVALS: Final = 8
"""Hypotheses among which other runs might choose otherwise."""


def sways(
    found: Evidences, hypotheses: Sequence[tuple[str, ...]], seed: int
) -> dict[tuple[str, ...], float]:
    """Return standard deviations of log evidence ratios against the base model, in nats.

    Parameters
    ----------
    found : Evidences
    hypotheses : sequence of tuple of str
    seed : int
    """
    plain = _moved(found, (), seed)
    return {names: float(np.std(_moved(found, names, seed) - plain)) for names in hypotheses}


def lasting(
    found: Evidences, shares: Mapping[tuple[str, ...], float], seed: int
) -> dict[tuple[str, ...], float]:
    """Return how probable hypotheses are on average over emulators from other runs.

    Probabilities count what emulators say of their own errors. Where those are said too small, a
    cause is sure of itself by chance; one that stays ahead with other runs is not.

    Parameters
    ----------
    found : Evidences
    shares : mapping
        Hypotheses of causes to their probability.
    seed : int

    Returns
    -------
    dict of tuple to float
        Chance of each if one of them holds; of the most probable ones alone.

    References
    ----------
    Averages of posteriors over resampled data: Huggins & Miller, Biometrika 110, 1 (2023).
    """
    rivals = sorted(shares, key=lambda names: -shares[names])[:RIVALS]
    rivals = [names for names in rivals if shares[names] > 0.0]
    moved = [np.log(shares[names]) + _moved(found, names, seed) for names in rivals]
    mean = special.softmax(np.array(moved), axis=0).mean(axis=1)
    return dict(zip(rivals, map(float, mean), strict=True))


def _moved(found: Evidences, names: tuple[str, ...], seed: int) -> Array:
    """Return log evidences with imagined other runs, relative to that with these, (`OTHERS`,)."""
    one = found.weighed[names]
    rows = np.argsort(-one.log_weight)[:DRAWS]
    members, strengths = found.board.members(names), one.strengths[rows]
    values = found.cloud.bench.points[rows]
    log_weight: Array = np.tile(one.log_weight[rows], (OTHERS, 1))
    rng = np.random.default_rng([seed, 4])
    for k, seen in enumerate(found.cloud.bench.seen):
        prediction = predicted_at(seen.rows(rows), k, members, strengths)
        error = _errors(prediction, rng)
        for reading in seen.place.readings:
            own = prediction.columns(reading.columns)
            lam, axes = variances(reading, own)
            left = reading.standard(misfit(reading, prediction, values))
            moved = left + reading.standard(error[:, None, reading.columns])
            total = lam + 1.0
            before = np.einsum("nlk,nl->nk", axes, left)
            after = np.einsum("nlk,bnl->bnk", axes, moved)
            log_weight -= 0.5 * np.sum((after**2 - before**2) / total, axis=2)
    every = special.logsumexp(one.log_weight[rows])
    return np.asarray(special.logsumexp(log_weight, axis=1) - every)


def _errors(prediction: Prediction, rng: np.random.Generator) -> Array:
    """Return what other runs might move the expected values by, (`OTHERS`, M), at the best draw."""
    own, factors = np.sqrt(prediction.variance[0]), prediction.factors[0]
    error = own * rng.standard_normal((OTHERS // 2, len(own)))
    error += rng.standard_normal((OTHERS // 2, factors.shape[1])) @ factors.T
    return np.vstack([error, -error])
