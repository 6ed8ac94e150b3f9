"""Kriging surrogate of one observable over two parameters, with honest error bars.

What smt 2.15 does with noise, as far as it matters here (read in its source and tried):

- ``noise0`` is added to the diagonal of the *correlation* matrix, so it is a share of the process
  variance that the fit itself estimates, not a variance in the units of the data. A known variance
  therefore has to be divided by the fitted process variance; `_train` repeats the fit until the two
  agree.
- ``eval_noise`` finds one common noise by maximum likelihood; with ``use_het_noise`` it groups
  equal inputs and takes their scatter as it is, which two seeds per point do not determine. So the
  noise is pooled over all repeated points here and joined with what ``eval_noise`` finds.
- for noisy fits it switches to COBYLA, which scipy has in plain Python: a third of a second per
  fit. `_Kriging` searches the same likelihood with L-BFGS-B, ten times faster.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import RectBivariateSpline
from scipy.optimize import minimize
from smt.surrogate_models import KRG
from smt.surrogate_models.krg_based.hyperparam_optim import HyperparamOptimizer

from calibrate.errors import CalibrationError

__all__ = ["Quality", "Samples", "Surrogate", "fit_surrogate"]

Array = NDArray[np.float64]

TABLE = 81
FITTED = 5  # trend and correlation lengths, fitted to the same points and taken as known by smt
MIN_POINTS = 8  # fewer say nothing about a surface over two parameters
# Correlation lengths from a seventh of the range of a parameter to 1.3 times it, in smt's terms
# (inputs scaled to unit standard deviation; squar_exp is exp(-theta d^2), matern52 takes theta d).
# Longer ones would claim that a noisy surface is a plane known everywhere, shorter ones that noise
# is a landscape; a design of some twenty points can contradict neither.
THETA_BOUNDS = {"squar_exp": [0.05, 4.0], "matern52": [0.22, 2.0]}
KINDS = (("matern52", "linear"), ("squar_exp", "linear"), ("squar_exp", "constant"))


@dataclass(frozen=True)
class Samples:
    """Simulated values of one observable, on the scale of its surrogate.

    Parameters
    ----------
    x : (n, d) float64
        Free parameters scaled to [0, 1]; repeated runs repeat the row.
    y : (n,) float64
        Observable on the transformed scale, finite.
    nuisance : (n, m) float64
        Parameters of earlier stages in units of their standard deviation, zero at their chosen
        value; m may be 0.
    """

    x: Array
    y: Array
    nuisance: Array


@dataclass(frozen=True)
class Quality:
    """How well a surrogate predicts runs that it has not seen (leave-one-out).

    ``q2`` is 1 for a perfect prediction and 0 for one no better than the mean; ``z_rms`` is 1 when
    the predicted error bars are right; ``inflation`` = max(1, z_rms^2) n / (n - 5) multiplies the
    predicted variance.
    """

    q2: float
    z_rms: float
    inflation: float
    noise_sd: float
    points: int
    runs: int
    kind: str
    observed: Array = field(repr=False)
    predicted: Array = field(repr=False)
    predicted_sd: Array = field(repr=False)


@dataclass(frozen=True)
class Surrogate:
    """A fitted surrogate; predicts the mean over seeds, at the chosen earlier parameters.

    ``gradient`` is the change of the observable per standard deviation of each earlier parameter.
    """

    mean: RectBivariateSpline
    variance: RectBivariateSpline
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
        mean = np.asarray(self.mean.ev(u[:, 0], u[:, 1]))
        variance = np.asarray(self.variance.ev(u[:, 0], u[:, 1]))
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


def fit_surrogate(samples: Samples, seed: int) -> Surrogate:
    """Fit several kinds of Kriging and weigh them by how well they predict left-out points.

    Parameters
    ----------
    samples : Samples
        Runs; at least eight distinct points.
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
    if len(points.y) < MIN_POINTS:
        msg = (
            f"only {len(points.y)} usable points for a surrogate; at least {MIN_POINTS} are needed"
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
    mean, variance = _tabulate([fit.model for fit in fits], weights)
    return Surrogate(mean, variance, quality, gradient)


def _tabulate(models: list[Any], weights: Array) -> tuple[RectBivariateSpline, RectBivariateSpline]:
    """Put the weighted models on a grid and lay a cubic spline through it.

    Optimum, contour lines and likelihood ask for some 100 000 predictions; smt needs a tenth of a
    millisecond for each, a spline a thousandth. The spline's error is checked by a test.
    """
    axis = np.linspace(0.0, 1.0, TABLE)
    grid = np.stack(np.meshgrid(axis, axis, indexing="ij"), axis=-1).reshape(-1, 2)
    means = np.array([np.asarray(m.predict_values(grid))[:, 0] for m in models])
    variances = np.array([np.asarray(m.predict_variances(grid))[:, 0] for m in models])
    mean = weights @ means
    # The spread between models that predict about equally well is part of what is not known.
    variance = weights @ (variances + (means - mean) ** 2)
    shape = (TABLE, TABLE)
    return (
        RectBivariateSpline(axis, axis, mean.reshape(shape)),
        RectBivariateSpline(axis, axis, variance.reshape(shape)),
    )


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
    """Fit one kind of Kriging; known noise is divided by the process variance, see above."""
    scale = float(np.var(y))
    theta = [0.3]
    for _ in range(3):
        share = np.maximum(noise / points.count / scale, 1e-8)
        extra = {"use_het_noise": True, "noise0": list(share), "theta0": theta}
        model = _run(points.x, y, kind, seed, extra)
        found = float(np.squeeze(model.optimal_par["sigma2"]))
        theta = list(model.optimal_theta)
        settled = abs(found / scale - 1.0) < 0.05  # far below the error of the noise itself
        scale = found
        if settled:
            break
    residual, variance = _leave_one_out(model, y)
    return _Fit(model, f"{kind[0]}, {kind[1]} trend", noise, y, residual, variance)


def _likely_noise(points: _Points, y: Array, seed: int) -> float:
    """Return the noise variance of one run that makes the points likely (maximum likelihood)."""
    extra = {"eval_noise": True, "noise0": [0.05], "noise_bounds": [1e-4, 1e2], "theta0": [0.3]}
    model = _run(points.x, y, KINDS[0], seed, extra)
    return float(np.squeeze(model.optimal_noise) * np.squeeze(model.optimal_par["sigma2"]))


def _joined_noise(points: _Points, y: Array, seed: int) -> float:
    """Join the scatter of repeated runs with the noise the surface itself suggests.

    A handful of repeats leaves the variance uncertain by a factor of two. The surface tells it
    apart from real variation about as well as a repeat per six points would.
    """
    surface_dof = len(y) / 6.0
    surface = _likely_noise(points, y, seed)
    return (points.dof * points.noise + surface_dof * surface) / (points.dof + surface_dof)


class _Search(HyperparamOptimizer):
    """Look at all starts, then a bounded quasi-Newton search from the best."""

    def optimize(
        self,
        objective: Any,
        theta_starts: Any,
        gradient: Any = None,
        hessian: Any = None,
        constraints: Any = None,
        bounds: Any = None,
        limit: int = 50,
    ) -> Any:
        """Return the best point as smt expects it; the arguments are those of smt."""
        del gradient, hessian, constraints, limit  # smt has no derivatives with noise
        limits = [tuple(map(float, b)) for b in bounds]
        low, high = np.array(limits).T
        starts = np.clip(theta_starts, low, high)
        values = [float(np.squeeze(objective(start))) for start in starts]
        return minimize(
            lambda theta: float(np.squeeze(objective(theta))),
            starts[int(np.argmin(values))],
            method="L-BFGS-B",
            bounds=limits,
            options={"maxiter": 30, "eps": 1e-3, "ftol": 1e-6},
        )

    def _minimize(self, *arguments: Any) -> Any:  # pragma: no cover - optimize never calls it
        raise NotImplementedError


class _Kriging(KRG):
    """smt's Kriging with a faster search; on a version without the hook smt's own is used."""

    def _create_optimizer(self) -> HyperparamOptimizer:
        return _Search()


def _run(x: Array, y: Array, kind: tuple[str, str], seed: int, extra: dict[str, Any]) -> Any:
    make: Any = _Kriging
    model = make(
        corr=kind[0],
        poly=kind[1],
        hyper_opt="Cobyla",
        n_start=4,
        theta_bounds=THETA_BOUNDS[kind[0]],
        seed=seed,
        print_global=False,
        **extra,
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # smt announces its choice of optimiser as a warning
        model.set_training_values(x, y)
        model.train()
    return model


def _leave_one_out(model: Any, y: Array) -> tuple[Array, Array]:
    """Return residual and variance of each point predicted from the others.

    Closed form for universal Kriging with the correlation lengths held: with
    Q = K^-1 - K^-1 F (F' K^-1 F)^-1 F' K^-1 the residual is (Q y)_i / Q_ii, its variance 1 / Q_ii
    (O. Dubrule, Mathematical Geology 15, 1983).
    """
    par = model.optimal_par
    chol = np.asarray(par["C"]) * np.sqrt(float(np.squeeze(par["sigma2"])))
    inverse = np.linalg.inv(chol @ chol.T)
    trend = np.asarray(model.F)
    weighted = inverse @ trend
    q = inverse - weighted @ np.linalg.solve(trend.T @ weighted, weighted.T)
    diagonal = np.diag(q)
    return (q @ y) / diagonal, 1.0 / diagonal


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
    return Quality(
        q2=float(1.0 - np.sum(residual**2) / np.sum((y - y.mean()) ** 2)),
        z_rms=z_rms,
        inflation=max(1.0, z_rms**2) * len(y) / max(len(y) - FITTED, 1),
        noise_sd=float(np.sqrt(weights @ np.array([f.noise for f in fits]))),
        points=len(points.y),
        runs=runs,
        kind=fits[0].kind,
        observed=y,
        predicted=y - residual,
        predicted_sd=np.sqrt(variance),
    )
