"""Where hypotheses lie: modes are the highest points, also where straight steps lead elsewhere."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from calibrate.causes.candidates import Candidate
from calibrate.causes.weighing.by_modes import ByModes
from calibrate.causes.weighing.cloud import cloud_of, mixture_of
from calibrate.causes.weighing.evidences import Effort
from calibrate.causes.weighing.modes import mode_near
from calibrate.causes.weighing.tangent import tangent_at
from calibrate.emulator.types import Inputs, Prediction
from calibrate.inference.priors import Prior
from calibrate.inference.sampler.mixture import Mixture
from tests.calibrate.causes.formula import Formula, board, linear

NORMAL = Prior.normal(0.0, 1.0)
SE = 0.1
REPEATS = 5


class Doubtful:
    """An emulator that expects u and is the less certain the larger k u is."""

    def __init__(self, k: float) -> None:
        self.k = k

    def predict(self, inputs: Inputs) -> Prediction:
        """Return u, with a standard deviation of e^(k u)."""
        mean = inputs.u[:, :1]
        return Prediction(mean, np.exp(2.0 * self.k * mean), np.zeros((*mean.shape, 0)))


# Straight steps go beyond the first mode, and see nothing of the second from zero.
@pytest.mark.parametrize(("k", "y", "start"), [(1.0, 2.0, -1.0), (1.0, 2.0, 1.5), (-1.0, 0.0, 0.0)])
def test_the_mode_is_found_where_the_variance_changes_on_the_way(k, y, start):
    def height(u):
        return stats.norm.logpdf(y, u, np.hypot(np.exp(k * u), SE)) + stats.norm.logpdf(u)

    one = board(Doubtful(k), np.array([y]), np.array([SE]), (), priors=(NORMAL,), effects=0)
    highest = height(np.linspace(-4.0, 4.0, 80_001)).max()
    found = mode_near(one.problem, np.array([start]), rounds=60)
    # A search ends where a step gains less than 0.02 nats.
    assert height(found.z[0]) == pytest.approx(highest, abs=0.03)
    assert height(start) < highest - 0.1


def _density(away):
    """Return the density of a number so far from what is expected, its error told by repeats."""
    shares = (np.arange(2000) + 0.5) / 2000.0
    factor = (REPEATS - 1) / stats.chi2(REPEATS - 1).ppf(shares)
    steps = np.linspace(0.0, 13.0, 651)
    exact = stats.norm.pdf(steps[:, None], 0.0, SE * np.sqrt(1.0 + factor)).mean(axis=1)
    return np.exp(np.interp(np.abs(away), steps, np.log(exact)))


# Emulator and measurement are equally uncertain, the second as five repeats told. Far from the data
# the grids of strengths are 31 nats off, which once made causes of nothing; the rest is Laplace's.
@pytest.mark.parametrize(("far", "off"), [(0.0, 1.0), (3.0, 1.5)])
def test_an_error_that_repeats_told_has_its_tail_with_a_cause_on_as_well(far, off):
    def expected(u, s):
        return np.column_stack([u[:, 0] + s[:, 0], u[:, 0] + s[:, 0], u[:, 0]])

    cause = Candidate("one", "one", 1.0, -6.0, 6.0, ((0, 0),))
    y = np.array([far, far, 0.0])
    one = board(
        Formula(expected, SE**2), y, np.full(3, SE), (cause,),
        priors=(NORMAL,), effects=1, repeats=REPEATS,
    )  # fmt: skip
    prior = one.strength_prior(cause)
    u, x = np.linspace(-4.0, 4.0, 401), np.linspace(-6.0, 6.0, 601)
    by_u = stats.norm.pdf(u) * (u[1] - u[0]) * _density(u)
    on = _density(far - u[:, None] - x) ** 2 * np.exp(prior.log_density(x)) * (x[1] - x[0])

    starts = (mode_near(one.problem, np.array([z])) for z in (0.0, far))
    base = max(starts, key=lambda mode: mode.log_evidence)
    found = mode_near(one.problem, np.array([0.0]), (cause,), (prior,))
    assert base.log_evidence == pytest.approx(np.log(by_u @ _density(far - u) ** 2), abs=off)
    assert found.log_evidence == pytest.approx(np.log(by_u @ on.sum(axis=1)), abs=off)


def test_beside_a_cause_errors_are_as_large_as_what_it_leaves():
    """What a cause explains stretches nothing: as if it had been taken off the data before."""
    cause = Candidate("one", "one", 1.0, -6.0, 6.0, ((0, 0),))

    def tangent(y):
        seen = linear(np.array([[1.0], [0.5]]), np.array([[1.0], [0.0]]), SE**2)
        one = board(seen, y, np.full(2, SE), (cause,), priors=(NORMAL,), effects=1, repeats=REPEATS)
        return tangent_at(one.problem, np.zeros(1))

    far, near = tangent(np.array([2.0, 0.3])), tangent(np.array([0.1, 0.3]))
    found = far.stretched(1.9 * far.added(cause)[0])
    assert found.slopes == pytest.approx(near.slopes, rel=1e-6)
    assert found.left - 1.9 * found.added(cause)[0] == pytest.approx(near.left, rel=1e-6)
    assert far.slopes[0] < 0.5 * near.slopes[0]


def _two_sided():
    """Return a board whose base model has modes near -1 and 1, the second 4 nats higher."""
    seen = Formula(lambda u, s: np.column_stack([u[:, 0] ** 2, u[:, 0]]) + s @ np.zeros((2, 2)))
    causes = tuple(
        Candidate(name, name, 1.0, -6.0, 6.0, ((0, k),)) for k, name in enumerate(("one", "other"))
    )
    y, se = np.array([1.0, 0.5]), np.array([0.05, 0.5])
    return board(seen, y, se, causes, priors=(NORMAL,), effects=2)


def test_all_is_looked_at_again_where_a_cause_led_to_a_higher_base_model():
    one = _two_sided()
    work = ByModes(one, np.random.default_rng(1), Effort())
    low, high = (mode_near(one.problem, np.array([side])) for side in (-1.0, 1.0))
    assert high.log_evidence > low.log_evidence + 3.0
    # As if the search of the base model had missed the higher one, and a cause found it.
    work.kept = [(), ("one",), ("other",)]
    work.bases, work.modes = [low], {(): low, ("one",): high}
    work.refine()
    assert {n: float(np.sign(m.z[0])) for n, m in work.modes.items()} == dict.fromkeys(work.kept, 1)
    assert work.heights[()] == pytest.approx(high.log_evidence, abs=0.1)


def test_a_cloud_that_grew_is_weighed_against_all_it_was_drawn_from(rng):
    one = _two_sided()
    parts = [mixture_of([[m]], [[[s]]], [1.0]) for m, s in ((1.0, 0.04), (-1.0, 0.09))]
    cloud = cloud_of(one.problem, Mixture.prior(1), 50, rng)
    for part, count in zip(parts, (30, 20), strict=True):
        cloud = cloud.grown(part, count, rng)
    density = 0.5 * stats.norm.pdf(cloud.z[:, 0])
    for (middle, width), share in zip(((1.0, 0.2), (-1.0, 0.3)), (0.3, 0.2), strict=True):
        density += share * stats.t(6.0, middle, width).pdf(cloud.z[:, 0])
    # The prior is drawn as a t distribution with a million degrees of freedom.
    assert cloud.log_drawn == pytest.approx(np.log(density), abs=1e-4)
