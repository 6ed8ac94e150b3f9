"""One number of one experiment: a Gaussian process conditioned on runs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.linalg import cho_solve, cholesky, lapack

from calibrate.arrays import Array
from calibrate.emulator.covariance import (
    Design,
    Hyper,
    covariance,
    cross,
    fixed,
    prior_variance,
    whitened,
)
from calibrate.emulator.types import Inputs

__all__ = ["Form", "LeftOut", "Process", "Runs", "condition"]

MOST_LEARNT: Final = 3.0
"""Largest factor on variances for hyperparameters that few runs tell."""
JITTER: Final = 1e-8
"""Added to variances of standardised outputs: near neighbours make them singular in rounding."""
CHUNK: Final = 256
"""Rows predicted at once: their covariances with the runs stay in the processor's cache."""


@dataclass(frozen=True)
class Runs:
    """Runs of one number that went well.

    Attributes
    ----------
    inputs : Inputs
        n runs.
    y : (n,) float64
        On the model scale, no nan.
    believed : (n,) bool
        False for an outlier, which is kept for the record and says nothing.
    """

    inputs: Inputs
    y: Array
    believed: Array

    def joined(self, other: Runs) -> Runs:
        """Return these runs with others behind."""
        return Runs(
            self.inputs.joined(other.inputs),
            np.concatenate([self.y, other.y]),
            np.concatenate([self.believed, other.believed]),
        )


@dataclass(frozen=True)
class Form:
    """What is learnt or fixed before a process is conditioned on runs.

    Attributes
    ----------
    hyper : Hyper
    shift, scale : float
        Outputs are modelled as (y - shift) / scale; scale 0 for an output that never changes.
    acting : (k,) int
        Effects that some run has on; the others do not act.
    unit : (k,) float64
        Strengths are divided by these.
    """

    hyper: Hyper
    shift: float
    scale: float
    acting: Array
    unit: Array

    @property
    def noise(self) -> float:
        """Variance of one run about the expected output, by its seed and by what is left."""
        return (self.hyper.noise + self.hyper.offset) * self.scale**2

    def design(self, inputs: Inputs) -> Design:
        """Return inputs as the covariance sees them."""
        return Design(inputs.u, inputs.strengths[:, self.acting] / self.unit, inputs.seeds)

    def standard(self, y: Array) -> Array:
        """Return outputs as the covariance sees them."""
        return np.asarray((y - self.shift) / self.scale if self.scale else np.zeros_like(y))


@dataclass(frozen=True)
class LeftOut:
    """Every run predicted from the runs at other points, hyperparameters held.

    Attributes
    ----------
    y, mean : (n,) or (n, L) float64
        Seen, and predicted.
    variance : same shape, float64
        Expected square of their difference, noise of the run included, before inflation.
    noise : same shape, float64
        The noise in it.
    """

    y: Array
    mean: Array
    variance: Array
    noise: Array

    @property
    def z(self) -> Array:
        """Differences in units of their expected size; 0 where nothing ever changes."""
        size = np.sqrt(self.variance)
        away = self.y - self.mean
        return np.asarray(np.divide(away, size, out=np.zeros_like(size), where=size > 0.0))


@dataclass(frozen=True)
class Process:
    """A trained process.

    Attributes
    ----------
    form : Form
    runs : Runs
    left_out : LeftOut
        Of all runs; outliers are predicted from the others.
    inflation : float
        Factor on predicted variances, 1 or more.
    """

    form: Form
    runs: Runs
    left_out: LeftOut
    inflation: float
    _design: Design
    _inverse_factor: Array
    _weights: Array

    @property
    def z_rms(self) -> float:
        """Root mean square of the left-out errors of believed runs in expected sizes."""
        return float(np.sqrt(np.mean(self.left_out.z[self.runs.believed] ** 2)))

    def predict(self, inputs: Inputs) -> tuple[Array, Array]:
        """Return mean and variance of the expected output at n inputs, each (n,)."""
        mean, variance = _predicted(
            self.form, self._design, self._inverse_factor, self._weights, inputs
        )
        return mean, self.inflation * variance

    def errors(self, inputs: Inputs, count: int, rng: np.random.Generator) -> Array:
        """Return draws of how far `predict` is off at n inputs jointly, (count, n).

        Memory and time grow with the square and the cube of n; a few thousand are seconds.
        """
        at = self.form.design(inputs)
        known = whitened(self._inverse_factor, cross(self.form.hyper, at, self._design))
        spread = cross(self.form.hyper, at, at) - known.T @ known
        spread[np.diag_indices_from(spread)] += JITTER
        factor = cholesky(spread, lower=True, overwrite_a=True, check_finite=False)
        size = np.sqrt(self.inflation) * self.form.scale
        return np.asarray(size * rng.standard_normal((count, len(inputs))) @ factor.T)

    def reduction(self, candidates: Inputs, at: Inputs) -> Array:
        """Return how much the variance at `at` is expected to fall by a run at each candidate.

        Parameters
        ----------
        candidates : Inputs
            n_candidates; one with the seed of a run shares its offset.
        at : Inputs
            n_at.

        Returns
        -------
        (n_candidates, n_at) float64
        """
        hyper = self.form.hyper
        new, seen = self.form.design(candidates), self.form.design(at)
        known_new = whitened(self._inverse_factor, cross(hyper, new, self._design, seeds=True))
        known_at = whitened(self._inverse_factor, cross(hyper, seen, self._design))
        between = cross(hyper, new, seen) - known_new.T @ known_at
        spread = prior_variance(hyper, new) + hyper.offset + hyper.noise
        spread -= np.einsum("ij,ij->j", known_new, known_new)
        # A run never tells more than its own noise lets it.
        fall = between**2 / np.maximum(spread, hyper.noise)[:, None]
        return np.asarray(self.inflation * self.form.scale**2 * fall)

    def updated(self, runs: Runs) -> Process:
        """Return the process with new runs, hyperparameters held."""
        return condition(self.form, self.runs.joined(runs))


def _chunks(n: int) -> Iterator[slice]:
    for start in range(0, n, CHUNK):
        yield slice(start, min(start + CHUNK, n))


def _predicted(
    form: Form, design: Design, inverse_factor: Array, weights: Array, inputs: Inputs
) -> tuple[Array, Array]:
    """Return mean and variance, not inflated, of expected outputs."""
    at = form.design(inputs)
    mean, variance = np.empty(len(inputs)), prior_variance(form.hyper, at)
    for rows in _chunks(len(inputs)):
        part = Design(at.u[rows], at.strengths[rows], at.seeds[rows])
        between = cross(form.hyper, part, design)
        mean[rows] = between @ weights
        known = whitened(inverse_factor, between)
        variance[rows] -= np.einsum("ij,ij->j", known, known)
    np.maximum(variance, 0.0, out=variance)
    return form.shift + form.scale * mean, form.scale**2 * variance


def condition(form: Form, runs: Runs) -> Process:
    """Return a process conditioned on runs."""
    trusted = runs.inputs.rows(runs.believed)
    design = form.design(trusted)
    hyper = form.hyper
    total, _ = covariance(hyper, design, fixed(design), design.same_seed)
    total[np.diag_indices_from(total)] += hyper.noise
    factor = cholesky(total, lower=True, overwrite_a=True, check_finite=False)
    inverse_factor, _ = lapack.dtrtri(factor, lower=1)
    standard = form.standard(runs.y[runs.believed])
    weights = cho_solve((factor, True), standard, check_finite=False)
    mean, variance = np.empty(len(runs.y)), np.empty(len(runs.y))
    residual, spread = _leave_out(trusted.u, inverse_factor, weights)
    mean[runs.believed] = runs.y[runs.believed] - form.scale * residual
    variance[runs.believed] = form.scale**2 * spread
    doubted = ~runs.believed
    if doubted.any():
        others = runs.inputs.rows(doubted)
        found = _predicted(form, design, inverse_factor, weights, others)
        mean[doubted], variance[doubted] = found[0], found[1] + form.noise
    left_out = LeftOut(runs.y, mean, variance, np.full_like(mean, form.noise))
    inflation = max(1.0, float(np.mean(left_out.z[runs.believed] ** 2)))
    inflation *= _learnt_from(len(np.unique(trusted.u, axis=0)), hyper.count)
    return Process(form, runs, left_out, inflation, design, inverse_factor, weights)


def _learnt_from(points: int, learnt: int) -> float:
    """Return by how much variances are too small because hyperparameters came from the same runs.

    Left-out errors do not show it, as the hyperparameters were fitted to the runs that are left
    out. The factor (n + p) / (n - p) for p numbers learnt from n points is Akaike's for predictions
    (final prediction error); on recorded runs it is right to 20 % (`benchmarks/emulator.py`).

    References
    ----------
    Akaike, Annals of the Institute of Statistical Mathematics 21, 243-247 (1969).
    """
    return min((points + learnt) / max(points - learnt, 1), MOST_LEARNT)


def _leave_out(u: Array, inverse_factor: Array, weights: Array) -> tuple[Array, Array]:
    """Return residuals and variances of runs, all those of one point left out together.

    References
    ----------
    Rasmussen & Williams (2006), eq. 5.12, for groups: with A the block of the inverse covariance
    that belongs to a group, its residuals are A^-1 times its weights and their covariance A^-1.
    """
    _, point = np.unique(u, axis=0, return_inverse=True)
    residual, variance = np.empty(len(u)), np.empty(len(u))
    order = np.argsort(point, kind="stable")
    for at in np.split(order, np.flatnonzero(np.diff(point[order])) + 1):
        columns = inverse_factor[:, at]
        spread = np.linalg.inv(columns.T @ columns)
        residual[at] = spread @ weights[at]
        variance[at] = np.diag(spread)
    return residual, variance
