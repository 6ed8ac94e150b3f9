"""Maxima of the posterior by Newton's method, and the mixture of normals that they suggest."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from scipy import special

from calibrate.arrays import Array
from calibrate.inference.likelihood import IMPOSSIBLE
from calibrate.inference.sampler.mixture import Mixture
from calibrate.inference.sampler.target import Density

__all__ = ["climb", "curvature_width", "mixture_of"]

DOF: Final = 8.0
"""Degrees of freedom of proposals: heavier than a posterior's tails, not so heavy as to waste."""

_ITERATIONS: Final = 60
_SETTLED: Final = 1e-4  # expected gain of a step, in nats, at which a search ends
_LONGEST: Final = 4.0  # prior deviations that one step may go
_FRACTIONS: Final = np.array([1.0, 0.5, 0.25, 0.1, 0.03, 0.01, 0.001])
_POOR: Final = 20.0  # nats below the best evidence at which a mode is dropped
_PART: Final = 0.02  # of a width, a correlation or a centre in widths: its last digit
_SAME: Final = 2.0  # standard deviations within which two searches have found the same mode


def mixture_of(found: list[tuple[Array, float, Array]]) -> Mixture:
    """Return a component for every different mode among what `climb` returned."""
    height = np.array([value for _, value, _ in found])
    volume = np.array([0.5 * np.linalg.slogdet(c)[1] for _, _, c in found])
    evidence = height + volume
    kept: list[int] = []
    for k in np.argsort(-evidence):
        if evidence[k] < evidence.max() - _POOR:
            break
        inverse = np.linalg.inv(found[k][2])
        apart = [found[k][0] - found[i][0] for i in kept]
        if all(float(d @ inverse @ d) > _SAME**2 for d in apart):
            kept.append(int(k))
    share = np.maximum(np.round(special.softmax(evidence[kept]), 3), 1e-3)
    widths = np.array([_coarse(found[k][2]) for k in kept])
    grid = _PART * np.sqrt(np.diagonal(widths, axis1=1, axis2=2))
    centres = np.round(np.array([found[k][0] for k in kept]) / grid) * grid
    return Mixture(share / share.sum(), centres, widths, DOF)


def climb(target: Density, z: Array) -> tuple[Array, float, Array]:
    """Return a maximum of the log posterior near z, its value and the covariance there."""
    value = float(target.log_posterior(z[None])[0])
    covariance = np.eye(len(z))
    for _ in range(_ITERATIONS):
        gradient, hessian = target.derivatives(z)
        covariance = _positive_inverse(-hessian)
        step = covariance @ gradient
        gain = 0.5 * float(gradient @ step)
        if gain < _SETTLED:
            break
        step *= min(1.0, _LONGEST / max(float(np.abs(step).max()), math.ulp(1.0)))
        trials = z + _FRACTIONS[:, None] * step
        values = target.log_posterior(trials)
        best = int(np.argmax(values))
        if values[best] <= max(value, IMPOSSIBLE):
            break
        z, value = trials[best], float(values[best])
    return z, value, covariance


def curvature_width(target: Density, z: Array) -> Array:
    """Return the covariance of the normal that is as curved as the posterior at z, (K, K)."""
    return _coarse(_positive_inverse(-target.derivatives(z)[1]))


def _coarse(covariance: Array) -> Array:
    """Return nearly the same covariance, of widths and correlations with few digits.

    Second differences lose half of all digits; what is left of them is the processor's, and one
    proposal that is taken here and not there makes all that follow others. Any proposal serves.
    """
    width = np.sqrt(np.diag(covariance))
    root = np.round(np.linalg.cholesky(covariance) / width[:, None] / _PART) * _PART
    np.fill_diagonal(root, np.maximum(np.diag(root), _PART))
    root *= np.exp(np.round(np.log(width) / _PART) * _PART)[:, None]
    return np.asarray(root @ root.T)


def _positive_inverse(precision: Array) -> Array:
    """Return the inverse of a precision; what is not curved downwards gets the prior's width."""
    values, axes = np.linalg.eigh(precision)
    # The prior alone has precision 1; a direction flatter than half of that is no maximum.
    safe = np.where(values > 0.5, values, np.maximum(np.abs(values), 1.0))
    return np.asarray((axes / safe) @ axes.T)
