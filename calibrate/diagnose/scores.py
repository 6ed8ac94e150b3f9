"""Score of every candidate at the base fit, with all parameters free, for one or many data sets.

With the parameters' weak prior integrated out, measured minus simulated has covariance
K = V + J P^-1 J^T. A candidate of signature g gains 2 phi g'K^-1 r - phi^2 g'K^-1 g at the
strength phi inside its physical limits that gains most. The score is computed with the
covariance of the base model: an error in g then cannot create a score out of nothing, it only
costs power.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibrate.arrays import Array
from calibrate.diagnose.fit import Fit
from calibrate.diagnose.stack import PRIOR_CENTRE, PRIOR_SD, Linear, Stack


@dataclass(frozen=True)
class Screen:
    """Scores of one data set, or of many with a leading axis B.

    Attributes
    ----------
    total : ndarray, shape (..., )
        Misfit of the base model after refitting all parameters.
    gain : ndarray, shape (..., c)
        Fall of the misfit when a candidate is added, all parameters refitted.
    strength : ndarray, shape (..., c)
        Strength that gains most, in steps are not used: the candidate's own unit.
    information : ndarray, shape (..., c)
        g' K^-1 g: inverse variance of the strength with all parameters free.
    """

    total: Array
    gain: Array
    strength: Array
    information: Array


@dataclass(frozen=True)
class Frame:
    """The linear model around one fit in which scores are computed.

    Attributes
    ----------
    residual : ndarray, shape (n,)
        Measured minus simulated with the parameters at the prior's centre, linearised.
    covariance : ndarray, shape (n, n)
        V at the fit.
    by_u : ndarray, shape (n, d_free)
        Slopes of the parameters that are not held at a limit.
    by_phi : ndarray, shape (n, c)
    to_centre : ndarray, shape (d_free,)
        Prior centre minus fit.
    lower, upper : ndarray, shape (c,)
        Limits of the strengths counted from the fit.
    """

    residual: Array
    covariance: Array
    by_u: Array
    by_phi: Array
    to_centre: Array
    lower: Array
    upper: Array


def frame(stack: Stack, fitted: Fit) -> Frame:
    """Linearise around a fit."""
    lin = stack.linearise(fitted.u, fitted.strengths)
    free = ~fitted.held
    to_centre = PRIOR_CENTRE - fitted.u[free]
    on = np.array([fitted.strengths.get(c.name, 0.0) for c in stack.problem.candidates])
    return Frame(
        residual=stack.y - lin.mean - lin.by_u[:, free] @ to_centre,
        covariance=stack.covariance(lin.surrogate),
        by_u=lin.by_u[:, free],
        by_phi=lin.by_phi,
        to_centre=to_centre,
        lower=np.array([c.lower for c in stack.problem.candidates]) - on,
        upper=np.array([c.upper for c in stack.problem.candidates]) - on,
    )


def marginal(covariance: Array, by_u: Array) -> Array:
    """K = V + J P^-1 J^T, shapes (..., n, n)."""
    return np.asarray(covariance + PRIOR_SD**2 * by_u @ np.swapaxes(by_u, -1, -2))


def screen(one: Frame) -> Screen:
    """Scores in a frame; every array may carry a leading axis B."""
    inverse = np.linalg.inv(marginal(one.covariance, one.by_u))
    r = one.residual[..., None]
    weighted = inverse @ r
    total = np.sum(r * weighted, axis=(-1, -2))
    slope = (np.swapaxes(one.by_phi, -1, -2) @ weighted)[..., 0]
    information = np.sum(one.by_phi * (inverse @ one.by_phi), axis=-2)
    safe = np.maximum(information, 1e-12)
    strength = np.clip(slope / safe, one.lower, one.upper)
    return Screen(total, 2.0 * strength * slope - strength**2 * information, strength, information)


@dataclass(frozen=True)
class Noise:
    """Random errors of many imagined repetitions of the whole study.

    Attributes
    ----------
    data : ndarray, shape (B, n)
        Error of the measured means, nuisances included.
    variance : ndarray, shape (B, n)
        Squared standard errors that the imagined experimenter would state.
    surrogate : Linear
        Errors of value, slopes and signatures with leading axis B.
    """

    data: Array
    variance: Array
    surrogate: Linear


def draw_noise(stack: Stack, fitted: Fit, size: int, rng: np.random.Generator) -> Noise:
    """Draw measurement and surrogate errors around a fit.

    A standard error from R repeats is itself uncertain; the stated one follows chi-square with
    R - 1 degrees of freedom, so a study of five repeats has the tails it really has.
    """
    n = len(stack.y)
    root = np.linalg.cholesky(stack.alike + 1e-9 * np.eye(n))
    data = stack.measured * (rng.standard_normal((size, n)) @ root.T)
    values, vectors = np.linalg.eigh(stack.nuisance)
    data += rng.standard_normal((size, n)) * np.sqrt(np.maximum(values, 0.0)) @ vectors.T
    stated = np.ones((size, n))
    for repeats in np.unique(stack.repeats[stack.repeats > 1]):
        rows = stack.repeats == repeats
        series = rng.standard_normal((int(repeats) - 1, size, n)) @ root.T
        stated[:, rows] = np.mean(series**2, axis=0)[:, rows]
    variance = stack.measured**2 * stated
    return Noise(data, variance, stack.draw_surrogates(fitted.u, size, rng))


def imagine(stack: Stack, fitted: Fit, one: Frame, noise: Noise, shift: Array) -> Frame:
    """Frames of repeated studies whose true mean is the fit's plus `shift`, shape (n,)."""
    free = ~fitted.held
    by_u = one.by_u + noise.surrogate.by_u[:, :, free]
    fixed = one.covariance - stack.alike * np.outer(stack.measured, stack.measured)
    stated = np.sqrt(noise.variance)
    covariance = fixed + stack.alike * stated[:, :, None] * stated[:, None, :]
    residual = shift + noise.data - noise.surrogate.mean - by_u @ one.to_centre
    return Frame(
        residual=residual,
        covariance=covariance,
        by_u=by_u,
        by_phi=one.by_phi + noise.surrogate.by_phi,
        to_centre=one.to_centre,
        lower=one.lower,
        upper=one.upper,
    )
