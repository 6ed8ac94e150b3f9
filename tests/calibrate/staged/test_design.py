"""Designs: Latin hypercube property, reproducibility, points that keep apart."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from calibrate.staged.design import latin_hypercube, spread

BOUNDS = np.array([[0.1, 0.8], [0.05, 0.6]])


@settings(max_examples=6, deadline=None)
@given(count=st.integers(5, 16), seed=st.integers(0, 1000))
def test_every_row_and_column_holds_one_point(count: int, seed: int):
    points = latin_hypercube(BOUNDS, count, np.random.default_rng(seed))
    cells = np.floor((points - BOUNDS[:, 0]) / np.ptp(BOUNDS, axis=1) * count).astype(int)
    assert points.shape == (count, 2)
    for column in cells.T:
        assert sorted(column) == list(range(count))


def test_seed_decides_the_design():
    first, again, other = (latin_hypercube(BOUNDS, 12, np.random.default_rng(s)) for s in (3, 3, 4))
    np.testing.assert_array_equal(first, again)
    assert np.abs(first - other).max() > 0.01


def test_design_spreads_better_than_chance():
    # Smallest distance of an optimised design against the median of plain random points.
    def closest(points):
        gaps = np.linalg.norm(points[:, None] - points[None], axis=2)
        return gaps[np.triu_indices(len(points), 1)].min()

    unit = np.array([[0.0, 1.0], [0.0, 1.0]])
    rng = np.random.default_rng(5)
    random = np.median([closest(rng.random((20, 2))) for _ in range(50)])
    assert closest(latin_hypercube(unit, 20, np.random.default_rng(5))) > 2.0 * random


def test_spread_takes_the_farthest_first():
    candidates = np.array([[0.1, 0.0], [1.0, 0.0], [0.5, 0.0]])
    assert spread(candidates, np.array([[0.0, 0.0]]), 2).tolist() == [1, 2]
