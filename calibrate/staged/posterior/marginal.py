"""The likelihood of the parameters alone: errors that readings share are integrated out.

Shared errors are unit-normal unknowns eta of a problem. At given parameters, with every measurement
error taken as normal, eta is normal too, with a mean and a covariance in closed form. The integral
over the true likelihood is an average over quasi-random points of that normal and of the prior of
eta, weighted by how probable they really are; the same points serve all parameters, so that what
error the average has varies as smoothly as the likelihood.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Final, NamedTuple, TypeAlias

import numpy as np
from scipy import special
from scipy.stats import qmc

from calibrate.arrays import Array
from calibrate.emulator.types import Prediction
from calibrate.inference import Problem, Reading, log_likelihood
from calibrate.inference.likelihood import IMPOSSIBLE, log_density

__all__ = ["marginal_likelihood"]

ABOUT: Final = 32
"""Points about the most probable shared errors; a power of two."""
BEFORE: Final = 8
"""Points of their prior, for readings whose errors are far from normal; a power of two."""
CHUNK: Final = 4000
HEAVIEST: Final = 3.0
"""Most by which the variance of a measurement from few repeats counts more than it was stated."""


_Readings: TypeAlias = Sequence[tuple[Reading, Prediction]]


class _Normal(NamedTuple):
    """Shared errors at n parameters, as if all errors were normal.

    Attributes
    ----------
    mean : (n, r) float64
    root : (n, r, r) float64
        Lower Cholesky factor of the inverse of their covariance.
    spread : (n, r, r) float64
        Transposed inverse of it: mean + spread @ unit normals are draws.
    """

    mean: Array
    root: Array
    spread: Array

    @property
    def log_size(self) -> Array:
        """Logarithm of the determinant of `root`, (n,)."""
        return np.asarray(np.sum(np.log(np.diagonal(self.root, axis1=1, axis2=2)), axis=1))


def marginal_likelihood(problem: Problem, values: Array, *, rough: bool = False) -> Array:
    """Return the log probability of all data, (n,), at parameters alone.

    Parameters
    ----------
    problem : Problem
        Parameters first, then the shared errors.
    values : (n, d) float64
        Of the parameters.
    rough : bool
        Take the integral as that of a normal through one point; twenty times faster, and right
        where all errors are normal.
    """
    shared = problem.space.size - values.shape[1]
    whole = np.column_stack([values, np.zeros((len(values), shared))])
    if not shared:
        return log_likelihood(problem, whole)
    integral = _at_mode if rough else _average
    alone = Problem(problem.space, (), problem.known)
    found = [np.empty(0)]
    for start in range(0, len(whole), CHUNK):
        part = whole[start : start + CHUNK]
        predicted = [(place, place.predict(part)) for place in problem.places]
        readings = [(one, prediction) for place, prediction in predicted for one in place.readings]
        normal = _normal(readings, len(part), values.shape[1], shared)

        def log_p(eta: Array, part: Array = part, readings: _Readings = readings) -> Array:
            at = np.column_stack([part[:, : values.shape[1]], eta])
            terms = [log_density(reading, prediction, at) for reading, prediction in readings]
            return np.asarray(np.sum(terms, axis=0) - 0.5 * np.sum(eta**2, axis=1))

        total = integral(log_p, normal) + log_likelihood(alone, part)
        found.append(np.maximum(total, IMPOSSIBLE))
    return np.concatenate(found)


def _at_mode(log_p: Callable[[Array], Array], normal: _Normal) -> Array:
    """Return the integral of a normal (Laplace), at its mean or at no error, what is more.

    No error is the better place where a reading is rather a mistake than explained.
    """
    highest = np.maximum(log_p(normal.mean), log_p(np.zeros_like(normal.mean)))
    return np.asarray(highest - normal.log_size)


def _average(log_p: Callable[[Array], Array], normal: _Normal) -> Array:
    """Return the average over quasi-random points, each weighted by how it was drawn."""
    shared = normal.mean.shape[1]
    etas = [normal.mean + normal.spread @ point for point in _points(ABOUT, shared)]
    etas += [np.broadcast_to(point, normal.mean.shape) for point in _points(BEFORE, shared)]
    found = [log_p(eta) - _log_drawn(eta, normal) for eta in etas]
    return np.asarray(special.logsumexp(found, axis=0) - math.log(len(etas)))


def _normal(readings: list[tuple[Reading, Prediction]], n: int, first: int, shared: int) -> _Normal:
    """Return mean and spread of the shared errors if all errors were normal."""
    precision = np.broadcast_to(np.eye(shared), (n, shared, shared)).copy()
    pull = np.zeros((n, shared))
    for reading, prediction in readings:
        loadings = np.zeros((len(reading.y), shared))
        for index, loading in reading.shared:
            loadings[:, index - first] += loading
        dof = reading.repeats - 1
        heavy = 1.0 if dof < 1 else min(dof / (dof - 2.0), HEAVIEST) if dof > 2 else HEAVIEST
        own = prediction.columns(reading.columns)
        diagonal = own.total + heavy * reading.se**2
        if reading.extra is None:
            weighted: Array = loadings[None] / diagonal[:, :, None]
        else:
            covariance = diagonal[:, :, None] * np.eye(len(reading.y))
            covariance += reading.extra @ reading.extra.T
            weighted = np.linalg.solve(covariance, np.broadcast_to(loadings, (n, *loadings.shape)))
        precision += np.swapaxes(weighted, 1, 2) @ loadings
        pull += np.einsum("nlr,nl->nr", weighted, reading.y - own.mean)
    mean = np.linalg.solve(precision, pull[:, :, None])[:, :, 0]
    root = np.linalg.cholesky(precision)
    return _Normal(mean, root, np.swapaxes(np.linalg.inv(root), 1, 2))


def _points(count: int, size: int) -> Array:
    """Return quasi-random points of the unit normal, (count, size)."""
    cube = qmc.Sobol(size, scramble=False).random(count) + 0.5 / count
    return np.asarray(special.ndtri(cube))


def _log_drawn(eta: Array, normal: _Normal) -> Array:
    """Return the log density from which the points come, both kinds together.

    Without the constant of the unit normal, which the density of the shared errors lacks, too.
    """
    away = np.einsum("nsr,ns->nr", normal.root, eta - normal.mean)
    near = math.log(ABOUT) + normal.log_size - 0.5 * np.sum(away**2, axis=1)
    both = np.logaddexp(near, math.log(BEFORE) - 0.5 * np.sum(eta**2, axis=1))
    return np.asarray(both - math.log(ABOUT + BEFORE))
