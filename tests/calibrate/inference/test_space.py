"""Priors, unknowns and ties against the distributions of scipy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import integrate, stats

from calibrate.errors import CalibrationError
from calibrate.inference.priors import Prior, from_unit, to_unit, truncated_normal
from calibrate.inference.space import Space, Tie, Unknown

P = np.array([0.01, 0.2, 0.5, 0.77, 0.99])


@pytest.mark.parametrize(
    ("prior", "reference"),
    [
        (Prior.uniform(0.1, 0.8), stats.uniform(0.1, 0.7)),
        (Prior.uniform(0.01, 1.0, "log"), stats.loguniform(0.01, 1.0)),
        (Prior.normal(0.3, 0.1, 0.1, 0.8), stats.truncnorm(-2.0, 5.0, 0.3, 0.1)),
        (Prior.normal(0.3, 0.1, 0.8, 1.0), stats.truncnorm(5.0, 7.0, 0.3, 0.1)),
        (Prior.normal(1.0, 2.0), stats.norm(1.0, 2.0)),
        (Prior.half_normal(0.5), stats.halfnorm(0.0, 0.5)),
        (Prior.half_normal(0.5, 0.0, 0.8), stats.truncnorm(0.0, 1.6, 0.0, 0.5)),
    ],
)
def test_quantiles_are_those_of_the_distribution(prior, reference):
    np.testing.assert_allclose(prior.quantile(P), reference.ppf(P), rtol=1e-9)
    assert (prior.quantile(np.array([0.0, 1.0])) >= prior.low).all()
    assert np.isfinite(prior.quantile(np.array([0.0, 1.0]))).all()


@pytest.mark.parametrize(("low", "high"), [(-np.inf, np.inf), (-1.0, 2.0), (0.0, 1.5)])
def test_non_local_prior_is_x_squared_times_normal(low, high):
    prior = Prior.non_local(0.7, low, high)

    def density(x):
        return np.exp(prior.log_density(np.array(x)))

    ends = max(low, -10.0), min(high, 10.0)
    total, _ = integrate.quad(density, *ends, points=[0.0], limit=200)
    for p in P:
        x = float(prior.quantile(np.array(p)))
        part, _ = integrate.quad(density, ends[0], x, limit=200)
        assert part / total == pytest.approx(p, abs=1e-6)
    assert density(0.0) < 1e-12
    np.testing.assert_allclose(density(0.5) / density(0.2), 6.25 * np.exp(-0.5 * 0.21 / 0.49))


def test_spacings_undo_each_other():
    x = np.array([0.03, 0.1, 0.6])
    for spacing in ("linear", "log"):
        unit = to_unit(x, 0.03, 0.6, spacing)
        assert unit[0] == 0.0
        assert unit[-1] == pytest.approx(1.0)
        np.testing.assert_allclose(from_unit(unit, 0.03, 0.6, spacing), x)


@pytest.mark.parametrize(("low", "high"), [(-1.0, 0.5), (6.0, 9.0), (-9.0, -6.0)])
def test_truncated_normal_keeps_its_digits_in_the_tails(low, high):
    found = truncated_normal(P, np.array(low), np.array(high))
    np.testing.assert_allclose(found, stats.truncnorm(low, high).ppf(P), rtol=1e-7)


@pytest.mark.parametrize(
    ("make", "word"),
    [
        (lambda: Prior.uniform(1.0, 0.0), "below"),
        (lambda: Prior.uniform(0.0, 1.0, "log"), "above 0"),
        (lambda: Prior.normal(0.0, 0.0), "sd"),
        (lambda: Prior.half_normal(1.0, -1.0, 1.0), "half-normal"),
        (lambda: Prior.uniform(0.0, np.inf), "finite"),
    ],
)
def test_impossible_priors_are_refused(make, word):
    with pytest.raises(CalibrationError, match=word):
        make()


def tied(spread: float = 0.1, count: int = 3) -> Space:
    prior = Prior.uniform(0.03, 0.6, "log")
    names = [Unknown("mu_pw", f"M{i}/steel", prior) for i in range(count)]
    return Space(
        (*names, Unknown("e", "", Prior.uniform(0.4, 0.9))), (Tie("mu_pw", (0, 1, 2), spread),)
    )


def test_names_and_columns_of_a_space():
    space = tied()
    assert space.names == (
        "mu_pw[M0/steel]", "mu_pw[M1/steel]", "mu_pw[M2/steel]", "e",
        "mean of mu_pw", "spread of mu_pw",
    )  # fmt: skip
    assert space.size == 6
    with pytest.raises(CalibrationError, match=r"did you mean 'mu_pw\[M1/steel\]'"):
        space.index("mu_pw[M1/stele]")


def test_tied_unknowns_scatter_about_their_mean_by_the_spread(rng):
    space = tied(spread=0.02)
    cube = rng.random((40_000, space.size))
    cube[:, 4] = 0.5  # mean of the tie in the middle, where the limits cut nothing
    units = space.units(space.transform(cube))
    delta = (units[:, :3] - units[:, [4]]) / units[:, [5]]
    np.testing.assert_allclose(delta.mean(axis=0), 0.0, atol=0.03)
    np.testing.assert_allclose(delta.std(axis=0), 1.0, atol=0.03)
    assert stats.kstest(units[:, 5] / 0.02, stats.halfnorm.cdf).pvalue > 1e-3


def test_tied_unknowns_stay_in_their_range(rng):
    values = tied(spread=1.0).draw(20_000, rng)
    assert values[:, :3].min() >= 0.03
    assert values[:, :3].max() <= 0.6


def test_units_and_values_undo_each_other(rng):
    space = tied()
    values = space.draw(50, rng)
    np.testing.assert_allclose(space.values_of(space.units(values)), values)


@pytest.mark.parametrize(
    ("tie", "word"),
    [
        (Tie("a", (0,)), "two or more"),
        (Tie("a", (0, 0)), "two or more"),
        (Tie("a", (0, 3)), "same finite range"),
        (Tie("a", (0, 1), spread=0.0), "above 0"),
    ],
)
def test_ties_that_cannot_hold_are_refused(tie, word):
    with pytest.raises(CalibrationError, match=word):
        Space(tied().unknowns, (tie,))


def test_a_name_twice_is_refused():
    one = Unknown("x", "", Prior.uniform(0.0, 1.0))
    with pytest.raises(CalibrationError, match="more than once"):
        Space((one, one))
