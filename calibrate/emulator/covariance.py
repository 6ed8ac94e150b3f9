"""Covariance of runs: what one run says about another.

    y = trend + f(u) + sum over effects of s (slope + g(u)) + offset of the seed + noise

f and g are smooth with one correlation length per input (Matern 5/2) and share these lengths:
an effect has too few runs to tell its own. Trend and slopes are linear with wide normal priors, so
that data decide them; what is left are `Hyper`, learnt from the runs. Outputs are standardised
before, strengths divided by their root mean square.

Symbols: z = u / lengths, r distance of two z, M the Matern correlation, S strengths (n, k).

References
----------
Rasmussen & Williams, Gaussian Processes for Machine Learning (2006), eq. 4.17 (Matern 5/2) and
5.9 (gradient of the likelihood).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.linalg import blas

from calibrate.arrays import Array
from calibrate.emulator.correlations import matern_of

__all__ = [
    "Design",
    "Hyper",
    "Parts",
    "covariance",
    "cross",
    "fixed",
    "gradient",
    "matern_between",
    "matern_to",
    "prior_variance",
    "turned",
    "whitened",
]

TREND: Final = 25.0
"""Prior variance of the mean and of each slope: five standard deviations over a range."""
SLOPE: Final = 25.0
"""Prior variance of an effect's mean influence per squared ordinary strength."""
MIDDLE: Final = 0.5
"""Inputs are on [0, 1]; the trend turns about their middle."""
ROOT_5: Final = float(np.sqrt(5.0))


@dataclass(frozen=True)
class Hyper:
    """What is learnt of a covariance.

    Attributes
    ----------
    lengths : (d,) float64
        Correlation lengths in ranges of the inputs.
    surface : float
        Variance of f, in variances of the output.
    bends : (k,) float64
        Variance of g of each acting effect, per squared strength.
    offset : float
        Variance of what runs with one seed have in common.
    noise : float
        Variance of what is left.
    """

    lengths: Array
    surface: float
    bends: Array
    offset: float
    noise: float

    @property
    def count(self) -> int:
        """How many numbers these are; the offset counts only where it is there."""
        return len(self.lengths) + len(self.bends) + 2 + (self.offset > 0.0)


@dataclass(frozen=True)
class Design:
    """Runs, or places of prediction, as the covariance sees them.

    Attributes
    ----------
    u : (n, d) float64
    strengths : (n, k) float64
        Acting effects only, in root mean squares.
    seeds : (n,) float64
        nan: a seed of its own.
    """

    u: Array
    strengths: Array
    seeds: Array

    @property
    def same_seed(self) -> Array:
        """Whether two runs share their seed, (n, n) bool; every run does so with itself."""
        found = np.equal.outer(self.seeds, self.seeds)
        np.fill_diagonal(found, val=True)
        return found


@dataclass(frozen=True)
class Parts:
    """Pieces of a covariance that its gradient needs again, each (n, n).

    Attributes
    ----------
    matern, steepness : (n, n) float64
        M, and its derivative: dM / d log length_k = steepness * (difference of z_k)^2.
    amplitude : (n, n) float64
        surface + S bends S^T.
    same : (n, n) bool
    """

    matern: Array
    steepness: Array
    amplitude: Array
    same: Array


def _distance(a: Array, b: Array) -> Array:
    """Return sqrt(5) r between rows."""
    squared = a @ (-2.0 * b.T)
    squared += np.einsum("ij,ij->i", a, a)[:, None]
    squared += np.einsum("ij,ij->i", b, b)
    np.maximum(squared, 0.0, out=squared)
    np.sqrt(squared, out=squared)
    squared *= ROOT_5
    return np.asarray(squared)


def matern_between(a: Array, b: Array) -> Array:
    """Return M between rows that are divided by the lengths, (n_a, n_b).

    One product gives all squared distances.
    """
    return matern_to(a, turned(b))


def turned(b: Array) -> Array:
    """Return what `matern_to` needs of rows (n_b, d) that stay the same, (d + 2, n_b)."""
    b = ROOT_5 * b
    return np.column_stack([b, np.ones(len(b)), np.einsum("ij,ij->i", b, b)]).T


def matern_to(a: Array, theirs: Array) -> Array:
    """Return M between rows (n_a, d) that are divided by the lengths and those of `turned`."""
    a = ROOT_5 * a
    mine = np.column_stack([-2.0 * a, np.einsum("ij,ij->i", a, a), np.ones(len(a))])
    return matern_of(mine @ theirs)


def whitened(inverse_factor: Array, between: Array) -> Array:
    """Return the inverse factor times the transposed rows, (n_runs, n); they are overwritten."""
    return np.asarray(blas.dtrmm(1.0, inverse_factor, between.T, lower=1, overwrite_b=1))


def _trend(a: Array, b: Array) -> Array:
    return np.asarray(TREND * ((a - MIDDLE) @ (b - MIDDLE).T) + TREND)


def covariance(hyper: Hyper, design: Design, trend: Array, same: Array) -> tuple[Array, Parts]:
    """Return the covariance of runs without the noise on its diagonal, and its pieces.

    Parameters
    ----------
    hyper : Hyper
    design : Design
        n runs.
    trend : (n, n) float64
        What does not depend on `hyper`, from `fixed`.
    same : (n, n) bool
        `Design.same_seed`.
    """
    z = design.u / hyper.lengths
    distance = _distance(z, z)
    decay = np.exp(-distance)
    steepness = (5.0 / 3.0) * (1.0 + distance) * decay
    matern = decay + distance * decay * (1.0 + distance / 3.0)
    amplitude = hyper.surface + (design.strengths * hyper.bends) @ design.strengths.T
    total = trend + amplitude * matern
    if hyper.offset:
        total += hyper.offset * same
    return total, Parts(matern, steepness, amplitude, same)


def fixed(design: Design) -> Array:
    """Return the covariance by trend and slopes, which nothing has to be learnt for, (n, n)."""
    return np.asarray(_trend(design.u, design.u) + SLOPE * (design.strengths @ design.strengths.T))


def gradient(hyper: Hyper, design: Design, parts: Parts, weight: Array) -> Array:
    """Return half the sum of `weight` times the derivative of the covariance.

    Parameters
    ----------
    hyper : Hyper
    design : Design
    parts : Parts
        From `covariance` with the same arguments.
    weight : (n, n) float64
        Symmetric; inverse covariance minus the outer product of the weights of the runs.

    Returns
    -------
    (d + 1 + k + 1 + 1,) float64
        By logarithms of lengths, surface, bends, offset and noise.
    """
    z = design.u / hyper.lengths
    steep = weight * parts.amplitude
    steep *= parts.steepness
    # Sum over pairs of G_ij (z_i - z_j)^2 = 2 (sum_i g_i z_i^2 - z^T G z), g the sums of rows.
    by_length = steep.sum(axis=1) @ z**2 - np.einsum("ik,ik->k", z, steep @ z)
    rough = weight * parts.matern
    by_surface = 0.5 * hyper.surface * rough.sum()
    S = design.strengths
    by_bend = 0.5 * hyper.bends * np.einsum("ik,ik->k", S, rough @ S)
    by_offset = 0.5 * hyper.offset * weight[parts.same].sum() if hyper.offset else 0.0
    by_noise = 0.5 * hyper.noise * np.trace(weight)
    return np.concatenate([by_length, [by_surface], by_bend, [by_offset, by_noise]])


def cross(hyper: Hyper, at: Design, runs: Design, *, seeds: bool = False) -> Array:
    """Return the covariance of expected outputs at `at` with outputs of `runs`, (n_at, n_runs).

    Parameters
    ----------
    hyper : Hyper
    at, runs : Design
    seeds : bool
        Whether `at` are runs too, whose offsets count where they share a seed.
    """
    found = matern_between(at.u / hyper.lengths, runs.u / hyper.lengths)
    acting = np.flatnonzero(at.strengths.any(axis=0))
    if len(acting):
        mine, theirs = at.strengths[:, acting], runs.strengths[:, acting]
        found *= hyper.surface + (mine * hyper.bends[acting]) @ theirs.T
        found += SLOPE * (mine @ theirs.T)
    else:
        found *= hyper.surface
    found += _trend(at.u, runs.u)
    if seeds and hyper.offset:
        found += hyper.offset * np.equal.outer(at.seeds, runs.seeds)
    return found


def prior_variance(hyper: Hyper, at: Design) -> Array:
    """Return the variance of expected outputs before any run, (n,)."""
    turned = at.u - MIDDLE
    trend = TREND * (1.0 + np.einsum("ij,ij->i", turned, turned))
    return np.asarray(trend + hyper.surface + at.strengths**2 @ (SLOPE + hyper.bends))
