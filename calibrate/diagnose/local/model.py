"""A local surrogate of one experiment's mean, with the covariance of all it does not know.

Bayesian regression on the design's runs: value, slopes and curvatures of the base parameters,
slope and curvature of every candidate. Slopes are free; curvatures and interactions share a
normal prior whose width `tau` is found from the runs, so what a design cannot resolve stays in
the predictive covariance as surrogate error. Runs with one seed share a random offset of
variance fraction `rho` (common random numbers), which cancels in slopes.

Symbols: v = (u - centre) / half width; p = phi / step; f(v, p) the features; beta their weights.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from calibrate.arrays import Array
from calibrate.diagnose.local.design import Point
from calibrate.diagnose.problem import Problem
from calibrate.errors import CalibrationError
from calibrate.scales import forward

# Prior sd of the free slopes in units of the noise sd: large enough to leave them free.
_FREE = 300.0
_CUBIC = 1.0 / 3.0
_TAUS = (0.0, 0.3, 0.7, 1.5, 3.0, 7.0, 15.0, 40.0)
_RHOS = (0.0, 0.3, 0.6, 0.9)
# Noise correlations between observables come from few residuals: shrink them a little.
_SHRINK = 0.9


@dataclass(frozen=True)
class LocalSurrogate:
    """Posterior of the regression for all observables of one experiment.

    Attributes
    ----------
    quantities : tuple of str
        Observables, length q.
    free : ndarray of int, shape (d,)
        Positions of the active parameters.
    effects : tuple of str
        Effects that touch the experiment, length c.
    steps : ndarray, shape (c,)
        Their probing strengths.
    centre : ndarray, shape (d,)
    half_width : float
    beta : ndarray, shape (q, p)
        Posterior mean of the weights on the fit's scale.
    factor : ndarray, shape (q, p, p)
        Symmetric root of the posterior covariance, inflation included.
    correlation : ndarray, shape (q, q)
        Correlation of the simulation noise between observables.
    noise_sd : ndarray, shape (q,)
        Scatter of a single run between seeds.
    zrms : ndarray, shape (q,)
        Root mean square of leave-one-out residuals over their standard deviation.
    runs : int
        Number of successful runs behind it.
    """

    quantities: tuple[str, ...]
    free: Array
    effects: tuple[str, ...]
    steps: Array
    centre: Array
    half_width: float
    beta: Array
    factor: Array
    correlation: Array
    noise_sd: Array
    zrms: Array
    runs: int

    def local(self, u: Array) -> Array:
        """Coordinates v of a point in the trusted region, shape (d,)."""
        return np.asarray((u[self.free] - self.centre) / self.half_width)

    def scaled(self, strengths: dict[str, float]) -> Array:
        """Effect strengths in steps, shape (c,)."""
        named = np.array([strengths.get(name, 0.0) for name in self.effects])
        return named / self.steps if len(self.effects) else np.zeros(0)

    def error(self, f: Array) -> Array:
        """Covariance of the mean between observables at features f, shape (q, q)."""
        sd = np.linalg.norm(f @ self.factor, axis=1)
        return np.asarray(np.outer(sd, sd) * self.correlation)


@functools.cache
def _pairs(d: int) -> tuple[Array, Array, Array, Array]:
    """Return indices i <= j of all products of d coordinates, both also as one-hot rows."""
    i, j = np.triu_indices(d)
    return i, j, np.eye(d)[i], np.eye(d)[j]


def features(v: Array, p: Array) -> tuple[Array, Array]:
    """Features at many points, and which of them are free of shrinkage.

    Parameters
    ----------
    v : ndarray, shape (n, d)
    p : ndarray, shape (n, c)

    Returns
    -------
    ndarray, shape (n, 1 + d + c + d(d+1)/2 + d + c + c d)
        Constant, slopes, curvatures and interactions of v, cubes of v (a third as wide in the
        prior), curvature of p, p times v.
    ndarray of bool
        True for constant and slopes.
    """
    n, d = v.shape
    c = p.shape[1]
    i, j, _, _ = _pairs(d)
    mixed = (p[:, :, None] * v[:, None, :]).reshape(n, c * d)
    parts = [np.ones((n, 1)), v, p, v[:, i] * v[:, j], _CUBIC * v**3, p**2, mixed]
    f = np.concatenate(parts, axis=1)
    free = np.zeros(f.shape[1], dtype=bool)
    free[: 1 + d + c] = True
    return f, free


def derivatives(v: Array, p: Array) -> tuple[Array, Array]:
    """Return derivatives by v, shape (d, n_f), and by p, shape (c, n_f), at a point."""
    d, c = len(v), len(p)
    i, j, at_i, at_j = _pairs(d)
    quad = 1 + d + c
    cubic = quad + len(i)
    square = cubic + d
    last = square + c
    by_v = np.zeros((d, last + c * d))
    by_p = np.zeros((c, last + c * d))
    by_v[:, 1 : 1 + d] = np.eye(d)
    by_p[:, 1 + d : quad] = np.eye(c)
    by_v[:, quad:cubic] = (at_i * v[j, None] + at_j * v[i, None]).T
    by_v[:, cubic:square] = np.diag(3.0 * _CUBIC * v**2)
    by_p[:, square:last] = np.diag(2.0 * p)
    by_v[:, last:] = (p[None, :, None] * np.eye(d)[:, None, :]).reshape(d, c * d)
    by_p[:, last:] = (np.eye(c)[:, :, None] * v).reshape(c, c * d)
    return by_v, by_p


@dataclass(frozen=True)
class _Weights:
    beta: Array
    factor: Array
    sigma: float
    zrms: float
    residual: Array


def _kernels(f: Array, free: Array, seeds: Array) -> list[tuple[Array, Array, float]]:
    """Prior variances, Cholesky factor and log determinant for every (tau, rho)."""
    same = (seeds[:, None] == seeds[None, :]).astype(np.float64)
    linear = _FREE**2 * f[:, free] @ f[:, free].T
    curved = f[:, ~free] @ f[:, ~free].T
    found = []
    rhos = _RHOS if len(np.unique(seeds)) < len(seeds) else (0.0,)
    for rho in rhos:
        noise = (1.0 - rho) * np.eye(len(f)) + rho * same
        for tau in _TAUS:
            chol = cho_factor(noise + linear + tau**2 * curved, lower=True)[0]
            prior = np.where(free, _FREE**2, tau**2)
            found.append((prior, chol, 2.0 * float(np.log(np.diag(chol)).sum())))
    return found


def _weigh(y: Array, f: Array, free: Array, kernels: list[tuple[Array, Array, float]]) -> _Weights:
    """Choose (tau, rho) by restricted likelihood and return the posterior of the weights."""
    dof = len(y) - int(free.sum())
    centred = y - y.mean()
    # A constant observable has no scatter to weigh by; a tiny floor keeps the algebra finite.
    floor = 1e-9 * max(1.0, float(np.abs(y).max()))
    best: tuple[float, float, int] | None = None
    for index, (_, chol, logdet) in enumerate(kernels):
        power = float(centred @ cho_solve((chol, True), centred))
        variance = max(power / dof, floor**2)
        score = -0.5 * (dof * np.log(variance) + logdet)
        if best is None or score > best[0]:
            best = (score, variance, index)
    _, variance, index = best if best is not None else (0.0, floor**2, 0)
    prior, chol, _ = kernels[index]
    inverse = cho_solve((chol, True), np.eye(len(y)))
    gain = (prior[:, None] * f.T) @ inverse
    beta = gain @ centred
    beta[0] += y.mean()
    covariance = np.diag(prior) - gain @ f * prior[None, :]
    alpha = inverse @ centred
    loo = alpha / np.sqrt(np.diag(inverse) * variance)
    zrms = float(np.sqrt(np.mean(loo**2)))
    # Variance known from `dof` residuals only, and surrogates that judge themselves too well.
    scale = variance * max(1.0, zrms**2) * dof / max(dof - 2, 1)
    values, vectors = np.linalg.eigh(covariance)
    # The symmetric root, so that weights of different observables may share their luck.
    factor = vectors * np.sqrt(np.maximum(values, 0.0) * scale) @ vectors.T
    return _Weights(beta, factor, float(np.sqrt(variance)), zrms, loo)


def _noise_correlation(weights: Sequence[_Weights]) -> Array:
    """Correlation of the simulation noise between observables, shape (q, q)."""
    q = len(weights)
    if q == 1:
        return np.eye(1)
    with np.errstate(invalid="ignore"):
        raw = np.nan_to_num(np.corrcoef([w.residual for w in weights]))
    correlation = _SHRINK * raw + (1.0 - _SHRINK) * np.eye(q)
    np.fill_diagonal(correlation, 1.0)
    return np.asarray(correlation)


def _successful(
    experiment: str, outputs: Sequence[dict[str, float] | None], need: int
) -> list[int]:
    """Positions of the runs that succeeded; too few are an error with the place."""
    good = [k for k, out in enumerate(outputs) if out is not None]
    if len(good) < need:
        msg = (
            f"{experiment}: only {len(good)} of {len(outputs)} runs succeeded, at least {need} "
            "are needed for slopes and noise; look at the reasons in the case directories"
        )
        raise CalibrationError(msg)
    return good


def build(
    problem: Problem,
    experiment: str,
    points: Sequence[Point],
    outputs: Sequence[dict[str, float] | None],
    centre: Array,
    half_width: float,
) -> LocalSurrogate:
    """Fit the surrogate of one experiment.

    Parameters
    ----------
    problem : Problem
    experiment : str
        Its key in the problem.
    points, outputs : sequences of equal length
        Planned runs and their observables in their own units, None for a failed run.
    centre : ndarray, shape (n_parameters,)
        Middle of the runs on [0, 1].
    half_width : float
        Half width of a design on [0, 1].

    Raises
    ------
    CalibrationError
        When too few runs succeeded to estimate every slope and the noise.
    """
    names = [p.name for p in problem.parameters]
    free_at = np.array([names.index(n) for n in problem.active[experiment]], dtype=np.int64)
    cands = problem.probes_in(experiment)
    steps = np.array([abs(c.step) for c in cands])
    good = _successful(experiment, outputs, 4 + len(free_at) + len(cands))
    v = np.array([(points[k].u[free_at] - centre[free_at]) / half_width for k in good])
    p = np.array([[points[k].effects.get(c.effect, 0.0) for c in cands] for k in good])
    p = p.reshape(len(good), len(cands)) / steps if len(cands) else np.zeros((len(good), 0))
    f, free = features(v, p)
    kernels = _kernels(f, free, np.array([points[k].seed for k in good]))
    observed = problem.observed_in(experiment)
    weights = []
    for one in observed:
        raw = np.array([(outputs[k] or {})[one.quantity] for k in good])
        weights.append(_weigh(forward(one.scale, raw), f, free, kernels))
    return LocalSurrogate(
        quantities=tuple(o.quantity for o in observed),
        free=free_at,
        effects=tuple(c.effect for c in cands),
        steps=steps,
        centre=centre[free_at],
        half_width=half_width,
        beta=np.array([w.beta for w in weights]),
        factor=np.array([w.factor for w in weights]),
        correlation=_noise_correlation(weights),
        noise_sd=np.array([w.sigma for w in weights]),
        zrms=np.array([w.zrms for w in weights]),
        runs=len(good),
    )
