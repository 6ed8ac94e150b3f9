"""Model discrepancy: a price for what cannot be met, and no bend in everything else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from calibrate.emulator.types import Prediction
from calibrate.inference.discrepancy import (
    SHARE,
    discrepancy_probabilities,
    reaches,
    with_discrepancy,
)
from calibrate.inference.likelihood import SIZES, discrepancy_probability, log_density
from calibrate.inference.problem import Discrepancy, Reading
from calibrate.inference.sampling import sample
from tests.calibrate.inference.linear import box_space, linear, problem_of, scalars

CHANCE = 0.05


def at(mean) -> Prediction:
    mean = np.atleast_2d(np.asarray(mean, float)).T
    return Prediction(mean, np.full_like(mean, 0.04), np.zeros((*mean.shape, 0)))


def test_the_density_is_a_mixture_of_two_normals():
    z = np.array([0.0, 1.0, 4.0, 20.0])
    reading = Reading("t", slice(0, 1), np.zeros(1), np.array([0.3]))
    strays = replace(reading, discrepancy=Discrepancy(CHANCE, np.array([2.0])))
    variance = 0.3**2 + 0.04
    held = (1.0 - CHANCE) * stats.norm.pdf(z, scale=np.sqrt(variance))
    missed = CHANCE * sum(
        share * stats.norm.pdf(z, scale=np.sqrt(variance + (2.0 * size) ** 2))
        for size, share in SIZES
    )
    found = log_density(strays, at(z), np.zeros((4, 0)))
    np.testing.assert_allclose(found, np.log(held + missed), rtol=1e-12)
    odds = discrepancy_probability(strays, at(z), np.zeros((4, 0)))
    np.testing.assert_allclose(odds, missed / (held + missed), rtol=1e-9)
    assert odds[0] < CHANCE < odds[2]


def test_without_a_discrepancy_nothing_is_missed():
    reading = Reading("t", slice(0, 1), np.zeros(1), np.array([0.3]))
    assert discrepancy_probability(reading, at([0.0, 9.0]), np.zeros((2, 0))).tolist() == [0, 0]


def test_a_curve_is_missed_as_a_whole():
    # One shift of all levels: three levels off alike are one discrepancy, not three.
    reading = Reading("c", slice(0, 3), np.full(3, 2.0), np.full(3, 0.1))
    strays = replace(reading, discrepancy=Discrepancy(CHANCE, np.full(3, 1.0)))
    mean = Prediction(np.zeros((1, 3)), np.zeros((1, 3)), np.zeros((1, 3, 0)))
    covariances = [0.01 * np.eye(3) + size**2 * np.ones((3, 3)) for size, _ in SIZES]
    missed = CHANCE * sum(
        share * stats.multivariate_normal(np.zeros(3), cov).pdf(np.full(3, 2.0))
        for cov, (_, share) in zip(covariances, SIZES, strict=True)
    )
    found = log_density(strays, mean, np.zeros((1, 0)))
    assert found[0] == pytest.approx(np.log(missed), rel=1e-6)


def bent_problem(shift: float):
    """Return six readings of two parameters at 0.3 and 0.6, the last one shifted."""
    rng = np.random.default_rng(3)
    slopes = np.array([[1.0, 0.2], [0.3, 1.0], [1.0, -0.5], [-0.4, 1.0], [0.8, 0.8], [1.0, 1.0]])
    y = slopes @ np.array([0.3, 0.6]) + 0.02 * rng.standard_normal(6)
    y[-1] += shift
    return problem_of(box_space(2), linear(slopes), scalars(y, np.full(6, 0.02)))


@pytest.mark.parametrize("shift", [0.3, 5.0])
def test_what_cannot_be_met_does_not_bend_the_rest(rng, shift):
    bent = bent_problem(shift)
    plain, robust = sample(bent, rng), sample(with_discrepancy(bent, CHANCE, rng), rng)
    truth = np.array([0.3, 0.6])
    off = np.abs(plain.samples.mean(axis=0) - truth) / plain.samples.std(axis=0)
    assert off.max() > 4.0
    off = np.abs(robust.samples.mean(axis=0) - truth) / robust.samples.std(axis=0)
    assert off.max() < 3.0
    place = with_discrepancy(bent, CHANCE, rng).places[0]
    odds = discrepancy_probabilities(place, robust.samples).mean(axis=0)
    assert odds[-1] > 0.99
    assert odds[:-1].max() < 0.3


def test_where_all_can_be_met_it_costs_nothing(rng):
    good = bent_problem(0.0)
    plain, robust = sample(good, rng), sample(with_discrepancy(good, CHANCE, rng), rng)
    np.testing.assert_allclose(robust.samples.std(axis=0), plain.samples.std(axis=0), rtol=0.25)
    assert with_discrepancy(good, 0.0, rng) is good


def test_a_discrepancy_is_as_large_as_a_quarter_of_what_the_ranges_allow(rng):
    good = bent_problem(0.0)
    means = good.places[0].predict(good.space.draw(4000, rng)).mean
    # 512 draws tell a standard deviation to 4 %.
    np.testing.assert_allclose(reaches(good, rng)[0], SHARE * means.std(axis=0), rtol=0.15)
