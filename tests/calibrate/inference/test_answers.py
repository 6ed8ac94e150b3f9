"""What statistics promise: coverage, shrinkage, widening by shared errors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from calibrate.inference.priors import Prior
from calibrate.inference.problem import Place, Problem, Source
from calibrate.inference.sampling import sample
from calibrate.inference.space import Space, Tie, Unknown
from tests.calibrate.inference.linear import (
    direct,
    exact,
    linear,
    normal_space,
    problem_of,
    scalars,
)

STUDIES = 200


@pytest.mark.long
def test_ninety_per_cent_intervals_cover_ninety_per_cent():
    """Truths from the prior, errors estimated from five repeats: 90 % within 86 to 94 %."""
    rng = np.random.default_rng(7)
    slopes = np.array([[1.0, 0.4], [-0.5, 1.0], [0.8, 0.8]])
    hits = []
    for _ in range(STUDIES):
        truth = rng.standard_normal(2)
        repeats = (slopes @ truth)[:, None] + 0.7 * rng.standard_normal((3, 5))
        y, se = repeats.mean(axis=1), repeats.std(axis=1, ddof=1) / np.sqrt(5.0)
        problem = problem_of(normal_space(2), linear(slopes), scalars(y, se, repeats=5))
        found = sample(problem, rng)
        spans = [found.interval(name, 0.90) for name in found.names]
        hits += [s.low <= x <= s.high for s, x in zip(spans, truth, strict=True)]
    assert 0.86 <= np.mean(hits) <= 0.94


def test_a_shared_error_widens_as_the_algebra_says():
    loading = np.array([0.4])
    y, se = [1.0, 1.2, 0.7], [0.3, 0.3, 0.3]
    space = normal_space(1, (Unknown.shared_error("balance"),))
    slopes = np.ones((3, 1))
    problem = problem_of(space, linear(slopes), scalars(y, se, 0, ((1, loading),)), size=1)
    found = sample(problem, np.random.default_rng(1))
    mean, covariance, evidence = exact(slopes, np.array(y), 0.09 * np.eye(3) + 0.16)
    assert found.log_evidence == pytest.approx(evidence, abs=0.05)
    assert found.column("x0").mean() == pytest.approx(mean[0], abs=0.04)
    assert found.column("x0").std() == pytest.approx(np.sqrt(covariance[0, 0]), rel=0.05)
    alone = exact(slopes, np.array(y), 0.09 * np.eye(3))[1]
    assert found.column("x0").std() > 1.5 * np.sqrt(alone[0, 0])
    assert list(found.table().index) == ["x0"]


def tied_problem(y: list[float], se: float, spread: float) -> Problem:
    """Return unknowns tied together, each measured by itself."""
    size = len(y)
    prior = Prior.uniform(0.0, 1.0)
    unknowns = tuple(Unknown("mu", f"M{i}", prior) for i in range(size))
    space = Space(unknowns, (Tie("mu", tuple(range(size)), spread),))
    return problem_of(space, linear(np.eye(size)), scalars(y, [se] * size), size=size)


def tie_by_quadrature(y: np.ndarray, se: float, scale: float):
    """Return evidence and the means of spread and members by sums over mean and spread."""
    mean = np.linspace(0.0005, 0.9995, 1000)[:, None]
    spread = np.linspace(0.0005, 5.0 * scale, 1000)[None]
    weight = (
        stats.halfnorm.pdf(spread, 0.0, scale) * (mean[1] - mean[0]) * (spread[0, 1] - spread[0, 0])
    )
    wide = np.sqrt(spread**2 + se**2)
    for one in y:
        weight = weight * stats.norm.pdf(one, mean, wide)
    total = weight.sum()
    share = spread**2 / (spread**2 + se**2)
    members = [float((weight * (mean + share * (one - mean))).sum() / total) for one in y]
    return np.log(total), float((weight * spread).sum() / total), members


def test_ties_shrink_towards_each_other_and_infer_their_spread():
    y, se, scale = [0.45, 0.50, 0.58], 0.03, 0.1
    found = sample(tied_problem(y, se, scale), np.random.default_rng(3))
    evidence, spread, members = tie_by_quadrature(np.array(y), se, scale)
    assert found.log_evidence == pytest.approx(evidence, abs=0.1)
    assert found.column("spread of mu").mean() == pytest.approx(spread, rel=0.05)
    np.testing.assert_allclose(found.samples[:, :3].mean(axis=0), members, atol=0.003)


def test_two_members_with_the_same_data_gain_from_each_other():
    alone = sample(
        problem_of(normal_space(1), linear([[1.0]]), scalars([0.5], [0.05])),
        np.random.default_rng(1),
    )
    pair = sample(tied_problem([0.5, 0.5], 0.05, 0.02), np.random.default_rng(1))
    wide, narrow = alone.samples[:, 0].std(), pair.samples[:, 0].std()
    assert 0.05 / np.sqrt(2.0) < narrow < 0.9 * wide


def test_two_materials_share_a_wall():
    """One friction seen by two materials is known better, by the square root of two."""
    prior = Prior.normal(0.0, 1.0)
    unknowns = (Unknown("a", "M1", prior), Unknown("a", "M2", prior), Unknown("wall", "", prior))
    emulator = linear(np.array([[1.0, 0.0], [0.0, 1.0]]))
    places = tuple(
        Place(f"M{i}", emulator, (Source(i), Source(2)), (), scalars([0.1, 0.2], [0.2, 0.1]))
        for i in range(2)
    )
    found = sample(Problem(Space(unknowns), places), np.random.default_rng(2))
    assert found.column("wall").std() == pytest.approx(1.0 / np.sqrt(1.0 + 2.0 / 0.01), rel=0.05)
    assert found.column("a[M1]").std() == pytest.approx(1.0 / np.sqrt(1.0 + 25.0), rel=0.05)


def test_an_effect_is_a_strength_in_its_own_unit():
    emulator = replace(linear([[1.0]]), effects=np.array([[2.0]]))
    space = Space(
        (
            Unknown("x", "", Prior.uniform(0.0, 1.0)),
            Unknown("tilt", "", Prior.non_local(1.0, -3.0, 3.0)),
        )
    )
    place = Place(
        "here", emulator, direct(1), (Source(1, high=0.5),), scalars([4.5], [0.1])
    )  # 0.5 degrees are one ordinary strength
    found = sample(Problem(space, (place,)), np.random.default_rng(1))
    tilt = found.column("tilt")
    assert 0.5 * (3.5 / 2.0) - 0.1 < tilt.min() < tilt.max() < 0.5 * (4.5 / 2.0) + 0.1
