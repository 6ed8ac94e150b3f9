"""Moving a cloud of points over the posterior (Markov chains side by side).

Crank-Nicolson proposals around a normal fitted to the cloud (Cotter et al. 2013; the fitted normal
as in Karamanis et al. 2022): were the posterior that normal, every proposal of any length would be
taken, so moves stay long in many dimensions. Points of a mode stay in it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.linalg import cholesky, solve_triangular

from calibrate.arrays import Array
from calibrate.inference.sampler.mixture import Mixture
from calibrate.inference.sampler.target import Density

__all__ = ["MOST", "Cloud", "move"]

MOST: Final = 60
"""Moves, if points remember longer where they were."""

_WANTED: Final = 0.35  # acceptance towards which the length of moves is tuned
_FORGOTTEN: Final = 0.2  # correlation of any coordinate with its start at which moving ends
_FEWEST: Final = 5
_RIDGE: Final = 1e-8


@dataclass(frozen=True, eq=False)
class Cloud:
    """Points and the log posterior there.

    Attributes
    ----------
    z : (n, K) float64
    log_p : (n,) float64
    """

    z: Array
    log_p: Array


def move(
    target: Density,
    z: Array,
    rng: np.random.Generator,
    power: float = 1.0,
    base: Mixture | None = None,
    most: int = MOST,
) -> Cloud:
    """Return points, (n, K), moved until they have forgotten where they were.

    Parameters
    ----------
    target : Density
    z : (n, K) float64
    rng : Generator
    power : float
        The density moved over is base^(1 - power) posterior^power.
    base : Mixture, optional
        Needed where power is below 1.
    most : int
        Moves at most.
    """
    mean = z.mean(axis=0)
    size = z.shape[1]
    root = cholesky(np.cov(z, rowvar=False).reshape(size, size) + _RIDGE * np.eye(size), lower=True)
    x = solve_triangular(root, (z - mean).T, lower=True).T  # whitened
    start, length = x, 0.5
    log_p, log_t = _densities(target, z, power, base)
    for number in range(most):
        new = np.sqrt(1.0 - length**2) * x + length * rng.standard_normal(x.shape)
        there = mean + new @ root.T
        new_p, new_t = _densities(target, there, power, base)
        gain = new_t - log_t + 0.5 * np.sum(new**2 - x**2, axis=1)
        taken = np.log(rng.random(len(x))) < gain
        rows = taken[:, None]
        x, z = np.where(rows, new, x), np.where(rows, there, z)
        log_p, log_t = np.where(taken, new_p, log_p), np.where(taken, new_t, log_t)
        length = float(np.clip(length * np.exp(taken.mean() - _WANTED), 0.02, 0.99))
        if number + 1 >= _FEWEST and _memory(start, x) < _FORGOTTEN:
            break
    return Cloud(z, log_p)


def _densities(
    target: Density, z: Array, power: float, base: Mixture | None
) -> tuple[Array, Array]:
    """Return the log posterior, and the log density that is moved over, (n,) each."""
    log_p = target.log_posterior(z)
    if base is None or power >= 1.0:
        return log_p, log_p
    return log_p, power * log_p + (1.0 - power) * base.log_density(z)


def _memory(start: Array, x: Array) -> float:
    """Return the largest correlation of a coordinate with where it was."""
    a, b = start - start.mean(axis=0), x - x.mean(axis=0)
    scale = np.sqrt(np.sum(a**2, axis=0) * np.sum(b**2, axis=0)) + _RIDGE
    return float((np.sum(a * b, axis=0) / scale).max())
