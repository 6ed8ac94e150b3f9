"""Posterior and evidence against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import integrate, stats

from calibrate.errors import CalibrationError
from calibrate.inference.sampler.target import Stopped
from calibrate.inference.sampling import sample
from tests.calibrate.inference.linear import (
    CurvedEmulator,
    box_space,
    exact,
    linear,
    normal_space,
    problem_of,
    scalars,
)


def linear_problem(rng: np.random.Generator, size: int = 4, rows: int = 6):
    """Return a problem with its slopes, data and errors."""
    slopes = rng.normal(size=(rows, size))
    se = rng.uniform(0.2, 0.5, rows)
    y = slopes @ rng.normal(size=size) + se * rng.normal(size=rows)
    return problem_of(normal_space(size), linear(slopes), scalars(y, se)), slopes, y, se


@pytest.mark.parametrize("method", ["auto", "annealed"])
def test_linear_normal_model_has_its_posterior_and_evidence(method):
    problem, slopes, y, se = linear_problem(np.random.default_rng(1))
    mean, covariance, evidence = exact(slopes, y, np.diag(se**2))
    found = sample(problem, np.random.default_rng(2), method=method)
    sd = np.sqrt(np.diag(covariance))
    tight = method == "auto"
    assert found.log_evidence == pytest.approx(evidence, abs=0.05 if tight else 0.3)
    np.testing.assert_allclose(found.samples.mean(axis=0), mean, atol=0.12 * sd.max())
    np.testing.assert_allclose(found.samples.std(axis=0), sd, rtol=0.1)
    wanted = covariance / np.outer(sd, sd)
    np.testing.assert_allclose(found.correlation().to_numpy(), wanted, atol=0.1)
    assert found.diagnostics["method"] == ("importance" if tight else "annealed")


@pytest.mark.parametrize(("method", "tight"), [("auto", 0.1), ("annealed", 0.2)])
def test_two_humps_are_both_found_with_their_weights(method, tight):
    """A thousand points tell the weight of the smaller one to 0.015, annealing a little worse."""

    def function(u):
        x = u[:, 0]
        # two values of x give the measured one; the second branch is 0.3 / 0.7 as wide
        branch = np.where(x < 0.5, (x - 0.2) / 0.3, (0.8 - x) / 0.7)
        return np.column_stack([branch, u[:, 1:]])

    size = 6
    readings = scalars([0.0] + [0.5] * (size - 1), [0.1] + [0.06] * (size - 1))
    problem = problem_of(box_space(size), CurvedEmulator(function), readings)
    evidences = []
    for seed in (1, 2):
        found = sample(problem, np.random.default_rng(seed), method=method)
        weights = [region.weight for region in found.regions]
        assert weights == pytest.approx([0.7, 0.3], rel=tight)
        assert found.regions[0].mean[0] == pytest.approx(0.8, abs=0.01)
        assert found.regions[1].mean[0] == pytest.approx(0.2, abs=0.01)
        evidences.append(found.log_evidence)
    assert evidences[0] == pytest.approx(evidences[1], abs=0.1)
    assert evidences[0] == pytest.approx(0.0, abs=0.1)


def ridge(size: int = 6, width: float = 0.01):
    """Return a problem in which only a product is measured well: a bent ridge."""

    def function(u):
        product = (0.1 + 0.7 * u[:, 0]) * (0.1 + 0.7 * u[:, 1])
        return np.column_stack([product, u[:, 2:]])

    readings = scalars([0.16] + [0.5] * (size - 2), [width] + [0.1] * (size - 2))
    evidence, _ = integrate.quad(
        lambda a: np.diff(
            stats.norm.cdf((np.array([0.1, 0.8]) * (0.1 + 0.7 * a) - 0.16) / width)
        )[0] / (0.7 * (0.1 + 0.7 * a)), 0.0, 1.0, limit=400
    )  # fmt: skip
    inside = float(np.diff(stats.norm.cdf([-5.0, 5.0]))[0])
    truth = math.log(evidence) + (size - 2) * math.log(inside)
    return problem_of(box_space(size), CurvedEmulator(function), readings), truth


def test_a_bent_ridge_hangs_together_and_has_its_evidence():
    problem, truth = ridge()
    found = [sample(problem, np.random.default_rng(seed)) for seed in (1, 2)]
    for one in found:
        assert one.log_evidence == pytest.approx(truth, abs=0.1)
        assert len(one.regions) == 1
        assert one.diagnostics["effective_size"] > 500


@pytest.mark.parametrize(("size", "width", "doubted"), [(6, 0.01, False), (45, 0.006, True)])
def test_an_evidence_is_doubted_where_its_error_is_wrong(size, width, doubted):
    """The ends of a thin ridge among 43 other unknowns are not found: say so."""
    problem, truth = ridge(size, width)
    found = sample(problem, np.random.default_rng(1))
    away = abs(found.log_evidence - truth) / found.log_evidence_error
    assert (away > 4.0) is doubted
    assert bool(found.doubt) is doubted
    reason = "annealed" if found.diagnostics["method"] == "annealed" else "of the draws count"
    assert (reason in found.doubt) is doubted


def test_an_annealed_evidence_is_doubted():
    problem, *_ = linear_problem(np.random.default_rng(1))
    assert "annealed" in sample(problem, np.random.default_rng(2), method="annealed").doubt


@pytest.mark.slow
def test_nested_sampling_agrees():
    problem, truth = ridge(size=3)
    found = sample(problem, np.random.default_rng(1), method="nested")
    assert found.diagnostics["method"] == "nested"
    assert found.log_evidence == pytest.approx(truth, abs=3.0 * found.log_evidence_error)
    other = sample(problem, np.random.default_rng(2))
    assert other.log_evidence == pytest.approx(found.log_evidence, abs=0.3)


def test_the_same_generator_gives_the_same_result():
    problem, *_ = linear_problem(np.random.default_rng(1))
    one, two = (sample(problem, np.random.default_rng(5)) for _ in range(2))
    np.testing.assert_array_equal(one.samples, two.samples)
    np.testing.assert_array_equal(one.best, two.best)
    assert one.log_evidence == two.log_evidence


def test_progress_rises_to_the_end_and_work_can_be_stopped():
    problem, *_ = linear_problem(np.random.default_rng(1))
    told: list[tuple[float, float]] = []
    sample(problem, np.random.default_rng(1), progress=lambda f, left: told.append((f, left)))
    fractions = [fraction for fraction, _ in told]
    assert fractions == sorted(fractions)
    assert told[-1] == (1.0, 0.0)
    asked = iter([False] * 5 + [True] * 1000)
    with pytest.raises(Stopped):
        sample(problem, np.random.default_rng(1), stop=lambda: next(asked))


def test_data_that_nothing_can_give_are_told():
    nothing = CurvedEmulator(lambda u: np.full((len(u), 1), np.nan))
    problem = problem_of(box_space(1), nothing, scalars([0.0], [1.0]))
    with pytest.raises(CalibrationError, match="predict nothing there"):
        sample(problem, np.random.default_rng(1))


def test_what_is_impossible_somewhere_is_left_out():
    half = CurvedEmulator(lambda u: np.where(u > 0.5, u, np.nan))
    problem = problem_of(box_space(1), half, scalars([0.6], [0.3]))
    found = sample(problem, np.random.default_rng(1))
    assert found.samples.min() > 0.5
    share = float(np.diff(stats.norm.cdf((np.array([0.5, 1.0]) - 0.6) / 0.3))[0])
    assert found.log_evidence == pytest.approx(math.log(share), abs=0.1)
