"""A printed value lies in its printed interval; a sentence follows from the number in it."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy import stats

from calibrate.causes.studies.words import contradiction
from calibrate.inference import Interval, Prior
from calibrate.inference.intervals import LEVELS
from calibrate.questions.joint.check import CheckRow as JointRow
from calibrate.report.tables import stage_line
from calibrate.significance import (
    SIGNIFICANT,
    joint_dof,
    normal_score,
    shown,
    significant,
    weighed,
)
from calibrate.staged.answer import intervals_of
from calibrate.staged.check import CheckRow
from calibrate.staged.crossing import Verdict, judge, least_squares_sentence
from calibrate.staged.posterior.grid import GridPosterior, grid_posterior
from calibrate.staged.result import StageResult
from calibrate.staged.samples import Freed
from calibrate.study.schema.stages import Stage
from calibrate.study.schema.targets import Target

QUIET = {"deadline": None, "suppress_health_check": list(HealthCheck)}
UNIT = st.floats(0.0, 1.0)


@st.composite
def likelihoods(draw):
    """Draw a log-likelihood: some ridges of any width and direction, bent or at the edge."""
    humps = []
    for _ in range(draw(st.integers(1, 3))):
        centre = np.array([draw(st.floats(-0.3, 1.3)), draw(st.floats(-0.3, 1.3))])
        angle, bend = draw(st.floats(0.0, math.pi)), draw(st.floats(-3.0, 3.0))
        wide, narrow = (10.0 ** draw(st.floats(-3.0, 0.5)) for _ in range(2))
        humps.append((centre, angle, bend, wide, narrow, draw(st.floats(-3.0, 3.0))))

    def function(u):
        total = np.full(len(u), -np.inf)
        for centre, angle, bend, wide, narrow, height in humps:
            c, s = math.cos(angle), math.sin(angle)
            x, y = ((u - centre) @ np.array([[c, -s], [s, c]])).T
            one = height - 0.5 * ((x / wide) ** 2 + ((y - bend * x**2) / narrow) ** 2)
            total = np.logaddexp(total, one)
        return total

    return function


@given(function=likelihoods())
@settings(max_examples=30, **QUIET)
def test_the_best_point_lies_in_every_interval_of_both_parameters(function):
    posterior = grid_posterior(function, 2)
    best = posterior.best()
    for i in range(2):
        spans = [posterior.interval(i, level) for level in LEVELS]
        for span in spans:
            assert 0.0 <= span.low <= best[i] <= span.high <= 1.0
        assert spans[0].low >= spans[1].low >= spans[2].low
        assert spans[0].high <= spans[1].high <= spans[2].high


@given(data=st.data(), size=st.integers(2, 12))
@settings(max_examples=50, **QUIET)
def test_it_does_so_for_any_table_of_probabilities(data, size: int):
    """Also for single spikes, flat tables and zeros, which no smooth likelihood gives."""
    value = st.one_of(st.just(0.0), st.just(1.0), st.floats(1e-12, 1e12))
    rows = data.draw(st.lists(st.lists(value, min_size=size, max_size=size), min_size=size,
                              max_size=size))  # fmt: skip
    density = np.array(rows) + 0.0
    density[data.draw(st.integers(0, size - 1)), data.draw(st.integers(0, size - 1))] += 1.0
    ends = sorted([data.draw(UNIT), data.draw(UNIT)])
    axis = np.linspace(0.0, 1.0, size) if ends[1] - ends[0] < 1e-3 else np.linspace(*ends, size)
    posterior = GridPosterior((axis, axis), density / density.sum())
    best = posterior.best()
    for i in range(2):
        for level in LEVELS:
            span = posterior.interval(i, level)
            assert span.low <= best[i] <= span.high


def test_the_best_point_is_the_peak_where_that_is_in_both_intervals():
    posterior = grid_posterior(lambda u: -0.5 * np.sum(((u - [0.3, 0.6]) / 0.1) ** 2, axis=1), 2)
    np.testing.assert_allclose(posterior.best(), [0.3, 0.6], atol=0.01)


def test_a_lone_peak_outside_the_crowd_is_not_the_best_point():
    """Nearly all of the probability is broad; a sharp peak far from it is the highest."""

    def function(u):
        broad = math.log(0.97) - np.sum(((u - 0.3) / 0.08) ** 2, axis=1) / 2 - 2 * math.log(0.08)
        sharp = math.log(0.03) - np.sum(((u - 0.9) / 0.01) ** 2, axis=1) / 2 - 2 * math.log(0.01)
        return np.logaddexp(broad, sharp)

    posterior = grid_posterior(function, 2)
    peak = np.unravel_index(int(np.argmax(posterior.density)), posterior.density.shape)
    assert posterior.axes[0][peak[0]] == pytest.approx(0.9, abs=0.02)
    assert posterior.interval(0, 0.68).high < 0.6
    np.testing.assert_allclose(posterior.best(), [0.3, 0.3], atol=0.03)


def test_of_a_flat_probability_the_whole_range_remains():
    posterior = grid_posterior(lambda u: np.zeros(len(u)), 2)
    assert posterior.interval(0, 0.68) == Interval(0.0, 1.0, open_low=True, open_high=True)


@given(function=likelihoods(), low=st.floats(0.0, 10.0), width=st.floats(1e-3, 100.0))
@settings(max_examples=15, **QUIET)
def test_what_is_printed_lies_in_what_is_printed_beside_it(function, low: float, width: float):
    free = {"mu_pp": (low, low + width), "mu_pw": (0.1, 0.8)}
    stage = Stage(name="s", title="S", material="M", free=[*free], targets=["a", "b"], points=8)
    posterior = grid_posterior(function, 2)
    bounds = np.array(list(free.values()))
    priors = tuple(Prior.uniform(*ends) for ends in free.values())
    freed = Freed(tuple((name, "M") for name in free), priors)
    best = posterior.best()
    found = dict(zip(free, bounds[:, 0] + best * (bounds[:, 1] - bounds[:, 0]), strict=True))
    result = StageResult(
        stage=stage, freed=freed, fits=(),
        best=best, found=found,
        intervals=intervals_of(posterior, freed), least_squares=found,
        objective=0.0, posterior=posterior, verdict=Verdict("crossing", (), ()), planned=(),
        runs=None,
    )  # fmt: skip
    printed = re.findall(r"= ([\d.]+) \((?:≤ )?([\d.]+) to (?:≥ )?([\d.]+)\)", stage_line(result))
    assert len(printed) == 2
    for value, lower, upper in printed:
        assert float(lower) <= float(value) <= float(upper)


def said(sentence: str) -> list[float]:
    """Return the differences that a sentence prints."""
    (numbers,) = re.findall(r"z = ((?:[+-][\d.]+(?: and )?)+)", sentence)
    return [float(word) for word in numbers.split(" and ")]


TARGETS = [
    Target(name=name, label=f"label {name}", material="M", surface="glued", experiment="heap",
           observable="angle_deg", unit="deg", file="f.csv", column="a", se_column="b")
    for name in "abc"
]  # fmt: skip


@given(
    z=st.lists(st.floats(-12.0, 12.0), min_size=3, max_size=3),
    tilt=st.lists(st.floats(-30.0, 30.0), min_size=6, max_size=6),
    measured=st.lists(st.floats(5.0, 80.0), min_size=3, max_size=3),
    count=st.integers(2, 3),
)
@settings(max_examples=50, **QUIET)
def test_every_sentence_of_a_stage_follows_from_the_number_it_prints(z, tilt, measured, count):
    slopes = np.array(tilt).reshape(3, 2)[:count]

    def predict(u):
        return 40.0 + (u - 0.5) @ slopes.T + 5.0 * (u[:, :1] - 0.5) ** 2

    flat = grid_posterior(lambda u: np.zeros(len(u)), 2)
    verdict = judge(TARGETS[:count], np.array(measured[:count]), predict, z[:count], flat)
    for sentence in verdict.sentences:
        if "errors" in sentence:
            beyond = any(abs(one) > SIGNIFICANT for one in said(sentence))
            assert ("more than the errors" in sentence) is beyond
            assert ("can explain" in sentence) is not beyond
    worst = max(abs(float(shown(one))) for one in z[:count])
    told = any("cannot meet all targets" in sentence for sentence in verdict.sentences)
    assert told is (worst > SIGNIFICANT)


@given(z=st.lists(st.floats(-1e3, 1e3), min_size=1, max_size=3))
def test_weight_and_number_agree_at_the_limit_too(z):
    text = weighed(*z, errors="everything")
    assert ("more than" in text) is any(abs(one) > SIGNIFICANT for one in said(text))
    assert ("more than" in text) is any(significant(one) for one in z)


@given(t=st.floats(-1e6, 1e6), dof=st.floats(1.0, 1e4))
def test_a_normal_deviate_has_the_probability_of_students_t(t: float, dof: float):
    z = normal_score(t, dof)
    assert abs(z) <= abs(t)
    assert math.copysign(1.0, z) == math.copysign(1.0, t)
    # Tails below 1e-300 cannot be told apart; the rest is the definition.
    if stats.t.sf(abs(t), dof) > 1e-300:
        assert stats.norm.sf(abs(z)) == pytest.approx(stats.t.sf(abs(t), dof), rel=1e-6)


def test_welch_and_satterthwaite_lie_between_the_smaller_and_the_sum():
    assert joint_dof((1.0, 2.0), (1e-9, 5.0)) == pytest.approx(2.0)
    assert joint_dof((1.0, math.inf), (1.0, 2.0)) == pytest.approx(8.0)
    assert joint_dof((1.0, math.inf), (0.0, 2.0)) == math.inf


def row(measured, se, repeats, values):
    values = np.asarray(values, float)
    return CheckRow("n", "l", "s", True, measured, se, repeats, float(values.mean()),
                    float(values.std(ddof=1) / np.sqrt(len(values))), len(values))  # fmt: skip


def test_three_seeds_are_beyond_two_by_chance_as_seldom_as_they_should():
    """Student's ratio itself would be beyond 2 in 18 % of the cases."""
    rng = np.random.default_rng(4)
    rows = [row(0.0, 1e-6, 0, rng.normal(size=3)) for _ in range(3000)]
    share = np.mean([one.significant for one in rows])
    # |z| > 2.05, which is what is shown as beyond 2.0: 4.0 %; its error over 3000 draws is 0.36 %.
    assert share == pytest.approx(2.0 * stats.norm.sf(2.05), abs=3.5 * 0.0036)


def test_a_single_seed_says_nothing():
    one = CheckRow("n", "l", "s", True, 1.0, 0.1, 5, 9.0, math.nan, 1)
    assert math.isnan(one.z)
    assert not one.significant


def test_a_verdict_of_none_is_not_left_alone_with_an_engine_that_misses():
    # A row says simulated minus measured, a sentence of the diagnosis measured minus simulated.
    rows = [
        JointRow(name, "l", "g", math.nan, 1.0, 0.1, 5, 2.0, 0.1, 3, 2.0, 0.1, -z, 0.1)
        for name, z in (("a", 0.4), ("b", -4.9), ("c", 8.9))
    ]
    (found,) = contradiction("none", rows)
    assert said(found) == [8.9]  # the worst first
    assert "b (-4.9)" in found
    assert contradiction("named", rows) == []
    assert contradiction("none", rows[:1]) == []


def test_the_papers_point_is_named_only_where_it_is_outside():
    intervals = {"mu_pw": Interval(0.229, 0.434, False, False),
                 "mu_roll_pw": Interval(0.0, 0.6, True, True)}  # fmt: skip
    assert least_squares_sentence({"mu_pw": 0.3, "mu_roll_pw": 0.1}, intervals, 0.9) == []
    (sentence,) = least_squares_sentence({"mu_pw": 0.2, "mu_roll_pw": 0.1}, intervals, 0.9)
    assert "mu_pw = 0.200" in sentence
    assert "outside the 90 % interval of mu_pw (0.229 to 0.434)" in sentence
