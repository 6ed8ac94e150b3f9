"""What a posterior tells: intervals, best values, words, predictions, files."""

from __future__ import annotations

import itertools
import json
import re
from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from calibrate.errors import CalibrationError
from calibrate.inference.determined import determined
from calibrate.inference.intervals import LEVELS, regions, shortest
from calibrate.inference.posterior import Posterior
from calibrate.inference.predictive import predictive, scores
from calibrate.inference.priors import Prior
from calibrate.inference.problem import Place, Problem, Source
from calibrate.inference.sampling import sample
from calibrate.inference.space import Space, Unknown
from calibrate.inference.store import load_posterior, posterior_record, save_posterior
from tests.calibrate.inference.linear import (
    CurvedEmulator,
    box_space,
    direct,
    exact,
    linear,
    normal_space,
    problem_of,
    scalars,
)


def test_intervals_of_a_normal_and_of_an_exponential(rng):
    span = shortest(rng.standard_normal(20_000), 0.90)
    assert (span.low, span.high) == pytest.approx((-1.645, 1.645), abs=0.06)
    assert not (span.open_low)
    assert not (span.open_high)
    span = shortest(0.1 * rng.standard_exponential(20_000), 0.68, 0.0, 1.0)
    assert span.low == pytest.approx(0.0, abs=1e-9)
    assert span.high == pytest.approx(-0.1 * np.log(0.32), abs=0.006)
    assert span.open_low
    assert not span.open_high


def test_intervals_of_a_flat_probability_are_open_at_both_ends(rng):
    span = shortest(rng.random(20_000), 0.95, 0.0, 1.0)
    assert span.high - span.low > 0.93
    assert span.open_low or span.open_high


def test_wider_intervals_contain_narrower_ones(rng):
    humps = np.concatenate([rng.normal(0.3, 0.03, 4000), rng.normal(0.7, 0.05, 6000)])
    spans = [shortest(humps, level, 0.0, 1.0) for level in LEVELS]
    for inner, outer in itertools.pairwise(spans):
        assert outer.low <= inner.low < inner.high <= outer.high


def test_regions_are_separate_where_the_probability_is(rng):
    humps = np.concatenate([rng.normal(0.2, 0.03, 5000), rng.normal(0.7, 0.03, 5000)])
    left, right = regions(humps, 0.90, 0.0, 1.0)
    # Smoothing takes its width from all samples, so that narrow humps are a fifth too wide.
    assert (left.low, left.high) == pytest.approx((0.15, 0.25), abs=0.015)
    assert (right.low, right.high) == pytest.approx((0.65, 0.75), abs=0.015)
    whole = shortest(humps, 0.90, 0.0, 1.0)
    assert (left.low, right.high) == (whole.low, whole.high)
    assert regions(humps[:5000], 0.90, 0.0, 1.0) == [shortest(humps[:5000], 0.90, 0.0, 1.0)]


@pytest.fixture(scope="module")
def ridge() -> tuple[Posterior, Place]:
    """Return the posterior of friction numbers of which a product is measured."""

    def function(u):
        a, b = 0.1 * 8.0 ** u[:, 0], 0.03 * 20.0 ** u[:, 1]
        return np.column_stack([np.log(a) + 0.5 * np.log(b), u[:, 2]])

    unknowns = (
        Unknown("mu_pp", "HSP13", Prior.uniform(0.1, 0.8, "log")),
        Unknown("mu_roll_pp", "HSP13", Prior.uniform(0.03, 0.6, "log")),
        Unknown("mu_pw", "", Prior.uniform(0.1, 0.8)),
        Unknown("mu_roll_pw", "", Prior.uniform(0.03, 0.6, "log")),
    )
    sources = (
        Source(0, low=0.1, high=0.8, spacing="log"),
        Source(1, low=0.03, high=0.6, spacing="log"),
        Source(2, low=0.1, high=0.8),
    )
    readings = scalars([np.log(0.3) + 0.5 * np.log(0.1), 0.5], [0.03, 0.02], repeats=5)
    place = Place("heap", CurvedEmulator(function), sources, (), readings)
    problem = Problem(Space(unknowns), (place,))
    return sample(problem, np.random.default_rng(1), provenance={"study": "hsp13"}), place


def test_best_lies_in_every_interval_that_is_printed(ridge):
    posterior, _ = ridge
    table = posterior.table()
    assert list(table.index) == ["mu_pp[HSP13]", "mu_roll_pp[HSP13]", "mu_pw", "mu_roll_pw"]
    for level in ("68", "90", "95"):
        assert (table[f"low_{level}"] <= table["best"]).all()
        assert (table["best"] <= table[f"high_{level}"]).all()
    np.testing.assert_allclose(posterior.best, table["best"])
    a, b = table["best"].iloc[:2]
    assert np.log(a) + 0.5 * np.log(b) == pytest.approx(np.log(0.3) + 0.5 * np.log(0.1), abs=0.05)


def test_best_lies_inside_in_many_dimensions():
    rng = np.random.default_rng(3)
    size = 12
    slopes = rng.normal(size=(8, size))
    problem = problem_of(
        box_space(size), linear(slopes), scalars(slopes @ rng.random(size), [0.2] * 8)
    )
    table = sample(problem, rng).table()
    assert (table["low_68"] <= table["best"]).all()
    assert (table["best"] <= table["high_68"]).all()


def test_words_say_what_nothing_determines_and_what_only_together(ridge):
    posterior, _ = ridge
    found = determined(posterior, np.random.default_rng(1), {"mu_roll_pw": "a tilting plate"})
    assert found.sentences[0] == (
        "mu_roll_pw: nothing in these data determines it; a tilting plate would"
    )
    (together,) = found.sentences[1:]
    start = "mu_pp[HSP13], mu_roll_pp[HSP13]: only mu_pp[HSP13] mu_roll_pp[HSP13]^"
    assert together.startswith(start)
    power = float(together.removeprefix(start).split()[0])
    assert power == pytest.approx(0.5, abs=0.08)
    assert found.table["determined"].to_dict() == {
        "mu_pp[HSP13]": True, "mu_roll_pp[HSP13]": False, "mu_pw": True, "mu_roll_pw": False,
    }  # fmt: skip
    assert found.table.loc["mu_roll_pw", "ratio"] == pytest.approx(1.0, abs=0.05)
    assert found.table.loc["mu_roll_pw", "nats"] < 0.05
    # uniform against a normal of 0.02 (t of four degrees of freedom)
    assert found.table.loc["mu_pw", "nats"] == pytest.approx(2.3, abs=0.2)
    ridge_way, wall = found.directions["direction"].iloc[:2]
    assert "mu_roll_pp[HSP13]" in ridge_way
    assert wall.endswith("1.00 mu_pw")
    assert found.directions["ratio"].is_monotonic_increasing


@pytest.mark.parametrize(("middle", "width"), [(0.5, 0.45), (0.5, 0.2)])
def test_a_value_in_one_of_two_regions_is_told_in_words_where_they_span_the_range(middle, width):
    """Known squared: u = middle +- width."""
    place = Place(
        "heap", CurvedEmulator(lambda u: (u - middle) ** 2), (Source(0, low=0.1, high=0.8),), (),
        scalars([width**2], [0.01], repeats=5),
    )  # fmt: skip
    space = Space((Unknown("mu_pw", "", Prior.uniform(0.1, 0.8)),))
    found = sample(Problem(space, (place,)), np.random.default_rng(1))
    told = determined(found, np.random.default_rng(2))
    if width > 0.4:
        (words,) = told.sentences
        assert not told.table.loc["mu_pw", "determined"]
        assert re.fullmatch(
            r"mu_pw: 0.1\d* to 0.1\d* or 0.7\d* to 0.\d+ \(68 %\); these data do not say which",
            words,
        )
    else:
        assert told.table.loc["mu_pw", "determined"]
        assert not told.sentences


def test_information_of_a_linear_model_is_that_of_the_algebra():
    slopes, y, se = np.array([[1.0, 1.0]]), [0.4], [0.1]
    found = sample(
        problem_of(normal_space(2), linear(slopes), scalars(y, se)), np.random.default_rng(1)
    )
    told = determined(found, np.random.default_rng(2))
    ratio = np.sqrt(0.01 / 2.01)
    assert told.directions["ratio"].iloc[0] == pytest.approx(ratio, rel=0.08)
    assert told.directions["nats"].iloc[0] == pytest.approx(-np.log(ratio), abs=0.08)
    assert told.sentences == ("x0, x1: only 1 x0 + 1 x1 is determined, neither of them alone",)


def test_predictions_and_scores_of_a_held_out_reading_are_exact():
    slopes, se = np.array([[1.0, 0.5], [0.3, 1.0]]), np.array([0.2, 0.3])
    y = np.array([0.4, -0.2])
    space = normal_space(2)
    posterior = sample(problem_of(space, linear(slopes), scalars(y, se)), np.random.default_rng(1))
    new = np.array([[1.0, -1.0]])
    place = Place("new", linear(new, variance=0.04), direct(2), (), scalars([2.5], [0.5]))
    mean, cov, _ = exact(slopes, y, np.diag(se**2))
    centre, variance = float((new @ mean)[0]), float((new @ cov @ new.T)[0, 0]) + 0.04
    row = predictive([place], posterior.samples, np.random.default_rng(1), kept=4000).iloc[0]
    assert row["mean"] == pytest.approx(centre, abs=0.03)
    assert row["sd"] == pytest.approx(np.sqrt(variance), rel=0.05)
    assert row["q95"] == pytest.approx(centre + 1.645 * np.sqrt(variance), abs=0.05)
    total = np.sqrt(variance + 0.25)
    assert row["z"] == pytest.approx((2.5 - centre) / total, abs=0.08)
    score = scores([place], posterior.samples)["log_score"].iloc[0]
    assert score == pytest.approx(stats.norm.logpdf(2.5, centre, total), abs=0.08)


def test_a_reading_far_away_has_a_finite_deviate(ridge):
    posterior, place = ridge
    far = replace(place, readings=scalars([50.0, 0.5], [0.03, 0.02], repeats=5))
    z = predictive([far], posterior.samples, np.random.default_rng(1))["z"]
    assert np.isfinite(z).all()
    assert z[0] > 4.0
    assert abs(z[1]) < 0.5


def test_a_stored_posterior_is_the_same(ridge, tmp_path):
    posterior, _ = ridge
    save_posterior(posterior, tmp_path / "posterior.npz")
    again = load_posterior(tmp_path / "posterior.npz")
    np.testing.assert_array_equal(again.samples, posterior.samples)
    assert again.space == posterior.space
    assert again.provenance == {"study": "hsp13"}
    assert again.table().equals(posterior.table())
    assert posterior_record(again) == posterior_record(posterior)
    assert (
        json.loads(json.dumps(posterior_record(again)))["space"]["unknowns"][0]["name"] == "mu_pp"
    )


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 broken", b"{}"])
def test_files_that_are_no_posterior_are_told(tmp_path, content):
    path = tmp_path / "posterior.npz"
    path.write_bytes(content)
    with pytest.raises(CalibrationError, match=r"posterior\.npz: no stored posterior"):
        load_posterior(path)
