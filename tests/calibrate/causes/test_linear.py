"""Linear problems with normal priors: evidence, absorbed share and bias have exact answers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from calibrate.causes.candidates import Candidate, Measured
from calibrate.causes.judging.levels import Levels
from calibrate.causes.judging.straight import straight_at
from calibrate.causes.judging.verdict import heaviest_tangent
from calibrate.causes.judging.visibility import visibility
from calibrate.causes.residuals import groups_left_out
from calibrate.causes.sway import OTHERS, lasting, sways
from calibrate.causes.weighing.evidences import Effort
from calibrate.causes.weighing.weigh_all import weigh_all
from calibrate.emulator.types import Prediction
from calibrate.inference.priors import Prior
from tests.calibrate.causes.formula import board, linear

J = np.array([[1.0, 0.3], [0.2, 1.0], [0.6, -0.5], [0.1, 0.4]])
G = np.array([[0.8, 0.1], [0.5, 0.0], [-0.4, 0.0], [0.3, 0.2]])
SE = np.array([0.2, 0.25, 0.15, 0.3])
Y = np.array([0.9, 0.7, -0.5, 0.8])
LIMIT = 5.0
ONE = Candidate("one", "one", 1.0, -LIMIT, LIMIT, ((0, 0),))
HALF = Candidate("half", "half", 0.5, 0.0, 0.5 * LIMIT, ((0, 1),))
NORMAL = (Prior.normal(0.2, 1.0), Prior.normal(-0.1, 1.0))
MEAN = np.array([0.2, -0.1])
SHARP = Effort(enough=1500.0)
"""Log evidences to 0.03."""
CLOSE = 0.15
"""Five of these errors."""


def _board(candidates=(ONE, HALF), **changes):
    return board(linear(J, G), Y, SE, candidates, priors=NORMAL, effects=2, **changes)


def _weighed(one=None, seed=1):
    return weigh_all(one or _board(), np.random.default_rng(seed), effort=SHARP)


def _marginal():
    return np.diag(SE**2) + J @ J.T


def _strengths(candidate):
    """Return strengths in ordinary ones, and their prior."""
    phi = np.linspace(candidate.low, candidate.high, 801) / candidate.scale
    prior = phi**2 * stats.norm(0.0, 2.0).pdf(phi)
    return phi, prior / prior.sum()


def _exact(column, candidate, bench=None):
    """Return the log evidence with one candidate by integration over its strength."""
    phi, prior = _strengths(candidate)
    away = (Y - J @ MEAN) - phi[:, None] * G[:, column]
    seen = stats.multivariate_normal(np.zeros(len(Y)), _marginal()).pdf(away)
    scaled = candidate.scale
    measured = stats.norm(phi, bench.se / scaled).pdf(bench.value / scaled) if bench else 1.0
    return np.log(np.sum(prior * seen * measured))


def test_evidence_without_a_cause_is_the_normal_density():
    exact = stats.multivariate_normal(J @ MEAN, _marginal()).logpdf(Y)
    assert _weighed().base.log_evidence == pytest.approx(exact, abs=CLOSE)


def test_evidence_with_a_cause_is_the_integral_over_its_strength():
    found = _weighed().weighed
    for column, candidate in enumerate((ONE, HALF)):
        exact = _exact(column, candidate)
        assert found[candidate.name,].log_evidence == pytest.approx(exact, abs=CLOSE)


def test_evidence_with_two_causes_is_the_integral_over_both():
    # Another study, in which one cause alone is not enough.
    g = np.array([[0.8, 0.0], [0.5, 0.0], [-0.4, 0.9], [0.3, -0.8]])
    y = J @ MEAN + g @ [3.0, 3.0]
    one = board(linear(J, g), y, SE, (ONE, HALF), priors=NORMAL, effects=2)
    found = _weighed(one).weighed
    (a, p), (b, q) = _strengths(ONE), _strengths(HALF)
    normal = stats.multivariate_normal(np.zeros(len(Y)), _marginal())
    both = np.multiply.outer(a, g[:, 0])[:, None] + np.multiply.outer(b, g[:, 1])
    exact = np.log(np.sum(np.multiply.outer(p, q) * normal.pdf((y - J @ MEAN) - both)))
    assert found["one", "half"].log_evidence == pytest.approx(exact, abs=CLOSE)


def test_evidence_with_errors_told_by_repeats_is_the_integral_over_them():
    """By brute force: parameters drawn from their prior, Student's t for every reading."""
    found = _weighed(_board(repeats=5))
    rng = np.random.default_rng(2)
    u = MEAN + rng.standard_normal((400_000, 2))
    left = (Y - u @ J.T) / SE
    plain = np.mean(np.exp(np.sum(stats.t(4).logpdf(left) - np.log(SE), axis=1)))
    assert found.base.log_evidence == pytest.approx(np.log(plain), abs=CLOSE)
    phi, prior = _strengths(ONE)
    x = rng.choice(phi, len(u), p=prior)
    left = (Y - u @ J.T - x[:, None] * G[:, 0]) / SE
    with_one = np.mean(np.exp(np.sum(stats.t(4).logpdf(left) - np.log(SE), axis=1)))
    assert found.weighed["one",].log_evidence == pytest.approx(np.log(with_one), abs=CLOSE)


def test_data_that_say_nothing_leave_every_evidence_as_it_is():
    """Then all draws of a cloud count, also for a cause; none of them may be forgotten."""
    vague = 100.0 * SE
    one = board(linear(J, G), Y, vague, (ONE,), priors=NORMAL, effects=2)
    found = _weighed(one)
    ratio = found.weighed["one",].log_evidence - found.base.log_evidence
    phi, prior = _strengths(ONE)
    normal = stats.multivariate_normal(np.zeros(len(Y)), np.diag(vague**2) + J @ J.T)
    left = Y - J @ MEAN
    exact = np.log(np.sum(prior * normal.pdf(left - phi[:, None] * G[:, 0]))) - normal.logpdf(left)
    # All draws alike: the evidences share their luck but for that of the strengths.
    assert ratio == pytest.approx(exact, abs=0.02)


def test_an_effect_that_was_measured_counts_for_and_against_it():
    bench = Measured(1.5, 0.1)
    found = _weighed(_board(measured={"one": bench}))
    exact = _exact(0, ONE, bench)
    assert found.weighed["one",].log_evidence == pytest.approx(exact, abs=CLOSE)
    zero = stats.norm(0.0, 0.1).logpdf(1.5)
    plain = _weighed().base.log_evidence
    assert found.base.log_evidence == pytest.approx(plain + zero, abs=CLOSE)


def test_order_names_and_other_candidates_change_no_evidence_ratio():
    """An irrelevant candidate, another order, another name, another unit: all less than 0.1."""

    def ratio(candidates, name):
        found = _weighed(_board(candidates), seed=4)
        return found.weighed[name,].log_evidence - found.base.log_evidence

    alone = ratio((ONE,), "one")
    idle = Candidate("idle", "idle", 1.0, -LIMIT, LIMIT, ())
    assert ratio((ONE, HALF, idle), "one") == pytest.approx(alone, abs=0.1)
    assert ratio((HALF, ONE), "one") == pytest.approx(alone, abs=0.1)
    renamed = replace(ONE, name="zebra")
    assert ratio((renamed, HALF), "zebra") == pytest.approx(alone, abs=0.1)


def test_absorbed_share_limit_and_bias_are_those_of_the_linear_problem():
    one = _board()
    found = _weighed(one)
    tangent, _ = heaviest_tangent(found, ())
    seen = visibility(one, tangent, straight_at(one, tangent), Levels(), 1)
    inverse = np.linalg.inv(_marginal())
    for k, candidate in enumerate((ONE, HALF)):
        g = G[:, k] / candidate.scale
        information = g @ inverse @ g
        row = seen.of(candidate.name)
        assert row.absorbed == pytest.approx(1 - information / np.sum((g / SE) ** 2), abs=1e-3)
        assert row.detectable == pytest.approx(2.8 / np.sqrt(information), rel=1e-3)
        bias = J.T @ inverse @ g
        assert [row.bias["p0"], row.bias["p1"]] == pytest.approx(list(bias), abs=1e-3)


def test_a_cause_that_the_parameters_imitate_exactly_is_invisible():
    imitated = np.column_stack([J @ [1.0, 2.0], G[:, 1]])
    one = board(linear(1e3 * J, imitated), Y, SE, (ONE,), priors=NORMAL, effects=2)
    tangent, _ = heaviest_tangent(_weighed(one), ())
    row = visibility(one, tangent, straight_at(one, tangent), Levels(), 1).of("one")
    assert row.absorbed > 0.9999
    assert not row.visible
    assert row.achieved == np.inf


def test_imagined_studies_are_those_of_the_model():
    one = _board()
    tangent, _ = heaviest_tangent(_weighed(one), ())
    straight = straight_at(one, tangent)
    studies = straight.imagine(20_000, np.random.default_rng(1)) * SE
    # In units of the errors, scaled back; two per cent is five standard errors of a variance.
    assert np.cov(studies, rowvar=False) == pytest.approx(_marginal(), abs=0.05)
    ratios = straight.log_ratios(studies[:50] / SE)
    normal = stats.multivariate_normal(np.zeros(len(Y)), _marginal())
    phi, prior = _strengths(ONE)
    for y, told in zip(studies[:50], ratios[:, 0], strict=True):
        exact = np.log(np.sum(prior * normal.pdf(y - phi[:, None] * G[:, 0]))) - normal.logpdf(y)
        assert told == pytest.approx(exact, abs=0.05)


def test_a_log_ratio_sways_as_emulators_from_other_runs_make_it():
    """Emulators from other runs are simulated: other slopes' offsets with the stated variance."""
    variance = 0.05
    one = board(linear(J, G, variance), Y, SE, (ONE,), priors=NORMAL, effects=2)
    told = sways(_weighed(one), [("one",)], seed=1)["one",]
    rng = np.random.default_rng(3)
    phi, prior = _strengths(ONE)
    normal = stats.multivariate_normal(np.zeros(len(Y)), _marginal() + variance * np.eye(len(Y)))
    ratios = []
    for _ in range(400):
        away = Y - J @ MEAN - np.sqrt(variance) * rng.standard_normal(len(Y))
        seen = normal.pdf(away - phi[:, None] * G[:, 0])
        ratios.append(np.log(np.sum(prior * seen)) - normal.logpdf(away))
    assert told == pytest.approx(np.std(ratios), rel=0.2)


def test_what_lasts_is_the_mean_over_emulators_from_other_runs():
    variance = 0.05
    both = board(linear(J, G, variance), Y, SE, (ONE, HALF), priors=NORMAL, effects=2)
    told = lasting(_weighed(both), {("one",): 0.6, ("half",): 0.4}, seed=1)
    rng = np.random.default_rng(3)
    normal = stats.multivariate_normal(np.zeros(len(Y)), _marginal() + variance * np.eye(len(Y)))
    strengths = {"one": (0, *_strengths(ONE)), "half": (1, *_strengths(HALF))}

    def evidence(name, away):
        column, phi, prior = strengths[name]
        return np.sum(prior * normal.pdf(away - phi[:, None] * G[:, column]))

    here = Y - J @ MEAN
    shares = []
    for _ in range(400):
        away = here - np.sqrt(variance) * rng.standard_normal(len(Y))
        one, half = (evidence(name, away) / evidence(name, here) for name in ("one", "half"))
        shares.append(0.6 * one / (0.6 * one + 0.4 * half))
    # The mean of 200 imagined emulators scatters by a fourteenth of the scatter of one at most,
    # that of 400 here by a twentieth.
    assert told["one",] == pytest.approx(np.mean(shares), abs=0.3 * np.std(shares))
    assert sum(told.values()) == pytest.approx(1.0)
    # Mirrored pairs: less than half the scatter that as many of their own would have.
    weighed, given = _weighed(both), {("one",): 0.6, ("half",): 0.4}
    seeds = [lasting(weighed, given, seed=seed)["one",] for seed in range(8)]
    assert np.std(seeds) < 0.5 * np.std(shares) / np.sqrt(OTHERS)


def test_readings_left_out_together_are_predicted_by_the_others_alone():
    found = _weighed()
    first, last = groups_left_out(found, {("wall", "a"): [0], ("wall", "b"): [2, 3]})
    assert (first.kind, first.name, last.name) == ("wall", "a", "b")
    for group, out in ((first, [0]), (last, [2, 3])):
        kept = [k for k in range(len(Y)) if k not in out]
        known = np.linalg.inv(_marginal()[np.ix_(kept, kept)])
        turned = _marginal()[np.ix_(out, kept)] @ known
        left = Y - J @ MEAN
        away = left[out] - turned @ left[kept]
        own = np.diag(_marginal()[np.ix_(out, out)] - turned @ _marginal()[np.ix_(kept, out)])
        assert group.z == pytest.approx(np.sqrt(np.mean(away**2 / own)), rel=0.1)


class Doubtful:
    """A linear emulator that knows the answer to the first cause to its own size only."""

    def predict(self, inputs):
        """Return what is expected; its variance grows with the strength."""
        mean = inputs.u @ J.T + inputs.strengths @ G.T
        variance = np.zeros_like(mean) + (3.0 * inputs.strengths[:, [0]]) ** 2
        return Prediction(mean, variance, np.zeros((*mean.shape, 0)))


def test_data_far_from_every_model_are_weighed_as_well():
    """A doubtful answer gains more there than any answer that is known could."""
    far = board(Doubtful(), 100.0 * Y, SE, (ONE, HALF), priors=NORMAL, effects=2)
    found = weigh_all(far, np.random.default_rng(1), effort=Effort(50.0))
    assert np.isfinite([one.log_evidence for one in found.weighed.values()]).all()
    assert found.weighed["one",].log_evidence > found.base.log_evidence + 100.0
