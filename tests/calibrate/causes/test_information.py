"""The expected information of a measurement, against closed forms, integrals and Monte Carlo."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import integrate, stats

from calibrate.causes.information import Expected, entropy, information, shares_after
from calibrate.causes.joint_information import Together, joint_information, joint_shares_after

EXACT = 1e-3
"""What the nodes of the integral promise, in nats."""


def _normal(mean: float, sd: float = 1.0) -> Expected:
    return Expected(((1.0, mean, sd),))


def test_what_no_answer_distinguishes_is_worth_nothing():
    assert information([0.2, 0.5, 0.3], [_normal(1.0)] * 3) == 0.0
    # However the same density is put together.
    halves = Expected(((0.5, 1.0, 1.0), (0.5, 1.0, 1.0)))
    assert information([0.6, 0.4], [_normal(1.0), halves]) == pytest.approx(0.0, abs=1e-9)


def test_answers_far_apart_are_told_as_far_as_they_are_open():
    shares = [0.5, 0.3, 0.2]
    told = information(shares, [_normal(0.0), _normal(50.0), _normal(-50.0, 0.01)])
    assert told == pytest.approx(entropy(shares), abs=EXACT)


@pytest.mark.parametrize("share", [0.5, 0.1])
def test_answers_close_together_are_told_as_the_square_of_their_distance(share):
    """To leading order p (1 - p) d^2 / 2; the next order is d^4, 1e-4 of it."""
    d = 0.02
    told = information([share, 1.0 - share], [_normal(0.0), _normal(d)])
    assert told == pytest.approx(0.5 * share * (1.0 - share) * d**2, rel=0.01)


@pytest.mark.parametrize(("mean", "sd"), [(1.0, 1.0), (3.0, 1.0), (0.0, 5.0), (2.0, 100.0)])
def test_two_normals_are_told_as_the_integral_says(mean, sd):
    first, second = stats.norm(0.0, 1.0), stats.norm(mean, sd)

    def told(y: float) -> float:
        f = np.array([first.pdf(y), second.pdf(y)])
        whole = 0.3 * f[0] + 0.7 * f[1]
        return sum(p * x * np.log(x / whole) for p, x in zip((0.3, 0.7), f, strict=True) if x > 0.0)

    ends = (-10.0 * max(1.0, sd), mean + 10.0 * max(1.0, sd))
    exact, _ = integrate.quad(told, *ends, points=[-5.0, 0.0, 5.0], limit=500)
    found = information([0.3, 0.7], [_normal(0.0), _normal(mean, sd)])
    assert found == pytest.approx(exact, abs=EXACT)


def test_a_mixture_of_both_signs_is_told_as_drawn_results_say():
    """By Monte Carlo: the mean of ln(f_h / f) over results; 400 000 give it to 0.002."""
    shares = [0.4, 0.35, 0.25]
    expected = [
        _normal(0.0, 0.3),
        Expected(((0.6, 1.0, 0.5), (0.4, -1.2, 0.4))),
        _normal(0.8, 0.3),
    ]
    rng = np.random.default_rng(1)
    count = 400_000
    answer = rng.choice(3, count, p=shares)
    y = np.empty(count)
    for h, one in enumerate(expected):
        here = np.flatnonzero(answer == h)
        part = rng.choice(len(one.parts), len(here), p=[p for p, _, _ in one.parts])
        mean, sd = np.array([p[1:] for p in one.parts]).T
        y[here] = mean[part] + sd[part] * rng.standard_normal(len(here))
    density = np.array(
        [sum(w * stats.norm(m, s).pdf(y) for w, m, s in one.parts) for one in expected]
    )
    drawn = np.log(density[answer, np.arange(count)] / (np.array(shares) @ density))
    error = drawn.std() / np.sqrt(count)
    assert information(shares, expected) == pytest.approx(drawn.mean(), abs=4.0 * error + EXACT)


answers = st.lists(
    st.tuples(
        st.floats(0.01, 1.0), st.floats(-20.0, 20.0), st.floats(0.01, 30.0), st.floats(-20.0, 20.0)
    ),
    min_size=2,
    max_size=6,
)


@given(answers)
def test_it_lies_between_nothing_and_what_is_open(drawn):
    shares = np.array([p for p, *_ in drawn])
    shares = list(shares / shares.sum())
    expected = [Expected(((0.7, m, s), (0.3, n, 2.0 * s))) for _, m, s, n in drawn]
    assert 0.0 <= information(shares, expected) <= entropy(shares) + EXACT


def test_probabilities_after_a_result_are_those_of_bayes():
    shares = [0.5, 0.3, 0.2]
    expected = [_normal(0.0), _normal(2.0, 0.5), Expected(((0.5, -1.0, 1.0), (0.5, 1.0, 1.0)))]
    density = [
        stats.norm(0.0, 1.0).pdf(1.3),
        stats.norm(2.0, 0.5).pdf(1.3),
        0.5 * (stats.norm(-1.0, 1.0).pdf(1.3) + stats.norm(1.0, 1.0).pdf(1.3)),
    ]
    exact = np.array(shares) * density
    after = shares_after(1.3, shares, expected)
    assert after == pytest.approx(exact / exact.sum(), rel=1e-9)
    # Far from all of them no density is a number any more, and the nearest still leads.
    far = shares_after(1e4, shares, expected)
    assert far.sum() == pytest.approx(1.0)
    assert np.argmax(far) == 2


def _together(mean: list[float], sd: list[float], along: float = 0.0) -> Together:
    """Return normals of two or more numbers; the first two go together with a correlation."""
    covariance = np.diag(np.square(sd))
    if len(sd) > 1:
        covariance[0, 1] = covariance[1, 0] = along * sd[0] * sd[1]
    return Together(np.array(mean), covariance)


DRAWN = 0.03
"""Four standard errors of 20 000 drawn results whose log ratio scatters by 1, in nats."""


@pytest.mark.parametrize(("mean", "sd"), [(1.0, 1.0), (3.0, 1.0), (0.0, 5.0), (2.0, 0.1)])
def test_one_number_among_several_tells_what_the_integral_says(mean, sd):
    shares = [0.3, 0.5, 0.2]
    alone = [_normal(0.0), _normal(mean, sd), _normal(-1.0, 2.0)]
    exact = information(shares, alone)
    one = [_together([m], [s]) for e in alone for _, m, s in e.parts]
    assert joint_information(shares, one, np.random.default_rng(1)) == pytest.approx(
        exact, abs=DRAWN
    )
    # A second number that all expect alike adds nothing.
    two = [_together([m, 7.0], [s, 0.5]) for e in alone for _, m, s in e.parts]
    assert joint_information(shares, two, np.random.default_rng(2)) == pytest.approx(
        exact, abs=DRAWN
    )
    after = joint_shares_after(np.array([0.7, 7.0]), shares, two)
    assert after == pytest.approx(shares_after(0.7, shares, alone), rel=1e-9)


def test_two_numbers_tell_as_much_as_what_differs_between_them():
    """Turned by 45 degrees, a correlation of 0.8 is two numbers of variances 1.8 and 0.2."""
    shares = [0.4, 0.6]
    normals = [_together([0.0, 0.0], [1.0, 1.0], 0.8), _together([0.5, -0.5], [1.0, 1.0], 0.8)]
    apart = np.sqrt(0.5) / np.sqrt(0.2)
    exact = information(shares, [_normal(0.0), _normal(apart)])
    found = joint_information(shares, normals, np.random.default_rng(3))
    assert found == pytest.approx(exact, abs=DRAWN)


def test_several_numbers_that_no_answer_distinguishes_are_worth_nothing():
    alike = [_together([1.0, 2.0, 3.0], [1.0, 0.1, 5.0], 0.5)] * 3
    assert joint_information([0.2, 0.5, 0.3], alike, np.random.default_rng(4)) == pytest.approx(
        0.0, abs=1e-12
    )
