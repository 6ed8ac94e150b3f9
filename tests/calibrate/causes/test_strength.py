"""Priors of strengths, and grids on which they are integrated."""

from __future__ import annotations

import numpy as np
import pytest

from calibrate.causes.strengths.about import about_of, span_of
from calibrate.causes.strengths.grids import Line, Plane
from calibrate.causes.strengths.on_grid import gain_on_grid
from calibrate.causes.strengths.prior import StrengthPrior
from calibrate.causes.strengths.terms import Cross, Terms, gain_across, gain_along
from calibrate.causes.strengths.widened import FACTOR, widened

FREE = StrengthPrior(-6.0, 6.0, 2.0)
ONE_SIGN = StrengthPrior(0.0, 6.0, 2.0)
ON = StrengthPrior(1.0, 1.0, 2.0)
R, A, C = np.array([3.0, -1.0, 0.5]), np.array([1.0, 0.5, 0.0]), np.array([0.1, 0.0, 0.2])


@pytest.mark.parametrize("prior", [FREE, ONE_SIGN, StrengthPrior(-1.0, 6.0, 2.0)])
def test_a_prior_has_mass_one_and_none_at_zero(prior):
    x = np.linspace(prior.low, prior.high, 20_001)
    density = np.exp(prior.log_density(x))
    assert np.trapezoid(density, x) == pytest.approx(1.0, abs=1e-4)
    assert density[np.argmin(np.abs(x))] < 1e-6
    drawn = prior.draw(20_000, np.random.default_rng(1))
    # Five standard errors of a mean of numbers that scatter by 3.5 at most.
    assert drawn.mean() == pytest.approx(np.trapezoid(x * density, x), abs=0.13)


def _terms(r=R, a=A, c=C, doubt=0.0, freedom=0.0):
    products = np.array([r @ r, r @ a, r @ c, a @ a, a @ c, c @ c])[:, None]
    return Terms(products, np.array([doubt]), np.array([freedom]), len(r))


def _density(left, grown, freedom):
    square, levels = np.sum(left**2) / (1.0 + grown), len(left)
    wide = -0.5 * levels * np.log(1.0 + grown)
    if not freedom:
        return -0.5 * square + wide
    return -0.5 * (freedom + levels) * np.log1p(square / freedom) + wide


def _along(x, a=A, c=C, r=R):
    """Return the gain of a known error, level by level."""
    left = r - np.multiply.outer(x, a) - np.multiply.outer(x**2, c)
    return 0.5 * (r @ r - np.sum(left**2, axis=1))


@pytest.mark.parametrize("freedom", [0.0, 4.0])
def test_gains_are_those_of_what_is_left(freedom):
    terms = _terms(doubt=0.05, freedom=freedom)
    x = np.array([-2.0, 0.0, 1.5])
    told = gain_along([terms], x, 1)[0]
    plain = _density(R, 0.0, freedom)
    exact = [_density(R - k * A - k**2 * C, 0.05 * k**2, freedom) - plain for k in x]
    assert told == pytest.approx(exact)


def test_an_integral_over_a_strength_is_that_of_a_fine_sum():
    line = Line.of([_terms(), _terms(0.5 * R, 2.0 * A, 0.0 * C)], FREE, np.zeros(1))
    x = np.linspace(-6.0, 6.0, 40_001)
    gain = _along(x) + _along(x, 2.0 * A, 0.0 * C, 0.5 * R)
    exact = np.log(np.trapezoid(np.exp(gain + FREE.log_density(x)), x))
    assert line.log_integral[0] == pytest.approx(exact, abs=0.01)


def test_strengths_are_drawn_as_probable_as_they_are():
    line = Line.of([_terms()], FREE, np.zeros(1))
    many = Line(line.nodes, line.width, np.repeat(line.log_part, 20_000, axis=0))
    x, log_drawn = many.draw(np.random.default_rng(2))
    gain = _along(x) + FREE.log_density(x)
    weights = np.exp(gain - log_drawn)
    assert np.log(weights.mean()) == pytest.approx(line.log_integral[0], abs=0.02)
    assert weights.std() < 0.5 * weights.mean()


@pytest.mark.parametrize(
    "freedoms", [(0.0,) * 3, (4.0,) * 3, (4.0,) * 15, (4.0, 0.0, 7.0, 7.0, 4.0, 0.0, 4.0)]
)
def test_gains_of_two_causes_are_those_of_what_is_left_in_all_readings(freedoms):
    # So uncertain an answer of so many levels grows beyond any number that a machine has.
    doubts = (0.0, 0.05, 1e300)
    readings = [(doubts[k % 3], freedom) for k, freedom in enumerate(freedoms)]
    b, d = np.array([0.3, 1.0, -0.5]), np.array([0.0, 0.2, 0.1])
    mixed = np.array([A @ b, A @ d, C @ b, C @ d])[:, None]
    cross = [Cross(_terms(doubt=e, freedom=f), _terms(a=b, c=d, doubt=e), mixed)
             for e, f in readings]  # fmt: skip
    x, y = np.array([-2.0, 0.0, 1.5]), np.array([0.5, 3.0])
    told = gain_across(cross, x, y, 1)[0]
    for i, p in enumerate(x):
        for j, q in enumerate(y):
            left = R - p * A - p**2 * C - q * b - q**2 * d
            each = [_density(left, e * (p**2 + q**2), f) - _density(R, 0.0, f) for e, f in readings]
            assert told[i, j] == pytest.approx(sum(each))


def test_two_strengths_together():
    d = np.array([0.0, 1.0, -0.5])
    none = np.zeros(3)
    mixed = np.array([A @ d, A @ none, C @ d, C @ none])[:, None]
    cross = Cross(_terms(), _terms(R, d, none), mixed)
    plane = Plane.of([cross], (FREE, ONE_SIGN), np.zeros(1))
    x, y = np.linspace(-6, 6, 601), np.linspace(0, 6, 301)
    left = R - x[:, None, None] * A - x[:, None, None] ** 2 * C - y[None, :, None] * d
    log_part = 0.5 * (R @ R - np.sum(left**2, axis=2))
    log_part = log_part + FREE.log_density(x)[:, None] + ONE_SIGN.log_density(y)
    exact = np.log(np.trapezoid(np.trapezoid(np.exp(log_part), y), x))
    assert plane.log_integral[0] == pytest.approx(exact, abs=0.03)


def test_what_is_on_or_off_has_one_strength():
    line = Line.of([_terms()], ON, np.zeros(1))
    assert line.log_integral[0] == pytest.approx(_along(np.ones(1))[0])
    x, log_drawn = line.draw(np.random.default_rng(1))
    assert (x[0], log_drawn[0]) == (1.0, 0.0)


def test_a_measured_strength_is_believed_as_far_as_its_error():
    known = StrengthPrior(-6.0, 6.0, 2.0, (2.0, 0.1))
    x = np.array([2.0, 2.5])
    plain = FREE.log_density(x)
    normal = -0.5 * ((x - 2.0) / 0.1) ** 2 - np.log(0.1 * np.sqrt(2.0 * np.pi))
    assert known.log_density(x) == pytest.approx(plain + normal)


def test_a_span_holds_most_of_the_probability():
    rng = np.random.default_rng(1)
    x = rng.normal(3.0, 1.0, 20000)
    weights = np.exp(-0.5 * ((x - 3.0) / 0.5) ** 2)
    found = span_of(x, weights / weights.sum())
    # Normal times normal: a standard deviation of 0.447, of which 1.28 hold what lies within.
    assert found == pytest.approx((3.0 - 0.573, 3.0, 3.0 + 0.573), abs=0.03)


@pytest.mark.parametrize(
    ("span", "known", "about"),
    [
        ((1.8, 2.0, 2.2), None, (1.3, 2.7)),
        ((-3.0, -2.0, -1.0), None, (-3.0, -1.0)),
        ((0.1, 2.0, 4.0), None, None),
        ((-1.0, 0.2, 1.2), None, None),
        ((1.8, 2.0, 2.2), (1.0, 2.1), None),
        ((1.8, 2.0, 2.2), (2.1, 3.0), (1.3, 2.7)),
    ],
)
def test_a_parabola_is_right_about_a_strength_that_is_known(span, known, about):
    """It stays the usual one where little is known, and where it is right there already."""
    assert about_of(span, known) == (None if about is None else pytest.approx(about))


@pytest.mark.parametrize("prior", [FREE, ONE_SIGN, StrengthPrior(-6.0, 6.0, 2.0, (1.0, 0.1))])
def test_draws_evened_are_where_the_data_are(prior: StrengthPrior):
    centre, se = 4.4, 0.4
    rng = np.random.default_rng(4)
    x = prior.draw(400_000, rng)
    posterior = -0.5 * ((x - centre) / se) ** 2
    plain, evened = (
        np.average(x, weights=np.exp(log - log.max()))
        for log in (posterior, posterior + prior.log_evened(x))
    )
    # A thousand draws and more count; what was measured before is data and is left alone.
    assert evened == pytest.approx(centre, abs=4.0 * se / np.sqrt(1000.0))
    # x^2 exp(-x^2 / 8) moves it by se^2 (2 / x - x / 4) = -0.10, were it straight there.
    assert plain < centre - 0.08


def test_a_cause_that_is_on_or_off_has_nothing_to_even():
    assert ON.log_evened(np.ones(3)).tolist() == [0.0, 0.0, 0.0]


def test_draws_are_widened_about_their_median_and_stay_in_the_limits(rng):
    draws = np.append(rng.normal(3.0, 1.0, 2000), 3.0)
    wide = widened(draws, 0.0, 5.0)
    assert np.median(wide) == pytest.approx(np.median(draws))
    inside = (wide > 0.0) & (wide < 5.0)
    away = draws - np.median(draws)
    assert (wide - np.median(draws))[inside] == pytest.approx(FACTOR * away[inside])
    assert (wide.min(), wide.max()) == (0.0, 5.0)
    assert widened(np.ones(5), 1.0, 1.0).tolist() == [1.0] * 5


@pytest.mark.parametrize("freedom", [0.0, 3.0])
@pytest.mark.parametrize("doubt", [0.0, 1e-9, 1.0, 1e12, 1e60])
def test_the_gain_is_that_of_the_formula_however_doubtful_an_answer_is(freedom, doubt):
    rng = np.random.default_rng(3)
    size, y = 12, np.array([-3.0, -0.01, 0.0, 0.5, 2.0, 7.0, 40.0])
    left, slope, bend = rng.standard_normal((3, size)) * [[2.0], [1.0], [0.1]]
    products = np.zeros((2, 15, 1))  # the same reading twice; the first cause does nothing
    pairs = {0: left @ left, 6: left @ slope, 7: left @ bend}
    pairs |= {8: slope @ slope, 9: slope @ bend, 10: bend @ bend}
    products[:, list(pairs), 0] = list(pairs.values())
    doubts = np.array([[[0.0], [doubt]]] * 2)
    free, levels = np.full((2, 1), freedom), np.array([size, size])
    (found,) = gain_on_grid(products, doubts, free, levels, np.zeros(1), y)[0]

    wider = 1.0 + doubt * y**2
    rest = np.sum((left - np.multiply.outer(y, slope) - np.multiply.outer(y**2, bend)) ** 2, axis=1)
    alone = left @ left
    if freedom:
        tails = np.log((freedom + alone) / (freedom + rest / wider))
        expected = 0.5 * (freedom + size) * tails - 0.5 * size * np.log(wider)
    else:
        expected = 0.5 * (alone - rest / wider) - 0.5 * size * np.log(wider)
    # Differences of numbers of some thousand.
    assert found == pytest.approx(2.0 * expected, rel=1e-11, abs=1e-10)


def test_a_gain_of_what_is_no_number_is_none():
    products = np.full((1, 15, 1), np.nan)
    found = gain_on_grid(
        products, np.zeros((1, 2, 1)), np.full((1, 1), 3.0), np.ones(1, dtype=int),
        np.ones(1), np.ones(3),
    )  # fmt: skip
    assert np.isnan(found).all()
