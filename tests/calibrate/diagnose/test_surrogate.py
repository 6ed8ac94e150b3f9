"""The local surrogate: derivatives, recovery of known slopes, honest errors."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from calibrate.diagnose.local.design import two_level
from calibrate.diagnose.local.model import derivatives, features


@settings(max_examples=25, deadline=None)
@given(st.integers(1, 6), st.integers(0, 4), st.integers(0, 10_000))
def test_derivatives_are_those_of_the_features(d: int, c: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    v, p = rng.normal(size=d), rng.normal(size=c)
    by_v, by_p = derivatives(v, p)
    h = 1e-5
    for k in range(d):
        e = h * np.eye(d)[k]
        up, down = features((v + e)[None], p[None])[0][0], features((v - e)[None], p[None])[0][0]
        # Central difference of a cubic: error of order h^2.
        np.testing.assert_allclose(by_v[k], (up - down) / (2 * h), atol=1e-8)
    for k in range(c):
        e = h * np.eye(c)[k]
        up, down = features(v[None], (p + e)[None])[0][0], features(v[None], (p - e)[None])[0][0]
        np.testing.assert_allclose(by_p[k], (up - down) / (2 * h), atol=1e-8)


@pytest.mark.parametrize("n", range(1, 12))
def test_two_level_arrays_are_orthogonal_and_balanced(n: int) -> None:
    array = two_level(n)
    assert set(np.unique(array)) == {-1.0, 1.0}
    np.testing.assert_allclose(array.T @ array, len(array) * np.eye(n), atol=0.0)
    np.testing.assert_allclose(array.sum(axis=0), 0.0, atol=0.0)
