"""Hypotheses of many unknowns are weighed by their modes: exact where everything is straight."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import special, stats

from calibrate.causes.candidates import Candidate
from calibrate.causes.weighing.by_modes import ERROR, PARTS, evened
from calibrate.causes.weighing.evidences import Effort
from calibrate.causes.weighing.unknown import SIZES
from calibrate.causes.weighing.weigh_all import MANY, weigh_all
from calibrate.inference.priors import Prior
from tests.calibrate.causes.formula import board, linear

K, N = 2 * MANY, 30
SE = 0.1
HIDDEN = (2.0, -2.5)
LIMIT = 6.0
ONE = Candidate("one", "one", 1.0, -LIMIT, LIMIT, ((0, 0),))
OTHER = Candidate("other", "other", 1.0, -LIMIT, LIMIT, ((0, 1),))
IDLE = Candidate("idle", "idle", 1.0, -LIMIT, LIMIT, ((0, 2),))
CANDIDATES = (ONE, OTHER, IDLE)
GRID = 0.05
"""Nats that the grids of strengths may cost; nothing else is approximate where all is straight."""


@pytest.fixture(scope="module")
def told():
    """Return the fractions that a person who waits is told."""
    return []


@pytest.fixture(scope="module")
def study(told):
    """Return the slopes of a study, its causes' answers, what was measured, and the weighed."""
    rng = np.random.default_rng(1)
    slopes = rng.standard_normal((N, K)) / np.sqrt(K)
    answers = 0.3 * rng.standard_normal((N, 3))
    y = slopes @ rng.standard_normal(K) + answers[:, :2] @ HIDDEN + SE * rng.standard_normal(N)
    priors = (Prior.normal(0.0, 1.0),) * K
    one = board(linear(slopes, answers), y, np.full(N, SE), CANDIDATES, priors=priors, effects=3)
    found = weigh_all(
        one, np.random.default_rng(2), lambda _what, share: told.append(share), Effort()
    )
    return slopes, answers, y, found


def test_who_waits_is_told_of_each_cause(study, told):
    del study
    assert told == sorted(told)
    assert sum(0.2 < share <= 0.5 for share in told) >= len(CANDIDATES)


def _prior():
    phi = np.linspace(-LIMIT, LIMIT, 801)
    prior = phi**2 * stats.norm(0.0, 2.0).pdf(phi)
    return phi, prior / prior.sum()


def _normal(slopes, more=0.0):
    covariance = SE**2 * np.eye(N) + slopes @ slopes.T + more * np.eye(N)
    return stats.multivariate_normal(np.zeros(N), covariance)


def test_evidences_are_the_integrals(study):
    slopes, answers, y, found = study
    normal, (phi, prior) = _normal(slopes), _prior()
    assert found.base.log_evidence == pytest.approx(normal.logpdf(y), abs=GRID)
    assert found.base.error == ERROR
    for k, one in enumerate(CANDIDATES):
        away = y - phi[:, None] * answers[:, k]
        exact = np.log(np.sum(prior * np.exp(normal.logpdf(away) - normal.logpdf(y))))
        ratio = found.weighed[one.name,].log_evidence - found.base.log_evidence
        assert ratio == pytest.approx(exact, abs=GRID)
    both = np.multiply.outer(phi, answers[:, 0])[:, None] + np.multiply.outer(phi, answers[:, 1])
    gain = normal.logpdf(y - both) - normal.logpdf(y)
    exact = np.log(np.sum(np.multiply.outer(prior, prior) * np.exp(gain)))
    ratio = found.weighed["one", "other"].log_evidence - found.base.log_evidence
    assert ratio == pytest.approx(exact, abs=GRID)
    best = max(found.weighed.values(), key=lambda one: one.log_evidence)
    assert best.names == ("one", "other")


def test_what_is_in_no_library_is_weighed_as_well(study):
    slopes, _, y, found = study
    spreads = np.array(found.board.spreads)
    each = []
    for size in SIZES:
        more = np.diag((size * spreads) ** 2)
        covariance = SE**2 * np.eye(N) + slopes @ slopes.T + more
        each.append(stats.multivariate_normal(np.zeros(N), covariance).logpdf(y))
    exact = np.logaddexp.reduce(each) - np.log(len(SIZES))
    assert found.weighed["unknown in rig",].log_evidence == pytest.approx(exact, abs=GRID)


def test_draws_tell_strengths_though_few_of_them_would_count(study):
    slopes, answers, y, found = study
    one = found.weighed["one", "other"]
    inverse = np.linalg.inv(_normal(slopes).cov_object.covariance)
    g = answers[:, :2]
    covariance = np.linalg.inv(g.T @ inverse @ g + np.eye(2) / 4.0)
    middle = covariance @ (g.T @ inverse @ y)
    told = one.weights @ one.strengths
    # With a hundred effective draws a mean is known to a tenth of the width.
    assert (np.abs(told - middle) < 0.5 * np.sqrt(covariance.diagonal())).all()


@pytest.mark.parametrize("heavy", [0.0, 3.0, 100.0])
def test_no_draw_holds_more_than_its_part(heavy, rng):
    log_weight = rng.standard_normal(500)
    log_weight[7] += heavy
    log_weight[8] = -np.inf
    share = special.softmax(evened(log_weight))
    assert share.max() <= 1.0 / PARTS + 1e-12
    assert share[8] == 0.0
    light = np.flatnonzero((share > 0.0) & (share < share.max()))
    # What is not cut keeps its weights among each other.
    assert np.ptp(np.log(share[light]) - log_weight[light]) == pytest.approx(0.0, abs=1e-9)


def test_fewer_draws_than_parts_weigh_alike():
    share = special.softmax(evened(np.array([0.0, 50.0, -np.inf, 3.0])))
    assert share == pytest.approx([1 / 3, 1 / 3, 0.0, 1 / 3])
