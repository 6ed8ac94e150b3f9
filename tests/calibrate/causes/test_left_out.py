"""What is expected of readings that had no part, against the exact answers of a linear problem.

With a strong cause in the data the base model has to lie elsewhere without a reading.
"""

from __future__ import annotations

import functools

import numpy as np
import pytest
from scipy import special, stats

from calibrate.causes.candidates import Candidate, board_of_problem
from calibrate.causes.diagnosis import Options, diagnose
from calibrate.causes.left_out import told_by_others
from calibrate.causes.residuals import groups_left_out
from calibrate.inference.priors import Prior
from calibrate.inference.problem import Place, Problem, Reading, Source
from calibrate.inference.space import Space, Unknown
from tests.calibrate.causes.formula import linear

UNKNOWNS = 3
J = np.random.default_rng(3).normal(size=(7, UNKNOWNS))
G = np.array([0.0, 0.0, 1.0, 0.9, 0.0, -0.7, 0.3])
SE, LIMIT = 0.2, 8.0
PHI = np.linspace(-LIMIT, LIMIT, 4001)
BELIEVED = PHI**2 * stats.norm(0.0, 2.0).pdf(PHI)
SPREAD = SE**2 * np.eye(len(G)) + J @ J.T
STRENGTHS = [1.0, 3.0, 5.0]
CLOSE = 0.1
"""Of a gain: covariances are told by 200 effective draws or more, so to a tenth."""
NEAR = 0.25
"""Of a distance: its width is told by 10 effective draws or more, so to 22 %."""


def _measured(strength):
    rng = np.random.default_rng(round(10 * strength))
    return J @ rng.normal(size=UNKNOWNS) + strength * G + SE * rng.normal(size=len(G))


@functools.cache
def _found(strength):
    unknowns = tuple(Unknown(f"p{k}", "", Prior.normal(0.0, 1.0)) for k in range(UNKNOWNS))
    sources = tuple(Source(k) for k in range(UNKNOWNS))
    places = tuple(
        Place(
            f"place{k}", linear(J[[k]], G[[k], None]), sources, (Source(),),
            (Reading(f"y{k}", slice(0, 1), np.array([value]), np.array([SE])),),
        )
        for k, value in enumerate(_measured(strength))
    )  # fmt: skip
    cause = Candidate("one", "one", 1.0, -LIMIT, LIMIT, tuple((k, 0) for k in range(len(G))))
    problem = Problem(Space(unknowns), places)
    board = board_of_problem(problem, (cause,), {}, np.random.default_rng(0))
    return diagnose(board, np.random.default_rng(1), options=Options(held_out=True))


def _log_evidence(y, which, *, cause):
    normal = stats.multivariate_normal(np.zeros(len(which)), SPREAD[np.ix_(which, which)])
    if not cause:
        return float(normal.logpdf(y[which]))
    away = y[which] - PHI[:, None] * G[which]
    return float(special.logsumexp(normal.logpdf(away), b=BELIEVED / BELIEVED.sum()))


def _exact_gains(y):
    every = list(range(len(G)))
    told = []
    for k in every:
        others = [i for i in every if i != k]
        held = [
            _log_evidence(y, every, cause=on) - _log_evidence(y, others, cause=on)
            for on in (True, False)
        ]
        told.append(held[0] - held[1])
    return np.array(told)


def _conditional(which):
    """Return what the base model tells of some readings from all others: weights, covariance."""
    others = [k for k in range(len(G)) if k not in which]
    weights = np.linalg.solve(SPREAD[np.ix_(others, others)], SPREAD[np.ix_(others, which)])
    covariance = SPREAD[np.ix_(which, which)] - weights.T @ SPREAD[np.ix_(others, which)]
    return others, weights, covariance


@pytest.mark.parametrize("strength", STRENGTHS)
def test_the_gain_is_the_ratio_of_the_evidences(strength):
    (told,) = _found(strength).gains
    exact = _exact_gains(_measured(strength))
    np.testing.assert_allclose(list(told.by_place.values()), exact, rtol=CLOSE, atol=0.5)
    assert told.log_density == pytest.approx(exact.sum(), rel=CLOSE)


@pytest.mark.parametrize("strength", STRENGTHS)
def test_gains_on_new_data_lie_where_they_are_claimed(strength):
    """New data of the same truth: the gain of each place given the others as they were measured."""
    found, y = _found(strength), _measured(strength)
    both = [told_by_others(found.found, names) for names in (("one",), ())]
    rng = np.random.default_rng(4)
    true = y - SE * np.random.default_rng(round(10 * strength)).normal(size=UNKNOWNS + len(G))[3:]
    new = true + SE * rng.normal(size=(2000, len(G)))
    real = sum(
        after.log_density(new[:, [k]]) - before.log_density(new[:, [k]])
        for k, (after, before) in enumerate(zip(*both, strict=True))
    )
    (claimed,) = found.gains
    assert np.mean((claimed.low < real) & (real < claimed.high)) > 0.8


@pytest.mark.parametrize("strength", STRENGTHS)
def test_distances_from_what_the_others_predict(strength):
    y = _measured(strength)
    for k, row in enumerate(_found(strength).residuals):
        others, weights, covariance = _conditional([k])
        exact = (y[k] - weights[:, 0] @ y[others]) / np.sqrt(covariance[0, 0])
        assert row.z_left_out == pytest.approx(exact, rel=NEAR, abs=0.3), row.name


@pytest.mark.parametrize("strength", STRENGTHS)
def test_distances_of_readings_that_are_left_out_together(strength):
    y, which = _measured(strength), [2, 3, 5]
    others, weights, covariance = _conditional(which)
    z = (y[which] - weights.T @ y[others]) / np.sqrt(np.diag(covariance))
    (told,) = groups_left_out(_found(strength).found, {("wall", "steel"): which})
    assert told.z == pytest.approx(np.sqrt(np.mean(z**2)), rel=NEAR, abs=0.3)
