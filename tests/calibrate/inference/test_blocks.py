"""Problems of many materials: blocks, ties whatever their spread, errors to be trusted."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from calibrate.errors import CalibrationError
from calibrate.inference.blocks.site import Site
from calibrate.inference.blocks.structure import split
from calibrate.inference.blocks.tied import delta_coordinate, moments, relative_log_density
from calibrate.inference.sampler.mixture import Mixture
from calibrate.inference.sampler.target import Target
from calibrate.inference.sampling import sample
from tests.calibrate.inference.linear import box_space, linear, problem_of, scalars
from tests.calibrate.inference.tied import exact, tied


@pytest.mark.parametrize(
    ("materials", "ties", "spread", "seed"),
    [(3, 2, 0.03, 1), (3, 2, 0.03, 3), (4, 1, 0.3, 1), (8, 2, 0.03, 2), (8, 2, 0.002, 1)],
)
def test_tied_materials_have_their_evidence_and_posterior(materials, ties, spread, seed):
    """Twenty and 45 unknowns, walls alike and unlike; annealing was 0.1 to 4 nats wrong here."""
    model = tied(materials, ties, spread)
    truth = exact(model)
    found = sample(model.problem, np.random.default_rng(seed))
    assert found.diagnostics["method"] == "blocks"
    assert found.log_evidence == pytest.approx(truth.log_evidence, abs=0.1)
    values = found.samples[:, : len(truth.mean)]
    np.testing.assert_array_less(np.abs(values.mean(axis=0) - truth.mean), 0.12 * truth.sd)
    np.testing.assert_allclose(values.std(axis=0), truth.sd, rtol=0.1)
    spreads = found.samples[:, len(truth.mean) + 1 :: 2]
    np.testing.assert_array_less(
        np.abs(spreads.mean(axis=0) - truth.spread), 0.15 * truth.spread_sd
    )


def test_evidence_repeats_within_its_error():
    model = tied(8, 2, 0.03)
    found = [sample(model.problem, np.random.default_rng(seed)) for seed in (1, 2)]
    error = np.hypot(*(one.log_evidence_error for one in found))
    assert found[0].log_evidence == pytest.approx(found[1].log_evidence, abs=3.0 * error)
    assert error < 0.05


def test_materials_are_the_blocks_of_a_tied_problem():
    model = tied(3, 2, 0.03)
    parts = split(model.problem)
    assert parts is not None
    assert parts.common.tolist() == [15, 16, 17, 18, 19]  # the balance, two means, two spreads
    assert [one.own.tolist() for one in parts.blocks] == [[*range(i, i + 5)] for i in (0, 5, 10)]
    values = model.problem.space.draw(20, np.random.default_rng(1))
    alone = [
        Target(one.problem).log_likelihood(values[:, [*one.own, *one.shared]])
        for one in parts.blocks
    ]
    np.testing.assert_allclose(sum(alone), Target(model.problem).log_likelihood(values), rtol=1e-12)


def test_one_experiment_has_no_blocks():
    problem = problem_of(box_space(3), linear(np.ones((1, 3))), scalars([1.0], [0.1]))
    assert split(problem) is None
    with pytest.raises(CalibrationError, match="no blocks"):
        sample(problem, np.random.default_rng(1), method="blocks")


@pytest.mark.parametrize("wide", [0.25, 1.0])
def test_what_a_block_says_is_its_integral(wide):
    covariance = np.array([[0.3, 0.1], [0.1, 0.5]])
    mixture = Mixture(np.ones(1), np.array([[0.4, -0.3]]), covariance[None], 8.0)
    site = Site.of(mixture, 1.3, own=1)
    found = site.given(np.array([[0.2]]), np.array([[0.7]]), np.array([[wide]]))
    x = np.linspace(-6.0, 6.0, 20_001)
    joint = stats.multivariate_normal(mixture.means[0], covariance)
    f = joint.pdf(np.column_stack([x, np.full_like(x, 0.2)])) / stats.norm.pdf(0.2)
    f *= stats.norm.pdf(x, 0.7, wide) / stats.norm.pdf(x)
    assert found.log_total[0] == pytest.approx(1.3 + np.log(f.sum() * (x[1] - x[0])), abs=1e-6)


def test_a_spread_of_nothing_costs_no_digits():
    """Once a search ended at a spread of 1e-9 with an evidence made of rounding errors."""
    mixture = Mixture(np.ones(1), np.array([[0.4]]), np.array([[[0.3]]]), 8.0)
    site = Site.of(mixture, 0.0, own=1)
    found = site.given(np.zeros((1, 0)), np.array([[0.7]]), np.array([[1e-10]]))
    wanted = stats.norm.logpdf(0.7, 0.4, np.sqrt(0.3)) - stats.norm.logpdf(0.7)
    assert found.log_total[0] == pytest.approx(wanted, abs=1e-6)


@pytest.mark.parametrize(("mean", "spread"), [(0.5, 0.1), (0.05, 0.2), (0.9, 0.01)])
def test_tied_values_have_one_density_in_both_coordinates(mean, spread):
    rng = np.random.default_rng(1)
    unit = stats.truncnorm.rvs(
        -mean / spread, (1.0 - mean) / spread, mean, spread, 20_000, random_state=rng
    )
    w = stats.norm.ppf(unit)
    at = np.full_like(w, mean), np.full_like(w, spread)
    z = delta_coordinate(w, *at)
    assert stats.kstest(z, "norm").pvalue > 1e-3
    wanted = stats.truncnorm.logpdf(unit, -mean / spread, (1.0 - mean) / spread, mean, spread)
    np.testing.assert_allclose(relative_log_density(w, *at), wanted, atol=1e-6)
    centre, wide = moments(np.array([mean]), np.array([spread]))
    assert centre[0] == pytest.approx(w.mean(), abs=0.05 * wide[0])
    assert wide[0] == pytest.approx(w.std(), rel=0.15)
