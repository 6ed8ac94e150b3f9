"""Shared errors integrated out: against dense quadrature."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from calibrate.emulator.types import Inputs, Prediction
from calibrate.inference import Place, Prior, Problem, Reading, Source, Space, Unknown
from calibrate.inference import log_likelihood as whole
from calibrate.staged.posterior.marginal import marginal_likelihood
from calibrate.staged.problem import common_covariance

LOADINGS = np.array([[1.0, 0.5], [-0.3, 0.8]])
POINTS = np.random.default_rng(1).random((12, 2))


class Plane:
    """An emulator that knows its plane to 0.5."""

    def __init__(self, height: float, slope: tuple[float, float]) -> None:
        self.height, self.slope = height, np.array(slope)

    def predict(self, inputs: Inputs) -> Prediction:
        """Return the plane."""
        mean = (self.height + inputs.u @ self.slope)[:, None]
        return Prediction(mean, np.full_like(mean, 0.25), np.zeros((*mean.shape, 0)))


def problem(repeats: int, size: float, away: float) -> Problem:
    """Return two targets of two parameters that share two errors."""
    uniform = Prior.uniform(0.0, 1.0)
    unknowns = (
        Unknown("a", "", uniform), Unknown("b", "", uniform),
        Unknown.shared_error("first"), Unknown.shared_error("second"),
    )  # fmt: skip
    places = []
    for k, plane in enumerate((Plane(1.0, (2.0, 1.0)), Plane(3.0, (-1.0, 2.0)))):
        shared = tuple((2 + j, size * LOADINGS[k, j : j + 1]) for j in range(2))
        y, se = np.array([(2.0, 3.5 + away)[k]]), np.array([0.2])
        reading = Reading(f"r{k}", slice(0, 1), y, se, repeats, shared)
        places.append(Place(f"p{k}", plane, (Source(0), Source(1)), (), (reading,)))
    return Problem(Space(unknowns), tuple(places))


@pytest.mark.parametrize("repeats", [0, 3, 5])
@pytest.mark.parametrize("size", [0.1, 1.0, 3.0])
@pytest.mark.parametrize(("away", "allowed"), [(0.0, 0.05), (3.0, 0.25)])
def test_the_integral_is_that_of_dense_quadrature(repeats, size, away, allowed):
    asked = problem(repeats, size, away)
    axis = np.linspace(-7.0, 7.0, 141)
    eta = np.stack(np.meshgrid(axis, axis, indexing="ij"), axis=-1).reshape(-1, 2)
    prior = stats.norm.logpdf(eta).sum(axis=1)
    exact = [
        np.logaddexp.reduce(whole(asked, np.column_stack([np.tile(u, (len(eta), 1)), eta])) + prior)
        + 2.0 * np.log(axis[1] - axis[0])
        for u in POINTS
    ]
    # Forty points: 0.04 nat where the data agree, 0.2 where they are 15 standard errors apart.
    np.testing.assert_allclose(marginal_likelihood(asked, POINTS), exact, atol=allowed)


def test_of_normal_errors_one_point_is_enough():
    asked = problem(0, 1.0, 1.0)
    covariance = LOADINGS @ LOADINGS.T + (0.25 + 0.04) * np.eye(2)
    mean = np.column_stack([1.0 + POINTS @ [2.0, 1.0], 3.0 + POINTS @ [-1.0, 2.0]])
    exact = stats.multivariate_normal(np.zeros(2), covariance).logpdf(mean - [2.0, 4.5])
    rough = marginal_likelihood(asked, POINTS, rough=True)
    np.testing.assert_allclose(rough, exact, atol=1e-9)


class Level:
    """An emulator of a curve of three levels that rises with both parameters, without error."""

    def predict(self, inputs: Inputs) -> Prediction:
        """Return the curve."""
        mean = inputs.u @ np.array([[1.0, 1.0, 1.0], [0.0, 1.0, 2.0]])
        return Prediction(mean, np.zeros_like(mean), np.zeros((*mean.shape, 0)))


def test_what_the_levels_of_a_curve_have_in_common_counts_beside_what_others_share():
    asked = problem(0, 1.0, 0.0)
    y, se, luck = np.array([0.5, 1.5, 1.8]), np.array([0.2, 0.1, 0.3]), np.array([0.4, 0.5, 0.7])
    loading = np.array([0.3, 0.6, 0.9])
    reading = Reading("curve", slice(0, 3), y, se, 0, ((2, loading),), luck[:, None])
    curve = Place("curve", Level(), (Source(0), Source(1)), (), (reading,))
    one = Problem(asked.space, (asked.places[0], curve))
    first = np.array([*LOADINGS[0, :1], *loading])
    second = np.array([*LOADINGS[0, 1:], 0.0, 0.0, 0.0])
    covariance = np.outer(first, first) + np.outer(second, second)
    covariance += np.diag([0.25 + 0.04, *se**2])
    covariance[1:, 1:] += np.outer(luck, luck)
    own = np.outer(loading, loading) + np.outer(luck, luck)
    np.testing.assert_allclose(common_covariance(reading), own)
    rising = POINTS @ np.array([[1.0, 1.0, 1.0], [0.0, 1.0, 2.0]])
    mean = np.column_stack([1.0 + POINTS @ [2.0, 1.0], rising])
    exact = stats.multivariate_normal(np.zeros(4), covariance).logpdf(mean - [2.0, *y])
    rough = marginal_likelihood(one, POINTS, rough=True)
    np.testing.assert_allclose(rough, exact, atol=1e-9)
