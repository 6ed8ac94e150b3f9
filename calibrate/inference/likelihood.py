"""How probable the readings are: one likelihood for every question.

A reading y of L levels was measured with standard errors s from n repeats. At parameters theta

    p(y) = integral p(w) N(y; m + sum_k b_k eta_k, V + w diag(s^2)) dw

with m, V mean and covariance of the emulator, b_k eta_k the errors shared with other readings, and
w the true over the stated error variance: s^2 from n repeats leaves (n - 1) / w ~ chi^2(n - 1).
Without V this is Student's t with n - 1 degrees of freedom. One w serves all levels of a curve.

Where the model may be wrong about a reading (`Discrepancy`), p(y) is the mean of this density and
of the one with the discrepancy among the errors, weighted with the chance; so a reading that
nothing can meet costs a finite price and does not bend everything else.

The errors of the levels of a curve may go together: then diag(s^2) is their covariance. V relative
to it is diagonalised once for each theta, which turns a curve into L independent
numbers whose variance is lambda_l + w; the integral over ln w is then a sum over a few dozen nodes.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from typing import Final

import numpy as np
from scipy import special

from calibrate.arrays import Array, log_sum
from calibrate.emulator.types import Prediction
from calibrate.inference.problem import Place, Problem, Reading

__all__ = [
    "IMPOSSIBLE",
    "SIZES",
    "discrepancy_probability",
    "log_density",
    "log_likelihood",
    "log_terms",
    "nodes",
    "variances",
]

IMPOSSIBLE: Final = -1e100
"""Logarithm that stands for no probability; finite, so that samplers may add and compare it."""

CHUNK: Final = 2000
"""Points at a time, so that nodes x levels x points stay within the caches' reach."""

SIZES: Final = ((1.0, 0.98), (5.0, 0.02))
"""Sizes of a discrepancy, in its loading, with their shares: a huge one is possible, too. With
normal tails a gross mistake in one target would be paid for by giving up several others."""

_LOG_2PI: Final = math.log(2.0 * math.pi)
_TAIL: Final = 1e-9  # probability of w that is left out on the narrow side
_WIDEST: Final = 1e8  # largest w: the tails are Student's up to 1000 standard errors, then normal
_STEP: Final = 1.0  # spacing of nodes over the narrowest width in ln w: relative error below 1e-8


@cache
def nodes(repeats: int, levels: int) -> tuple[Array, Array]:
    """Return nodes w and the logarithms of their weights, (q,) each.

    Parameters
    ----------
    repeats : int
        0 for an error that is known: one node, w = 1.
    levels : int
        Length of the reading; the integrand is the narrower, the longer it is.

    Notes
    -----
    The trapezoidal rule in ln w converges exponentially, and its error does not grow far from the
    data as that of Gauss rules does.
    """
    if repeats == 0:
        return np.ones(1), np.zeros(1)
    dof = repeats - 1
    step = _STEP * math.sqrt(2.0 / (dof + levels))
    lowest = math.log(dof / (2.0 * float(special.gammainccinv(0.5 * dof, _TAIL))))
    x = np.arange(lowest, math.log(_WIDEST), step)
    # density of ln w for w = dof / chi^2: Gamma in 1/w
    log_p = 0.5 * dof * (math.log(0.5 * dof) - x - np.exp(-x)) - special.gammaln(0.5 * dof)
    log_p -= special.logsumexp(log_p)
    return np.exp(x), log_p


def variances(reading: Reading, own: Prediction) -> tuple[Array, Array]:
    """Return eigenvalues, (n, L), and axes, (n, L, L), of V relative to the measurement's errors.

    Parameters
    ----------
    reading : Reading
    own : Prediction
        Of its columns only.
    """
    factors = own.factors
    if reading.extra is not None:
        more = np.broadcast_to(reading.extra, (len(own.mean), *reading.extra.shape))
        factors = np.concatenate([factors, more], axis=2)
    count = len(reading.se)
    v = own.variance / reading.se**2
    if count == 1:
        total = v + np.sum(factors**2, axis=2) / reading.se**2
        return total, np.ones((len(v), 1, 1))
    if factors.shape[2] == 0 and reading.together is None:
        return v, np.broadcast_to(np.eye(count), (len(v), count, count))
    if reading.together is None:
        scaled = factors / reading.se[:, None]
        alone = v[:, :, None] * np.eye(count)
    else:
        turn = np.linalg.inv(reading.root)
        scaled = turn @ factors
        alone = (turn * own.variance[:, None, :]) @ turn.T
    relative: Array = scaled @ np.swapaxes(scaled, 1, 2)
    values, axes = np.linalg.eigh(relative + alone)
    return np.maximum(values, 0.0), axes


def misfit(reading: Reading, prediction: Prediction, values: Array) -> Array:
    """Return measured minus expected, shared errors taken off, (n, L)."""
    difference = reading.y - prediction.mean[:, reading.columns]
    for index, loading in reading.shared:
        difference = difference - values[:, [index]] * loading
    return np.asarray(difference)


def log_density(reading: Reading, prediction: Prediction, values: Array) -> Array:
    """Return the log density of a reading at n points, (n,).

    `IMPOSSIBLE` where the emulator predicts nothing.
    """
    if reading.discrepancy is None:
        return _log_density(reading, prediction, values)
    return np.asarray(np.logaddexp(*_both_ways(reading, prediction, values)))


def discrepancy_probability(reading: Reading, prediction: Prediction, values: Array) -> Array:
    """Return how probable it is at n points that the model is wrong about a reading, (n,)."""
    held, missed = _both_ways(reading, prediction, values)
    return np.asarray(special.expit(missed - held))


def _both_ways(reading: Reading, prediction: Prediction, values: Array) -> tuple[Array, Array]:
    """Return the log density with its chance if the model holds and if it does not, (n,) each."""
    discrepancy = reading.discrepancy
    if discrepancy is None:
        return _log_density(reading, prediction, values), np.full(len(values), IMPOSSIBLE)
    own = [] if reading.extra is None else [reading.extra]
    missed = [
        math.log(share)
        + _log_density(
            replace(reading, extra=np.column_stack([*own, size * discrepancy.loading])),
            prediction,
            values,
        )
        for size, share in SIZES
    ]
    held = math.log1p(-discrepancy.chance) + _log_density(reading, prediction, values)
    return held, math.log(discrepancy.chance) + np.logaddexp(*missed)


def _log_density(reading: Reading, prediction: Prediction, values: Array) -> Array:
    count = len(reading.se)
    difference = misfit(reading, prediction, values)
    own = prediction.columns(reading.columns)
    good = np.isfinite(difference).all(axis=1) & np.isfinite(own.total).all(axis=1)
    result = np.full(len(values), IMPOSSIBLE)
    if reading.repeats == 0:
        some = Prediction(own.mean[good], own.variance[good], own.factors[good])
        result[good] = _normal(reading, some, difference[good])
        return result
    lam, axes = variances(
        reading, Prediction(own.mean[good], own.variance[good], own.factors[good])
    )
    r = np.einsum("nlk,nl->nk", axes, reading.standard(difference[good]))
    w, log_weight = nodes(reading.repeats, count)
    total = lam[:, None, :] + w[:, None]  # (n, q, L)
    squares = np.square(r)[:, None, :] / total
    squares += np.log(total)
    power = squares[:, :, 0] if count == 1 else squares.sum(axis=2)
    power *= -0.5
    power += log_weight
    size = np.log(reading.se) if reading.together is None else np.log(np.diag(reading.root))
    constant = float(np.sum(size)) + 0.5 * count * _LOG_2PI
    result[good] = log_sum(power) - constant
    return result


def _normal(reading: Reading, own: Prediction, difference: Array) -> Array:
    """Return the log density of readings whose errors are known, (n,)."""
    count = len(reading.se)
    if count == 1:
        total = own.variance[:, 0] + reading.se[0] ** 2 + np.sum(own.factors[:, 0] ** 2, axis=1)
        if reading.extra is not None:
            total = total + float(np.sum(reading.extra**2))
        return np.asarray(-0.5 * (difference[:, 0] ** 2 / total + np.log(total) + _LOG_2PI))
    covariance = own.factors @ np.swapaxes(own.factors, 1, 2)
    if reading.extra is not None:
        covariance = covariance + reading.extra @ reading.extra.T
    at = np.arange(count)
    covariance[:, at, at] += own.variance
    covariance += reading.covariance
    root = np.linalg.cholesky(covariance)
    turned = np.linalg.solve(root, difference[:, :, None])[:, :, 0]
    power = -0.5 * np.sum(turned**2, axis=1) - np.sum(np.log(root[:, at, at]), axis=1)
    return np.asarray(power - 0.5 * count * _LOG_2PI)


def log_terms(problem: Problem, values: Array) -> Array:
    """Return the log density of every reading, then of every known value, (n, R + known)."""
    parts = [_chunk(problem, values[i : i + CHUNK]) for i in range(0, len(values), CHUNK)]
    return np.concatenate(parts)


def place_terms(place: Place, values: Array) -> Array:
    """Return the log density of every reading of one place, (n, readings)."""
    prediction = place.predict(values)
    columns = [log_density(reading, prediction, values) for reading in place.readings]
    return np.column_stack(columns) if columns else np.zeros((len(values), 0))


def _chunk(problem: Problem, values: Array) -> Array:
    columns = [place_terms(place, values) for place in problem.places]
    for known in problem.known:
        z = (values[:, known.index] - known.value) / known.se
        columns.append((-0.5 * z**2 - math.log(known.se) - 0.5 * _LOG_2PI)[:, None])
    return np.concatenate([np.zeros((len(values), 0)), *columns], axis=1)


def log_likelihood(problem: Problem, values: Array) -> Array:
    """Return the log probability of all data, (n,), for values (n, K); never below `IMPOSSIBLE`."""
    return np.asarray(np.maximum(log_terms(problem, values).sum(axis=1), IMPOSSIBLE))
