"""First designs: space-filling, shared luck where it helps, disjoint between materials."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import qmc

from calibrate.planning.points import points_needed, spread, starting_points


@pytest.fixture
def materials(rng):
    return starting_points(40, 6, 2, 3, rng)


def test_points_fill_the_space_better_than_chance(rng) -> None:
    points = spread(48, 6, rng)
    chance = [qmc.discrepancy(rng.random((48, 6))) for _ in range(20)]
    assert points.min() >= 0.0
    assert points.max() <= 1.0
    assert qmc.discrepancy(points) < min(chance)


def test_materials_get_disjoint_points_of_one_sequence(materials) -> None:
    everything = np.vstack([part.u[:40] for part in materials])
    assert len(np.unique(everything, axis=0)) == 120
    assert qmc.discrepancy(everything) < qmc.discrepancy(materials[0].u[:40])
    seeds = [set(part.seeds) for part in materials]
    assert not seeds[0] & seeds[1]
    assert not seeds[1] & seeds[2]


def test_a_repeat_has_the_point_and_another_seed(materials) -> None:
    for part in materials:
        off = ~part.strengths.any(axis=1)
        again = np.flatnonzero(off)[40:]
        assert len(again) == 5
        assert np.array_equal(part.u[again], part.u[part.point[again]])
        assert not set(part.seeds[again]) & set(part.seeds[:40])


def test_an_effect_twin_differs_in_one_effect_only(materials) -> None:
    for part in materials:
        twins = np.flatnonzero(part.strengths.any(axis=1))
        base = part.point[twins]
        assert np.array_equal(part.u[twins], part.u[base])
        assert np.array_equal(part.seeds[twins], part.seeds[base])
        assert np.all(np.count_nonzero(part.strengths[twins], axis=1) == 1)
        for effect in range(2):
            assert {-1.0, 1.0} <= set(part.strengths[twins, effect])


def test_the_first_points_keep_their_repeats_and_twins(materials) -> None:
    few = materials[0].first(10)
    assert set(few.point) == set(range(10))
    assert np.array_equal(few.u[:10], materials[0].u[:10])


def test_materials_that_share_an_emulator_share_its_points() -> None:
    alone = points_needed(8)
    assert alone == 80
    assert 2 * points_needed(8, 2) == alone
    assert points_needed(8, 50) == 24
