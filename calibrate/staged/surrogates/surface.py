"""Surrogate of one number over the free parameters of a stage, with honest error bars."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final, TypeAlias

import numpy as np
from scipy.interpolate import RectBivariateSpline

from calibrate.arrays import Array
from calibrate.errors import CalibrationError
from calibrate.staged.surrogates.kriging import leave_one_out, train_kriging
from calibrate.staged.surrogates.samples import Quality, Samples

__all__ = ["Surrogate", "fewest_points", "fit_surrogate"]

Predictor: TypeAlias = Callable[[Array], tuple[Array, Array]]
"""Points (k, d) in the unit cube to mean and variance, (k,) each."""

TABLE: Final = 81
TABULATED: Final = 2
"""Parameters for which predictions are read from a table; a finer space has too many cells."""
NEGLIGIBLE: Final = 1e-4
"""Weight below which a kind of Kriging is not asked."""
KINDS: Final = (("matern52", "linear"), ("squar_exp", "linear"), ("squar_exp", "constant"))


@dataclass(frozen=True)
class Surrogate:
    """A fitted surrogate; predicts the mean over seeds, at the chosen earlier parameters.

    Attributes
    ----------
    predictor : callable
        Mean and variance on the transformed scale, the variance without the inflation.
    quality : Quality
    gradient : (m,) float64
        Change of the observable per standard deviation of each earlier parameter.
    """

    predictor: Predictor
    quality: Quality
    gradient: Array

    def predict(self, u: Array) -> tuple[Array, Array]:
        """Return mean and variance on the transformed scale.

        Parameters
        ----------
        u : (k, d) float64
            Points scaled to [0, 1].

        Returns
        -------
        mean, variance : (k,) float64
            The variance is that of the mean over seeds and already multiplied by the inflation.
        """
        mean, variance = self.predictor(u)
        return mean, np.clip(variance, 0.0, None) * self.quality.inflation


@dataclass(frozen=True)
class _Points:
    """Runs gathered by point: mean over seeds and how many."""

    x: Array
    y: Array
    count: Array
    nuisance: Array
    noise: float  # variance of one run
    dof: float  # repeats behind it


def fewest_points(size: int) -> int:
    """Return how many points a surrogate over `size` parameters needs; fewer say nothing."""
    return 2 * size + 4


def fit_surrogate(samples: Samples, seed: int) -> Surrogate:
    """Fit several kinds of Kriging and weigh them by how well they predict left-out points.

    Parameters
    ----------
    samples : Samples
        Runs of one number, y of shape (n,); at least `fewest_points` distinct points.
    seed : int
        Seed of the multi-start search for the correlation lengths.

    Returns
    -------
    Surrogate

    Raises
    ------
    CalibrationError
        When there are too few points or the observable does not vary at all.
    """
    points = _gather(samples)
    least = fewest_points(points.x.shape[1])
    if len(points.y) < least:
        msg = (
            f"only {len(points.y)} usable points for a surrogate; at least {least} are needed"
            " (raise 'points' in the study or look at the failed runs)"
        )
        raise CalibrationError(msg)
    if float(np.ptp(points.y)) == 0.0:
        msg = f"the observable is {points.y[0]:g} in every run; these parameters do not change it"
        raise CalibrationError(msg)
    fits = _train_all(points, points.y, seed)
    gradient = np.zeros(points.nuisance.shape[1])
    if gradient.size:
        gradient = _nuisance_gradient(points, fits[0])
        fits = _train_all(points, points.y - points.nuisance @ gradient, seed)
    scores = np.array([fit.score for fit in fits])
    weights = np.exp(scores - scores.max())
    weights /= weights.sum()
    quality = _quality(points, fits, weights, len(samples.y))
    models = [fit.model for fit in fits]
    several = points.x.shape[1] == TABULATED
    predictor = _table(models, weights) if several else _asked(models, weights)
    return Surrogate(predictor, quality, gradient)


def _asked(models: list[Any], weights: Array) -> Predictor:
    """Return the weighted models themselves."""
    kept = np.flatnonzero(weights > NEGLIGIBLE)
    share = weights[kept] / weights[kept].sum()

    def predict(u: Array) -> tuple[Array, Array]:
        means = np.array([np.asarray(models[k].predict_values(u))[:, 0] for k in kept])
        variances = np.array([np.asarray(models[k].predict_variances(u))[:, 0] for k in kept])
        mean = share @ means
        # The spread between models that predict about equally well is part of what is not known.
        return mean, share @ (variances + (means - mean) ** 2)

    return predict


def _table(models: list[Any], weights: Array) -> Predictor:
    """Put the weighted models on a grid and lay a cubic spline through it.

    Optimum, contour lines and likelihood ask for some 100 000 predictions; smt needs a tenth of a
    millisecond for each, a spline a thousandth. The spline's error is checked by a test.
    """
    axis = np.linspace(0.0, 1.0, TABLE)
    grid = np.stack(np.meshgrid(axis, axis, indexing="ij"), axis=-1).reshape(-1, TABULATED)
    mean, variance = (
        RectBivariateSpline(axis, axis, field.reshape(TABLE, TABLE))
        for field in _asked(models, weights)(grid)
    )

    def predict(u: Array) -> tuple[Array, Array]:
        return np.asarray(mean.ev(u[:, 0], u[:, 1])), np.asarray(variance.ev(u[:, 0], u[:, 1]))

    return predict


def _gather(samples: Samples) -> _Points:
    """Average runs of equal inputs and pool their scatter into one noise variance."""
    keys = np.column_stack([samples.x, samples.nuisance])
    _, first, index = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    index = index.reshape(-1)
    count = np.bincount(index).astype(float)
    mean = np.bincount(index, weights=samples.y) / count
    dof = float(len(samples.y) - len(count))
    noise = float(np.sum((samples.y - mean[index]) ** 2) / max(dof, 1.0))
    return _Points(samples.x[first], mean, count, samples.nuisance[first], noise, dof)


@dataclass(frozen=True)
class _Fit:
    model: Any
    kind: str
    noise: float
    y: Array
    residual: Array  # left-out residual
    variance: Array  # its predicted variance, noise of the left-out point included

    @property
    def score(self) -> float:
        """Logarithm of the predictive density of the left-out points."""
        return float(-0.5 * np.sum(np.log(self.variance) + self.residual**2 / self.variance))


def _train_all(points: _Points, y: Array, seed: int) -> list[_Fit]:
    """Fit every kind, the one that predicts left-out points best first."""
    noise = _joined_noise(points, y, seed)
    fits = [_train(points, y, kind, seed, noise) for kind in KINDS]
    return sorted(fits, key=lambda fit: -fit.score)


def _train(points: _Points, y: Array, kind: tuple[str, str], seed: int, noise: float) -> _Fit:
    """Fit one kind of Kriging; known noise is divided by the process variance, see `kriging`."""
    scale = float(np.var(y))
    theta = [0.3]
    for _ in range(3):
        share = np.maximum(noise / points.count / scale, 1e-8)
        extra = {"use_het_noise": True, "noise0": list(share), "theta0": theta}
        model = train_kriging(points.x, y, kind, seed, extra)
        found = float(np.squeeze(model.optimal_par["sigma2"]))
        theta = list(model.optimal_theta)
        settled = abs(found / scale - 1.0) < 0.05  # far below the error of the noise itself
        scale = found
        if settled:
            break
    residual, variance = leave_one_out(model, y)
    return _Fit(model, f"{kind[0]}, {kind[1]} trend", noise, y, residual, variance)


def _likely_noise(points: _Points, y: Array, seed: int) -> float:
    """Return the noise variance of one run that makes the points likely (maximum likelihood)."""
    extra = {"eval_noise": True, "noise0": [0.05], "noise_bounds": [1e-4, 1e2], "theta0": [0.3]}
    model = train_kriging(points.x, y, KINDS[0], seed, extra)
    return float(np.squeeze(model.optimal_noise) * np.squeeze(model.optimal_par["sigma2"]))


def _joined_noise(points: _Points, y: Array, seed: int) -> float:
    """Join the scatter of repeated runs with the noise the surface itself suggests.

    A handful of repeats leaves the variance uncertain by a factor of two. The surface tells it
    apart from real variation about as well as a repeat per six points would.
    """
    surface_dof = len(y) / 6.0
    surface = _likely_noise(points, y, seed)
    return (points.dof * points.noise + surface_dof * surface) / (points.dof + surface_dof)


def _nuisance_gradient(points: _Points, fit: _Fit) -> Array:
    """Regress the left-out residuals on the earlier parameters.

    A weak prior (one standard deviation changes the observable by about its residual scatter)
    keeps directions that the design hardly moved from being invented.
    """
    weight = 1.0 / fit.variance
    w = points.nuisance
    prior = np.eye(w.shape[1]) / float(np.median(fit.variance))
    left = (w * weight[:, None]).T @ w + prior
    return np.asarray(np.linalg.solve(left, (w * weight[:, None]).T @ fit.residual))


def _quality(points: _Points, fits: list[_Fit], weights: Array, runs: int) -> Quality:
    y = fits[0].y
    residuals = np.array([fit.residual for fit in fits])
    residual = weights @ residuals
    variance = weights @ (np.array([f.variance for f in fits]) + (residuals - residual) ** 2)
    z_rms = float(np.sqrt(np.mean(residual**2 / variance)))
    fitted = 1 + 2 * points.x.shape[1]
    return Quality(
        q2=float(1.0 - np.sum(residual**2) / np.sum((y - y.mean()) ** 2)),
        z_rms=z_rms,
        inflation=max(1.0, z_rms**2) * len(y) / max(len(y) - fitted, 1),
        noise_sd=float(np.sqrt(weights @ np.array([f.noise for f in fits]))),
        points=len(points.y),
        runs=runs,
        kind=fits[0].kind,
        observed=y,
        predicted=y - residual,
        predicted_sd=np.sqrt(variance),
    )
