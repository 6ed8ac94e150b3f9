"""The posterior as samplers see it: coordinates whose prior is the unit normal, and derivatives.

With z = Phi^-1(cube) the prior of every coordinate is N(0, 1), a direction that nothing determines
stays exactly normal, and no limit of a range cuts a proposal. Derivatives are differences, taken
place by place: a place sees few of the unknowns, so the Hessian of two hundred readings costs what
a hundred likelihoods cost.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final, Protocol

import numpy as np

from calibrate.arrays import Array
from calibrate.inference.likelihood import IMPOSSIBLE, log_likelihood, place_terms
from calibrate.inference.problem import Place, Problem

__all__ = ["Density", "Progress", "Stopped", "Target"]

_STEP: Final = 2e-3  # of the unit range, or of a prior deviation: error of a slope about 1e-6
_LIMIT: Final = 8.0  # prior deviations beyond which nothing is looked for

Progress = Callable[[float], None]


class Stopped(Exception):  # noqa: N818  a wish of the caller, not an error
    """Raised when the caller's stop function says so."""


class Density(Protocol):
    """What can be searched for modes and sampled: a log density over coordinates."""

    @property
    def size(self) -> int:
        """Number of coordinates."""
        ...

    def progress(self, fraction: float, /) -> None:
        """Hear how much of the work is done."""
        ...

    def log_posterior(self, z: Array) -> Array:
        """Return the log density, (n,), at points (n, K)."""
        ...

    def derivatives(self, z: Array) -> tuple[Array, Array]:
        """Return gradient, (K,), and Hessian, (K, K), of the log density at one point, (K,)."""
        ...


def _nothing(_: float) -> None:
    """Tell nobody."""


def _never() -> bool:
    return False


@dataclass
class Target:
    """A problem in coordinates whose prior is the unit normal; counts what it is asked.

    Attributes
    ----------
    problem : Problem
    stop : callable
        Asked before every batch of likelihoods; True ends the work with `Stopped`.
    progress : callable
        Told the fraction done.
    calls : int
        Likelihoods computed so far.
    """

    problem: Problem
    stop: Callable[[], bool] = _never
    progress: Progress = _nothing
    calls: int = field(default=0, init=False)

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return self.problem.space.size

    def log_likelihood(self, values: Array) -> Array:
        """Return the log likelihood of values (n, K), (n,)."""
        if self.stop():
            raise Stopped
        self.calls += len(values)
        return log_likelihood(self.problem, values)

    def log_posterior(self, z: Array) -> Array:
        """Return log likelihood plus log prior density, (n,), at coordinates (n, K)."""
        values = self.problem.space.from_normal(z)
        return np.asarray(self.log_likelihood(values) + log_prior(z))

    def derivatives(self, z: Array) -> tuple[Array, Array]:
        """Return gradient, (K,), and Hessian, (K, K), of the log posterior at one z, (K,)."""
        if self.stop():
            raise Stopped
        space = self.problem.space
        units = space.units(space.from_normal(z[None]))[0]
        by_unit, curved = np.zeros(self.size), np.zeros((self.size, self.size))
        most = 1
        for place in self.problem.places:
            at = list(place.indices)
            slope, curvature, count = _place_derivatives(self.problem, place, units)
            by_unit[at] += slope
            curved[np.ix_(at, at)] += curvature
            most = max(most, count)
        self.calls += most
        for known in self.problem.known:
            tilt, bend_1 = _known_derivatives(self.problem, known.index, units)
            by_unit[known.index] += tilt
            curved[known.index, known.index] += bend_1
        jacobian, bend = _chain(self.problem, z, by_unit)
        gradient = by_unit @ jacobian - z
        hessian = jacobian.T @ curved @ jacobian + bend - np.eye(self.size)
        return gradient, 0.5 * (hessian + hessian.T)


def log_prior(z: Array) -> Array:
    """Return the log density of the unit normal, (n,); nothing lies beyond eight deviations."""
    power = -0.5 * np.sum(z**2, axis=1) - 0.5 * z.shape[1] * math.log(2.0 * math.pi)
    return np.asarray(np.where(np.abs(z).max(axis=1) > _LIMIT, IMPOSSIBLE, power))


def central_derivatives(function: Callable[[Array], Array], z: Array) -> tuple[Array, Array]:
    """Return gradient, (K,), and Hessian, (K, K), of a function of points at z, (K,)."""
    points, i, j = _stencil(z)
    return _differences(function(points), len(z), i, j)


def _stencil(centre: Array) -> tuple[Array, Array, Array]:
    """Return the points of all second differences around a centre, (1 + 2 d^2, d), and pairs."""
    d = len(centre)
    i, j = np.triu_indices(d, 1)
    eye = _STEP * np.eye(d)
    corners = [a * eye[i] + b * eye[j] for a in (1, -1) for b in (1, -1)]
    return centre + np.concatenate([np.zeros((1, d)), eye, -eye, *corners]), i, j


def _differences(f: Array, d: int, i: Array, j: Array) -> tuple[Array, Array]:
    """Return gradient and Hessian from the values at the points of `_stencil`."""
    plus, minus = f[1 : 1 + d], f[1 + d : 1 + 2 * d]
    corners = f[1 + 2 * d :].reshape(4, len(i))
    hessian = np.diag((plus - 2.0 * f[0] + minus) / _STEP**2)
    mixed = (corners[0] - corners[1] - corners[2] + corners[3]) / (4.0 * _STEP**2)
    hessian[i, j] = hessian[j, i] = mixed
    return (plus - minus) / (2.0 * _STEP), hessian


def _place_derivatives(problem: Problem, place: Place, units: Array) -> tuple[Array, Array, int]:
    """Return gradient and Hessian of one place's log likelihood by the units that matter there."""
    at = list(place.indices)
    priors = problem.space.priors
    bounded = np.array([priors[i].bounded for i in at])
    # Inside the range also with the steps: an emulator knows nothing beyond.
    centre = np.where(bounded, np.clip(units[at], _STEP, 1.0 - _STEP), units[at])
    points, i, j = _stencil(centre)
    moved = np.repeat(units[None], len(points), axis=0)
    moved[:, at] = points
    f = place_terms(place, problem.space.values_of(moved)).sum(axis=1)
    if not (f > IMPOSSIBLE).all():  # at the border of what is predicted there is no slope
        return np.zeros(len(at)), np.zeros((len(at), len(at))), len(points)
    slope, curvature = _differences(f, len(at), i, j)
    return slope, curvature, len(points)


def _known_derivatives(problem: Problem, index: int, units: Array) -> tuple[float, float]:
    """Return slope and curvature of the known values of one unknown by its unit."""
    moved = np.repeat(units[None], 3, axis=0)
    moved[:, index] += _STEP * np.array([-1.0, 0.0, 1.0])
    x = problem.space.values_of(moved)[:, index]
    f = np.zeros(3)
    for known in problem.known:
        if known.index == index:
            f -= 0.5 * ((x - known.value) / known.se) ** 2
    return float(f[2] - f[0]) / (2.0 * _STEP), float(f[2] - 2.0 * f[1] + f[0]) / _STEP**2


def _chain(problem: Problem, z: Array, by_unit: Array) -> tuple[Array, Array]:
    """Return d units / d z, (K, K), and the Hessian by z of by_unit . units."""
    points, i, j = _stencil(z)
    units = problem.space.units(problem.space.from_normal(points))
    d = len(z)
    jacobian = (units[1 : 1 + d] - units[1 + d : 1 + 2 * d]).T / (2.0 * _STEP)
    _, bend = _differences(units @ by_unit, d, i, j)
    return jacobian, bend
