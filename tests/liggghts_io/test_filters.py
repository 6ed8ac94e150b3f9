"""Arithmetic of the templates."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from liggghts_io.errors import CaseError
from liggghts_io.scripts import filters


def test_rayleigh_time_is_equation_six():
    # By hand: G = 5e6 / 2.6 Pa, R = 0.7975 mm; the paper's step for HSP13 is a fifth of 116 us.
    time = filters.rayleigh_time(1.595e-3, 3560.0, 5e6, 0.3)
    assert time == pytest.approx(math.pi * 0.7975e-3 * math.sqrt(3560 * 2.6 / 5e6) / 0.92553)
    assert time == pytest.approx(116e-6, rel=0.01)  # DESIGN value has three digits


@given(st.floats(2e-4, 2e-2), st.floats(0.02, 0.3))
def test_time_step_is_below_the_limit_and_close(diameter, fraction):
    step = filters.time_step([(diameter, 1.0)], 3560.0, 5e6, 0.3, fraction)
    limit = fraction * filters.rayleigh_time(diameter, 3560.0, 5e6, 0.3)
    assert 0.99 * limit <= step <= limit * (1 + 1e-12)  # three digits: at most 1 % is cut off


def test_time_step_follows_the_smallest_grain():
    one = filters.time_step([(1e-3, 1.0)], 3560.0, 5e6, 0.3, 0.2)
    assert filters.time_step([(2e-3, 0.5), (1e-3, 0.5)], 3560.0, 5e6, 0.3, 0.2) == one


@pytest.mark.parametrize("fraction", [0.0, -0.1, 0.5])
def test_time_step_refuses_unstable_fractions(fraction):
    with pytest.raises(CaseError, match="fraction"):
        filters.time_step([(1e-3, 1.0)], 3560.0, 5e6, 0.3, fraction)


def test_grains_of_a_mixture_keep_the_mass():
    sizes = [(1e-3, 0.25), (2e-3, 0.75)]
    small, large = (3560 * math.pi / 6 * d**3 for d in (1e-3, 2e-3))
    assert filters.grains(1.0, sizes, 3560.0) == pytest.approx(0.25 / small + 0.75 / large)


def test_pair_matrix_is_symmetric():
    rows = [float(w) for w in filters.pair_matrix(0.1, 0.2, 0.3).split()]
    assert all(rows[3 * i + j] == rows[3 * j + i] for i in range(3) for j in range(3))
    assert rows[:3] == [0.1, 0.2, 0.3]
    assert rows[5] == 0.2
    other = [float(w) for w in filters.pair_matrix(0.1, 0.2, 0.3, 0.4).split()]
    assert (other[5], other[7]) == (0.4, 0.4)
    assert [one for k, one in enumerate(other) if k not in (5, 7)] == [
        one for k, one in enumerate(rows) if k not in (5, 7)
    ]


def test_angles_are_in_degrees():
    found = [one(30.0) for one in (filters.sin_deg, filters.cos_deg, filters.tan_deg)]
    assert found == pytest.approx([0.5, 0.75**0.5, 3.0**-0.5])


@given(st.integers(0, 10**9), st.integers(1, 8))
def test_seeds_are_different_primes_above_ten_thousand(seed, count):
    seeds = filters.prime_seeds(seed, count)
    assert len(set(seeds)) == count
    assert all(10000 < s < 2**31 for s in seeds)
    for s in seeds[:1]:  # trial division to the root takes a millisecond for one
        assert all(s % k for k in range(2, math.isqrt(s) + 1))


def test_seeds_of_a_case_do_not_depend_on_how_many_are_asked_for():
    assert filters.prime_seeds(3, 5)[:2] == filters.prime_seeds(3, 2)


@pytest.mark.parametrize(
    ("value", "text"), [(0.1, "0.1"), (1000.0, "1000"), (2.32e-05, "2.32e-05")]
)
def test_number(value, text):
    assert filters.number(value) == text


def test_number_refuses_what_a_script_cannot_hold():
    with pytest.raises(CaseError, match="nan"):
        filters.number(float("nan"))


def test_steps_are_whole_and_at_least_one():
    assert filters.steps(1e-3, 2.3e-5) == 43
    assert filters.steps(1e-9, 2.3e-5) == 1
    assert filters.frame_steps(1.0, 1e-5, 40) == 2500
