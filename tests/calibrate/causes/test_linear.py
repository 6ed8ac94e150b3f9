"""Linear problems with normal priors: evidence, absorbed share and bias have exact answers."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from calibrate.causes.bank import bank_of, sways
from calibrate.causes.candidates import Candidate, Measured
from calibrate.causes.hypotheses import weigh_hypothesis
from calibrate.causes.imagined import expected, imagine
from calibrate.causes.visibility import visibility
from calibrate.inference.priors import Prior
from tests.calibrate.causes.formula import board, linear

J = np.array([[1.0, 0.3], [0.2, 1.0], [0.6, -0.5], [0.1, 0.4]])
G = np.array([[0.8, 0.1], [0.5, 0.0], [-0.4, 0.0], [0.3, 0.2]])
SE = np.array([0.2, 0.25, 0.15, 0.3])
Y = np.array([0.9, 0.7, -0.5, 0.8])
LIMIT = 5.0
ONE = Candidate("one", "one", 1.0, -LIMIT, LIMIT, ((0, 0),))
HALF = Candidate("half", "half", 0.5, 0.0, LIMIT, ((0, 1),))
NORMAL = (Prior.normal(0.2, 1.0), Prior.normal(-0.1, 1.0))
MEAN = np.array([0.2, -0.1])


def _board(**changes):
    return board(linear(J, G), Y, SE, (ONE, HALF), priors=NORMAL, effects=2, **changes)


def _marginal():
    return np.diag(SE**2) + J @ J.T


def _exact(column, candidate, bench=None):
    """Return the evidence with one candidate by integration over its strength."""
    phi = np.linspace(candidate.low, candidate.high, 4001)
    away = (Y - J @ MEAN) - phi[:, None] * G[:, column] / candidate.scale
    seen = stats.multivariate_normal(np.zeros(len(Y)), _marginal()).pdf(away)
    prior = phi**2 * stats.norm(0.0, 2.0 * candidate.scale).pdf(phi)
    measured = stats.norm(phi, bench.se).pdf(bench.value) if bench else 1.0
    return np.log(np.sum(prior * seen * measured) / np.sum(prior))


def test_evidence_without_a_cause_is_the_normal_density():
    found = weigh_hypothesis(_board().hypothesis(), seed=1)
    exact = stats.multivariate_normal(J @ MEAN, _marginal()).logpdf(Y)
    assert found.size > 500
    assert found.log_evidence == pytest.approx(exact, abs=5 * max(found.error, 0.005))


@pytest.mark.parametrize(("column", "candidate"), [(0, ONE), (1, HALF)])
def test_evidence_with_a_cause_is_the_integral_over_its_strength(column, candidate):
    found = weigh_hypothesis(_board().hypothesis(candidate.name), seed=1)
    exact = _exact(column, candidate)
    assert found.error < 0.05
    assert found.log_evidence == pytest.approx(exact, abs=5 * found.error)


def test_an_effect_that_was_measured_counts_for_and_against_it():
    bench = Measured(1.5, 0.1)
    with_it = _board(measured={"one": bench})
    found = weigh_hypothesis(with_it.hypothesis("one"), seed=1)
    assert found.log_evidence == pytest.approx(_exact(0, ONE, bench), abs=5 * found.error)
    without = weigh_hypothesis(with_it.hypothesis(), seed=1)
    plain = weigh_hypothesis(_board().hypothesis(), seed=1)
    zero = stats.norm(0.0, 0.1).logpdf(1.5)
    assert without.log_evidence == pytest.approx(plain.log_evidence + zero, abs=1e-9)


def test_order_names_and_other_candidates_change_no_evidence():
    alone = weigh_hypothesis(_board().hypothesis("half"), seed=4).log_evidence
    renamed = Candidate("zebra", "half", 0.5, 0.0, LIMIT, ((0, 1),))
    more = board(linear(J, G), Y, SE, (renamed, ONE), priors=NORMAL, effects=2)
    assert weigh_hypothesis(more.hypothesis("zebra"), seed=4).log_evidence == alone


def test_absorbed_share_limit_and_bias_are_those_of_the_linear_problem():
    one = _board()
    seen = visibility(one, weigh_hypothesis(one.hypothesis(), seed=1))
    inverse = np.linalg.inv(_marginal())
    for k, candidate in enumerate((ONE, HALF)):
        g = G[:, k] / candidate.scale
        information = g @ inverse @ g
        row = seen.of(candidate.name)
        assert row.absorbed == pytest.approx(1 - information / np.sum((g / SE) ** 2), abs=0.02)
        assert row.detectable == pytest.approx(2.8 / np.sqrt(information), rel=0.05)
        bias = J.T @ inverse @ g
        assert [row.bias["p0"], row.bias["p1"]] == pytest.approx(list(bias), abs=0.05)


def test_a_cause_that_the_parameters_imitate_exactly_is_invisible():
    imitated = np.column_stack([J @ [1.0, 2.0], G[:, 1]])
    one = board(linear(1e3 * J, imitated), Y, SE, (ONE,), priors=NORMAL, effects=2)
    row = visibility(one, weigh_hypothesis(one.hypothesis(), seed=1)).of("one")
    assert row.absorbed > 0.9999
    assert not row.visible


def test_a_bank_tells_the_evidence_of_imagined_studies(monkeypatch):
    one = _board()
    base = weigh_hypothesis(one.hypothesis(), seed=1)
    studies = imagine(base.hypothesis, base.samples, 40, np.random.default_rng(2))
    data = np.column_stack([y[:, 0] for y in studies.readings])
    normal = stats.multivariate_normal(J @ MEAN, _marginal())
    centre = expected(base.hypothesis, base.best)
    found = bank_of(one.hypothesis(), centre, 3, base).log_evidences(studies)
    assert found == pytest.approx([normal.logpdf(y) for y in data], abs=0.3)
    # the p value of a study among the others is that of the exact evidences
    told = np.array([np.mean(found <= one) for one in found])
    true = normal.logpdf(data)
    assert told == pytest.approx([np.mean(true <= one) for one in true], abs=0.1)
    exact = []
    for y in data:
        monkeypatch.setattr("tests.calibrate.causes.test_linear.Y", y)
        exact.append(_exact(0, ONE))
    error = bank_of(one.hypothesis("one"), centre, 3, base).log_evidences(studies) - exact
    assert np.sqrt(np.mean(error**2)) < 0.2
    assert np.abs(error).max() < 0.6


def test_imagined_studies_scatter_as_the_errors_say():
    one = board(linear(J, G, 0.04), Y, SE, (ONE,), priors=NORMAL, effects=2, repeats=6)
    base = one.hypothesis()
    studies = imagine(base, np.tile(MEAN, (5, 1)), 40_000, np.random.default_rng(2))
    for k, y in enumerate(studies.readings):
        # an error estimated from 6 repeats scatters as Student's t with 5 degrees of freedom
        assert y.std() == pytest.approx(np.sqrt(0.04 + SE[k] ** 2 * 5 / 3), rel=0.03)
        assert y.mean() == pytest.approx(J[k] @ MEAN, abs=0.01)


def test_a_log_ratio_sways_as_emulators_from_other_runs_make_it():
    """Emulators from other runs are simulated: other slopes' offsets with the stated variance."""
    variance = 0.05
    one = board(linear(J, G, variance), Y, SE, (ONE,), priors=NORMAL, effects=2)
    base = weigh_hypothesis(one.hypothesis(), seed=1)
    told = sways(base, [weigh_hypothesis(one.hypothesis("one"), 1, base)], seed=1)[0]
    rng = np.random.default_rng(3)
    phi = np.linspace(-LIMIT, LIMIT, 2001)
    prior = phi**2 * stats.norm(0.0, 2.0).pdf(phi)
    normal = stats.multivariate_normal(np.zeros(len(Y)), _marginal() + variance * np.eye(len(Y)))
    ratios = []
    for _ in range(400):
        away = Y - J @ MEAN - np.sqrt(variance) * rng.standard_normal(len(Y))
        seen = normal.pdf(away - phi[:, None] * G[:, 0])
        ratios.append(np.log(np.sum(prior * seen) / np.sum(prior)) - normal.logpdf(away))
    assert told == pytest.approx(np.std(ratios), rel=0.2)


def test_the_base_model_as_start_changes_no_evidence():
    one = _board()
    base = weigh_hypothesis(one.hypothesis(), seed=1)
    warm = weigh_hypothesis(one.hypothesis("one"), 1, base)
    cold = weigh_hypothesis(one.hypothesis("one"), 1)
    assert warm.log_evidence == pytest.approx(cold.log_evidence, abs=5 * (warm.error + cold.error))
