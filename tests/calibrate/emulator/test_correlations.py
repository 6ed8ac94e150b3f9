"""Correlations that are machine code are those of the book."""

from __future__ import annotations

import numpy as np
import pytest

from calibrate.emulator.correlations import answers_between, matern_of, strengths_of

DISTANCES = np.concatenate([[0.0], np.logspace(-12.0, 2.7, 5000)])
ROUNDING = 2e-15
"""Twenty roundings of the series; e^-d of a rounded d is besides wrong by d times a rounding."""


def test_it_is_the_closed_form():
    expected = (1.0 + DISTANCES + DISTANCES**2 / 3.0) * np.exp(-DISTANCES)
    found = matern_of(DISTANCES[None, :] ** 2)[0]
    assert (np.abs(found / expected - 1.0) < ROUNDING + 2e-16 * DISTANCES).all()


@pytest.mark.parametrize(("squared", "expected"), [(-1e-9, 1.0), (1e300, 0.0), (np.inf, 0.0)])
def test_what_no_distance_can_be_is_the_nearest_that_can(squared: float, expected: float):
    assert matern_of(np.array([[squared]]))[0, 0] == pytest.approx(expected, abs=1e-200)


def test_nothing_known_stays_so():
    assert np.isnan(matern_of(np.array([[np.nan]]))[0, 0])


@pytest.mark.parametrize("count", [1, 7])
def test_answers_vary_together_as_their_parts_do(count: int):
    rng = np.random.default_rng(count)
    # One for all, or each its own; also ones that no diagnosis looks at.
    own = np.array([3.0]) if count == 1 else np.array([-1e9, -6.0, -0.1, 0.0, 0.3, 2.0, 1e6])
    others = rng.uniform(-6.0, 6.0, 40)
    alike, trend = rng.random((2, 7, 40))
    smooth, quick, slow, bend = 0.3, 0.2, 0.5, 0.1

    def shape(length: float, s: np.ndarray, t: np.ndarray) -> np.ndarray:
        a, b = (np.sign(one) * np.log1p(np.abs(one)) for one in (s, t))
        apart, none_a, none_b = (np.exp(-0.5 * (x / length) ** 2) for x in (a - b, a, b))
        return apart - none_a * none_b

    s, t = own[:, None], others[None, :]
    of_strength = smooth * s * t + quick * shape(0.3, s, t) + slow * shape(1.0, s, t)
    expected = alike * of_strength + s * t * (trend + bend * s * t)
    tables = strengths_of(own), strengths_of(others)
    found = answers_between(alike.copy(), trend, *tables, (smooth, quick, slow, bend))
    assert found == pytest.approx(expected, rel=1e-12, abs=1e-13)  # some roundings of numbers of 1
