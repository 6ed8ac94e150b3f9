"""smt's Kriging for noisy simulators.

What smt 2.15 does with noise, as far as it matters here (read in its source and tried):

- ``noise0`` is added to the diagonal of the *correlation* matrix, so it is a share of the process
  variance that the fit itself estimates, not a variance in the units of the data. A known variance
  therefore has to be divided by the fitted process variance (`surrogate._train` repeats the fit
  until the two agree).
- ``eval_noise`` finds one common noise by maximum likelihood; with ``use_het_noise`` it groups
  equal inputs and takes their scatter as it is, which two seeds per point do not determine. So the
  noise is pooled over all repeated points and joined with what ``eval_noise`` finds.
- for noisy fits it switches to COBYLA, which scipy has in plain Python: a third of a second per
  fit. `_Kriging` searches the same likelihood with L-BFGS-B, ten times faster.
"""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
from scipy.optimize import minimize
from smt.surrogate_models import KRG
from smt.surrogate_models.krg_based.hyperparam_optim import HyperparamOptimizer

from calibrate.arrays import Array

__all__ = ["leave_one_out", "train_kriging"]


# Correlation lengths from a seventh of the range of a parameter to 1.3 times it, in smt's terms
# (inputs scaled to unit standard deviation; squar_exp is exp(-theta d^2), matern52 takes theta d).
# Longer ones would claim that a noisy surface is a plane known everywhere, shorter ones that noise
# is a landscape; a design of some twenty points can contradict neither.
THETA_BOUNDS = {"squar_exp": [0.05, 4.0], "matern52": [0.22, 2.0]}


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


def train_kriging(
    x: Array, y: Array, kind: tuple[str, str], seed: int, extra: dict[str, Any]
) -> Any:
    """Train smt's Kriging.

    Parameters
    ----------
    x : (n, d) float64
        Points in the unit square.
    y : (n,) float64
        Values.
    kind : (str, str)
        Correlation and trend, in smt's words.
    seed : int
        Seed of the search.
    extra : dict
        Further options of smt, here about noise.

    Returns
    -------
    smt surrogate
    """
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


def leave_one_out(model: Any, y: Array) -> tuple[Array, Array]:
    """Return residual and variance of each point predicted from the others.

    Parameters
    ----------
    model : smt surrogate
        Trained on the points.
    y : (n,) float64
        Their values.

    Returns
    -------
    residual, variance : (n,) float64
        The variance holds the noise of the left-out point.

    Notes
    -----
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
