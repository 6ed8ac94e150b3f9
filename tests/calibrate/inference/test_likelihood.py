"""The likelihood against Student's t, the normal and direct integration."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import integrate, stats

from calibrate.emulator.types import Prediction
from calibrate.errors import CalibrationError
from calibrate.inference.likelihood import IMPOSSIBLE, log_density, log_likelihood, nodes
from calibrate.inference.problem import Known, Place, Problem, Reading
from calibrate.inference.space import Unknown
from tests.calibrate.inference.linear import (
    CurvedEmulator,
    box_space,
    direct,
    linear,
    normal_space,
    problem_of,
    scalars,
)


def predicted(mean, variance=None, factors=None) -> Prediction:
    mean = np.atleast_2d(np.asarray(mean, dtype=float))
    return Prediction(
        mean,
        np.zeros_like(mean) if variance is None else np.broadcast_to(variance, mean.shape),
        np.zeros((*mean.shape, 0))
        if factors is None
        else np.broadcast_to(factors, (len(mean), *np.shape(factors))),
    )


def one(y, se, repeats) -> Reading:
    return Reading("t", slice(0, len(y)), np.asarray(y, float), np.asarray(se, float), repeats)


@pytest.mark.parametrize("repeats", [2, 3, 5, 10, 30, 200])
def test_without_an_emulator_error_it_is_students_t(repeats):
    z = np.array([0.0, 0.7, 2.0, 5.0, 30.0, 300.0])
    found = log_density(one([0.0], [0.4], repeats), predicted(0.4 * z[:, None]), np.zeros((6, 0)))
    wanted = stats.t.logpdf(z, repeats - 1) - np.log(0.4)
    np.testing.assert_allclose(found, wanted, atol=2e-3)


@pytest.mark.parametrize("repeats", [3, 6])
@pytest.mark.parametrize("levels", [4, 10, 50])
def test_a_curve_without_an_emulator_error_is_multivariate_t(repeats, levels, rng):
    se = rng.uniform(0.5, 2.0, levels)
    mean = rng.normal(0.0, 2.0, (5, levels))
    found = log_density(one(np.zeros(levels), se, repeats), predicted(mean), np.zeros((5, 0)))
    wanted = stats.multivariate_t(np.zeros(levels), np.diag(se**2), repeats - 1).logpdf(mean)
    np.testing.assert_allclose(found, wanted, atol=2e-3)


def test_a_known_error_is_normal_with_the_whole_covariance(rng):
    se, factors = rng.uniform(0.5, 1.0, 6), rng.normal(size=(6, 2))
    extra, variance = rng.normal(size=(6, 1)), rng.uniform(0.1, 0.3, 6)
    y, mean = rng.normal(size=6), rng.normal(size=(3, 6))
    reading = Reading("c", slice(0, 6), y, se, 0, (), extra)
    found = log_density(reading, predicted(mean, variance, factors), np.zeros((3, 0)))
    cov = np.diag(se**2 + variance) + factors @ factors.T + extra @ extra.T
    wanted = [stats.multivariate_normal.logpdf(y, m, cov) for m in mean]
    np.testing.assert_allclose(found, wanted, rtol=1e-9)


def test_both_errors_together_are_the_integral_over_the_variance(rng):
    se, factors, y = np.array([0.5, 0.8, 0.3]), rng.normal(size=(3, 2)), rng.normal(size=3)
    variance = np.array([0.2, 0.1, 0.3])
    found = log_density(one(y, se, 4), predicted(np.zeros(3), variance, factors), np.zeros((1, 0)))
    fixed = np.diag(variance) + factors @ factors.T

    def integrand(chi2):
        cov = fixed + 3.0 / chi2 * np.diag(se**2)
        return stats.chi2.pdf(chi2, 3) * stats.multivariate_normal.pdf(y, np.zeros(3), cov)

    wanted, _ = integrate.quad(integrand, 0.0, np.inf, limit=200)
    assert found[0] == pytest.approx(np.log(wanted), abs=2e-3)


@pytest.mark.parametrize("repeats", [0, 4])
def test_errors_of_levels_that_go_together_are_one_covariance(repeats, rng):
    se, factors, y = np.array([0.5, 0.8, 0.3]), rng.normal(size=(3, 2)), rng.normal(size=3)
    variance, together = np.array([0.2, 0.1, 0.3]), np.full((3, 3), 0.9) + 0.1 * np.eye(3)
    reading = Reading("c", slice(0, 3), y, se, repeats, together=together)
    found = log_density(reading, predicted(np.zeros(3), variance, factors), np.zeros((1, 0)))
    fixed, measured = np.diag(variance) + factors @ factors.T, se[:, None] * together * se

    def density(wider):
        return stats.multivariate_normal.pdf(y, np.zeros(3), fixed + wider * measured)

    wanted = density(1.0)
    if repeats:
        weighed = [lambda x: stats.chi2.pdf(x, 3) * density(3.0 / x), 0.0, np.inf]
        wanted, _ = integrate.quad(*weighed, limit=200)
    assert found[0] == pytest.approx(np.log(wanted), abs=2e-3)


def test_many_repeats_are_a_known_error():
    shifted = predicted([[1.0], [0.3]])
    many, known = (log_density(one([0.0], [0.5], n), shifted, np.zeros((2, 0))) for n in (2000, 0))
    np.testing.assert_allclose(many, known, atol=5e-3)


def test_nodes_are_few():
    assert max(len(nodes(n, levels)[0]) for n in (2, 5, 30) for levels in (1, 10, 50)) < 150


def test_far_away_is_finite_and_falls():
    z = 10.0 ** np.arange(1, 9)
    for repeats in (0, 2, 5):
        found = log_density(one([0.0], [1.0], repeats), predicted(z[:, None]), np.zeros((8, 0)))
        assert np.isfinite(found).all()
        assert (np.diff(found) < 0.0).all()


def test_what_no_emulator_predicts_is_impossible_and_finite():
    emulator = CurvedEmulator(lambda u: np.where(u < 0.5, np.nan, u))
    problem = problem_of(box_space(1), emulator, scalars([0.7], [0.1]))
    found = log_likelihood(problem, np.array([[0.2], [0.7]]))
    assert found[0] == IMPOSSIBLE
    assert found[1] > -10.0


def test_readings_and_known_values_multiply():
    slopes = np.array([[1.0, 0.0], [0.0, 2.0]])
    space = normal_space(2)
    readings = scalars([0.3, 0.5], [0.2, 0.4])
    place = Place("here", linear(slopes), direct(2), (), readings)
    problem = Problem(space, (place, place), (Known(1, 0.4, 0.1),))
    values = np.array([[0.1, 0.2], [0.5, -0.3]])
    wanted = 2.0 * stats.norm.logpdf(values @ slopes.T, [0.3, 0.5], [0.2, 0.4]).sum(axis=1)
    wanted += stats.norm.logpdf(values[:, 1], 0.4, 0.1)
    np.testing.assert_allclose(log_likelihood(problem, values), wanted)


def test_a_shared_error_shifts_all_its_readings():
    shared = ((1, np.array([0.5])),)
    problem = problem_of(
        normal_space(1, (Unknown.shared_error("balance"),)),
        linear([[1.0], [1.0]]),
        scalars([1.0, 2.0], [0.1, 0.1], 0, shared),
        size=1,
    )
    found = log_likelihood(problem, np.array([[1.0, 0.0], [0.5, 1.0]]))
    assert found[0] == pytest.approx(found[1])


@pytest.mark.parametrize(
    ("y", "se", "repeats", "word"),
    [
        ([1.0], [0.0], 0, "above 0"),
        ([np.nan], [0.1], 0, "above 0"),
        ([1.0, 2.0], [0.1], 0, "errors for"),
        ([1.0], [0.1], 1, "at least 2"),
    ],
)
def test_readings_that_say_nothing_are_refused(y, se, repeats, word):
    with pytest.raises(CalibrationError, match=word):
        one(y, se, repeats)
