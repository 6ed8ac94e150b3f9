"""The correlation that is machine code is that of the book."""

from __future__ import annotations

import numpy as np
import pytest

from calibrate.emulator.correlations import matern_of

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
