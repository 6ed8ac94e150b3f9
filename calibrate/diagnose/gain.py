"""What an extension gains on data it has not seen: leave one experiment out.

In every fold the parameters and the strength are refitted without the held-out experiment, and
its observables are predicted with the covariance they then have. A positive difference proves
nothing by itself; it counts only above the 95 % quantile of the same number on imagined data
without the effect.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibrate.arrays import Array
from calibrate.diagnose.scores import Frame, marginal
from calibrate.diagnose.stack import Stack


@dataclass(frozen=True)
class Gain:
    """Held-out gain of one candidate.

    Attributes
    ----------
    candidate : str
    rms_before, rms_after : float
        Root mean square of held-out residuals in standard deviations.
    elpd : float
        Difference of the log predictive density, extended minus base, summed over folds.
    null95 : float
        95 % quantile of `elpd` on imagined data without the effect.
    claimed : bool
        Whether `elpd` exceeds both zero and `null95`.
    """

    candidate: str
    rms_before: float
    rms_after: float
    elpd: float
    null95: float
    claimed: bool


def held_out(stack: Stack, one: Frame, column: int | None, prior_sd: float) -> tuple[Array, Array]:
    """Log predictive density and mean squared z over all folds, leading axes kept.

    Parameters
    ----------
    column : int, optional
        Candidate that is refitted in every fold, None for the base model.
    prior_sd : float
        Weak prior of its strength; it decides only where the other experiments say nothing.
    """
    blocks = list(stack.blocks.values())
    n = len(stack.y)
    base = marginal(one.covariance, one.by_u)
    density = np.zeros(one.residual.shape[:-1])
    squares = np.zeros_like(density)
    for rows in blocks:
        out = np.arange(n)[rows]
        kept = np.delete(np.arange(n), out)
        matrix = base
        if column is not None:
            g = one.by_phi[..., column]
            use = _sign_allowed(one, base, g, kept, (column, prior_sd))
            extra = prior_sd**2 * g[..., :, None] * g[..., None, :]
            matrix = base + use[..., None, None] * extra
        predicted = _predict(matrix, one.residual, kept, out)
        density += predicted[0]
        squares += predicted[1]
    return density, squares / n


def _sign_allowed(
    one: Frame, base: Array, g: Array, kept: Array, which: tuple[int, float]
) -> Array:
    """One where the fold's strength has a possible sign, zero where the limit takes it off."""
    column, prior_sd = which
    if len(kept) == 0:
        return np.zeros(one.residual.shape[:-1])
    inner = base[..., kept[:, None], kept[None, :]]
    inner = np.broadcast_to(inner, (*one.residual.shape[:-1], len(kept), len(kept)))
    signature = np.broadcast_to(g, one.residual.shape)[..., kept]
    weighted = np.linalg.solve(inner, one.residual[..., kept, None])[..., 0]
    strength = np.sum(signature * weighted, axis=-1)
    allowed_up = (strength > 0.0) & (one.upper[column] > 0.0)
    allowed_down = (strength < 0.0) & (one.lower[column] < 0.0)
    return np.asarray(allowed_up | allowed_down, dtype=np.float64) * (prior_sd > 0.0)


def _predict(matrix: Array, residual: Array, kept: Array, out: Array) -> tuple[Array, Array]:
    """Log density of the held-out rows and their squared z summed."""
    shape = (*residual.shape[:-1], *matrix.shape[-2:])
    matrix = np.broadcast_to(matrix, shape)
    inner = matrix[..., kept[:, None], kept[None, :]]
    cross = matrix[..., out[:, None], kept[None, :]]
    lever = np.swapaxes(np.linalg.solve(inner, np.swapaxes(cross, -1, -2)), -1, -2)
    error = residual[..., out] - (lever @ residual[..., kept, None])[..., 0]
    cov = matrix[..., out[:, None], out[None, :]] - lever @ np.swapaxes(cross, -1, -2)
    white = np.linalg.solve(cov, error[..., None])[..., 0]
    power = np.sum(error * white, axis=-1)
    logdet = np.linalg.slogdet(cov)[1]
    density = -0.5 * (power + logdet + len(out) * np.log(2.0 * np.pi))
    variance = np.diagonal(cov, axis1=-2, axis2=-1)
    return density, np.sum(error**2 / variance, axis=-1)


def gain(stack: Stack, one: Frame, nulls: Frame, candidate: str) -> Gain:
    """Held-out gain of one candidate against its distribution without any effect.

    Parameters
    ----------
    one : Frame
        Frame of the base fit.
    nulls : Frame
        Imagined studies without an effect, leading axis B.
    """
    names = [c.name for c in stack.problem.candidates]
    column = names.index(candidate)
    chosen = stack.problem.candidates[column]
    sd = 0.5 * max(abs(chosen.lower), abs(chosen.upper))
    before, z_before = held_out(stack, one, None, 0.0)
    after, z_after = held_out(stack, one, column, sd)
    null = held_out(stack, nulls, column, sd)[0] - held_out(stack, nulls, None, 0.0)[0]
    elpd = float(after - before)
    null95 = float(np.quantile(null, 0.95))
    return Gain(
        candidate=candidate,
        rms_before=float(np.sqrt(z_before)),
        rms_after=float(np.sqrt(z_after)),
        elpd=elpd,
        null95=null95,
        claimed=elpd > max(0.0, null95),
    )
