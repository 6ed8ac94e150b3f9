"""What effects add to an emulator: learnt from twins, each by itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibrate.emulator.emulator import train_emulator
from calibrate.emulator.signature import Twins, learn_signature
from calibrate.emulator.types import Inputs, Output
from calibrate.emulator.with_effects import WithEffects, learn_change

OUTPUTS = [Output("angle", slice(0, 1)), Output("curve", slice(1, 6))]
LEVELS = np.linspace(0.2, 1.0, 5)
NOISE = 0.1


def _base(u):
    angle = 30.0 + 6.0 * u[:, [0]] + 3.0 * np.sin(2.0 * u[:, [1]])
    return np.column_stack([angle, (1.0 + u[:, [1]]) * LEVELS])


def _change(u, x):
    """Return what an effect adds: straight in its strength, and a bend."""
    slope = (0.4 + 0.5 * u[:, 0]) * x
    return np.column_stack([slope + 0.03 * x**2, 0.05 * x[:, None] * LEVELS**2])


def _trained(rng, count=80):
    u = rng.random((count, 2))
    y = _base(u) + NOISE * rng.standard_normal((count, 6)) * [1.0, 0, 0, 0, 0, 0]
    return train_emulator(Inputs.at(u), OUTPUTS, y)


def _twins(rng, count=24):
    u = rng.random((count, 2))
    x = np.resize([5.0, -5.0, 2.5, -2.5], count)
    noise = 0.5 * NOISE * rng.standard_normal((count, 6)) * [1.0, 0, 0, 0, 0, 0]
    change = _change(u, x) + noise
    return Twins(u, x, change, np.zeros_like(change))


def test_an_effect_is_learnt_with_its_error():
    rng = np.random.default_rng(1)
    base = _trained(rng)
    wide = WithEffects(base, {0: learn_change(base, _twins(rng))}, 1)
    u, x = rng.random((200, 2)), rng.uniform(-5.0, 5.0, 200)
    on = wide.predict(Inputs.at(u, x[:, None]))
    off = wide.predict(Inputs.at(u, np.zeros((200, 1))))
    away = on.mean - off.mean - _change(u, x)
    # A twentieth of what an ordinary strength does.
    assert np.sqrt(np.mean(away[:, 0] ** 2)) < 0.1
    assert np.sqrt(np.mean(away[:, 1:] ** 2)) < 0.01
    spread = on.total[:, 0] - off.total[:, 0]
    z = away[:, 0] / np.sqrt(spread)
    assert 0.2 < np.sqrt(np.mean(z**2)) < 1.5


def test_a_parabola_is_what_is_expected_at_two_strengths():
    rng = np.random.default_rng(1)
    base = _trained(rng)
    wide = WithEffects(base, {0: learn_change(base, _twins(rng))}, 1)
    u = rng.random((20, 2))
    off = wide.predict(Inputs.at(u, np.zeros((20, 1)))).mean
    for at in (None, (3.0, 4.0), (-1.0, -3.0)):
        slope, bend, doubt = wide.parts(0, u, at)
        for x in at or (-2.0, 2.0):
            on = wide.predict(Inputs.at(u, np.full((20, 1), x)))
            assert x * (slope + x * bend) == pytest.approx(on.mean - off)
        assert (doubt**2).sum(axis=2).max() > 0.0


def test_strength_zero_is_the_base_model_and_adds_no_error():
    rng = np.random.default_rng(2)
    base = _trained(rng)
    wide = WithEffects(base, {0: learn_change(base, _twins(rng))}, 2)
    u = rng.random((20, 2))
    off, plain = wide.predict(Inputs.at(u, np.zeros((20, 2)))), base.predict(Inputs.at(u))
    assert off.mean == pytest.approx(plain.mean, abs=1e-12)
    assert off.total == pytest.approx(plain.total)


def test_one_more_effect_changes_nothing_of_another():
    rng = np.random.default_rng(3)
    base, twins, others = _trained(rng), _twins(rng), _twins(rng)
    u, x = rng.random((20, 2)), np.full((20, 2), [3.0, 0.0])
    alone = WithEffects(base, {0: learn_change(base, twins)}, 2).predict(Inputs.at(u, x))
    changes = {0: learn_change(base, twins), 1: learn_change(base, others)}
    both = WithEffects(base, changes, 2).predict(Inputs.at(u, x))
    assert np.array_equal(alone.mean, both.mean)
    assert np.array_equal(alone.factors, both.factors)


def test_what_never_changes_is_known_to():
    rng = np.random.default_rng(4)
    base, twins = _trained(rng), _twins(rng)
    none = Twins(twins.u, twins.strength, twins.luck, twins.luck)
    wide = WithEffects(base, {0: learn_change(base, none)}, 1)
    u = rng.random((5, 2))
    on, off = (wide.predict(Inputs.at(u, np.full((5, 1), x))) for x in (4.0, 0.0))
    assert np.array_equal(on.mean, off.mean)
    assert np.array_equal(on.variance, off.variance)


def test_a_run_that_failed_is_left_out():
    rng = np.random.default_rng(5)
    base, twins = _trained(rng), _twins(rng)
    change = twins.change.copy()
    change[3] = np.nan
    learnt = learn_change(base, Twins(twins.u, twins.strength, change, twins.luck))
    assert len(learnt.signatures[0][0].twins) == len(twins) - 1


@pytest.mark.parametrize(("shared", "worst"), [(0.0, 0.8), (0.3, 0.95), (1.0, 0.05)])
def test_luck_counts_as_far_as_twins_share_it(shared, worst):
    """Beside plain differences of twins, which have the luck of two runs, or of none."""
    rng, luck_size = np.random.default_rng(4), 1.0
    lengths, own, plain = np.array([1.0, 1.0]), [], []
    for _ in range(20):
        u, x = rng.random((24, 2)), np.resize([5.0, -5.0, 2.5, -2.5], 24)
        luck = luck_size * rng.standard_normal(24)
        rest = luck_size * np.sqrt(1.0 - shared**2) * rng.standard_normal(24)
        true = (0.4 + 0.5 * u[:, 0]) * x
        change = true + shared * luck + rest
        at = rng.random((50, 2))
        for found, twins in (
            (own, Twins(u, x, change, luck)),
            (plain, Twins(u, x, change - luck, np.zeros(24))),
        ):
            mean, _ = learn_signature(lengths, 2.0, twins).predict(at, np.ones(50))
            found.append(np.mean((mean - (0.4 + 0.5 * at[:, 0])) ** 2))
    # Of the squared error, one run's luck is half of that of two; all shared, none is left, which
    # plain differences know as well.
    reached = np.mean(own) / (np.mean(plain) if shared < 1.0 else np.mean(0.4**2))
    assert reached < worst


def test_levels_of_an_answer_go_wrong_together_as_those_of_a_run_do():
    """In units of what a run scatters, where levels that differ weigh most."""
    luck = 0.3 * LEVELS  # of a whole curve; single levels scatter by a tenth of that
    covariance = np.outer(luck, luck) + np.diag((0.1 * luck) ** 2)
    white, scatter = np.linalg.inv(np.linalg.cholesky(covariance)), np.linalg.cholesky(covariance)
    found, said = [], []
    for seed in range(6):
        rng = np.random.default_rng([6, seed])
        u = rng.random((120, 2))
        y = np.column_stack(
            [_base(u)[:, 0], _base(u)[:, 1:] + rng.normal(size=(120, 5)) @ scatter.T]
        )
        base, twins = train_emulator(Inputs.at(u), OUTPUTS, y), _twins(rng)
        change = twins.change.copy()
        change[:, 1:] += rng.normal(size=(24, 5)) @ scatter.T
        wide = WithEffects(base, {0: learn_change(base, replace(twins, change=change))}, 1)
        at = rng.random((40, 2))
        slope, _, doubt = wide.parts(0, at)
        found.append(np.mean(((slope[:, 1:] - 0.05 * LEVELS**2) @ white.T) ** 2))
        said.append(np.mean(np.sum((white @ doubt[:, 1:]) ** 2, axis=2)))
    # The error is that of a few numbers told by 24 twins of two to five strengths; said is between
    # half and five times of it (a factor of its own covers what few twins tell). Level by level it
    # would be more than sixty times of it.
    assert 0.5 < np.mean(said) / np.mean(found) < 5.0


def test_an_answer_that_is_steepest_at_first_is_told_at_small_strengths():
    """A plate that slips: the answer to a tenth of the strength is a third of the whole."""

    def answer(x):
        return 2.0 * np.sqrt(x)

    rng = np.random.default_rng(8)
    x = np.resize([5.0, 2.5, 1.25, 0.6], 64)
    u = rng.random((64, 2))
    change = answer(x) + 0.1 * rng.standard_normal(64)
    found = learn_signature(np.ones(2), 2.0, Twins(u, x, change, np.zeros(64)))
    at, asked = np.full((6, 2), 0.5), np.array([0.6, 0.9, 1.5, 2.0, 3.5, 5.0])
    mean, variance = found.predict(at, asked)
    away = (mean - answer(asked)) / np.sqrt(variance)
    assert np.abs(away).max() < 2.5
    # A parabola alone misses the root by 0.2 to 0.3 here, where it was run and between.
    run = np.isin(asked, [0.6, 5.0])
    assert mean[run] == pytest.approx(answer(asked[run]), abs=0.1)
    assert mean == pytest.approx(answer(asked), abs=0.25)
    # The grids of strengths use a parabola that meets it at two strengths, a tenth apart or so.
    slope, bend, _ = found.parts(at)
    between = (asked > 0.8) & (asked < 2.6)
    near = slope * asked + bend * asked**2
    assert near[between] == pytest.approx(mean[between], rel=0.15)


def test_an_answer_that_begins_late_is_told_where_it_begins():
    """Glued grains hold until friction gives way, sooner or later with the parameters."""

    def answer(u, x):
        return 2.0 * np.maximum(x - 0.5 - 2.0 * u[:, 0], 0.0)

    rng = np.random.default_rng(11)
    u, x = rng.random((120, 2)), np.resize([5.0, 2.5, 1.25, 0.6], 120)
    change = answer(u, x) + 0.1 * rng.standard_normal(120)
    found = learn_signature(np.ones(2), 2.0, Twins(u, x, change, np.zeros(120)))
    at, asked = rng.random((200, 2)), np.resize([0.6, 1.25, 2.0, 2.5, 4.0, 5.0], 200)
    mean, variance = found.predict(at, asked)
    away = mean - answer(at, asked)
    # The best parabola with one bend for all parameters misses it by 0.4.
    assert np.sqrt(np.mean(away**2)) < 0.25
    assert 0.5 < np.sqrt(np.mean(away**2 / variance)) < 1.5


@pytest.mark.parametrize(("own", "growing"), [(0.0, 0.3), (0.3, 0.0)])
def test_repeats_tell_luck_from_what_an_answer_has_of_its_own(own, growing):
    rng = np.random.default_rng(9)
    x, u = np.repeat(np.resize([5.0, 2.5, 1.25], 80), 2), np.repeat(rng.random((80, 2)), 2, axis=0)
    change = (0.5 + np.repeat(own * rng.standard_normal(80), 2)) * x
    change += np.hypot(0.2, growing * x) * rng.standard_normal(160)
    found = learn_signature(np.ones(2), 1.0, Twins(u, x, change, np.zeros(160)))
    _, variance = found.predict(np.full((1, 2), 0.5), np.array([5.0]))
    # A variance that 80 points tell is known to 16 %, and what is learnt from few is inflated;
    # where there is none, a tenth of the other may be taken for it.
    one = (0.3 * 5.0) ** 2
    assert variance[0] == pytest.approx(one if own else 0.0, abs=0.35 * one)


@pytest.mark.parametrize("shared", [0.0, 1.0])
def test_runs_without_a_twin_tell_more_and_never_less(shared):
    """Also where twins share all of their luck, which a run alone has as noise."""
    rng = np.random.default_rng(10)
    said, away = [], []
    for _ in range(10):
        u, x, half = rng.random((48, 2)), np.resize([5.0, -5.0, 2.5, -2.5], 48), np.arange(48) < 24
        luck, own = rng.standard_normal((2, 48))
        rest = np.sqrt(1.0 - shared**2) * own + 0.05 * rng.standard_normal(48)
        change = 0.5 * x + shared * luck + rest
        known = np.where(half, luck, 0.0)
        each = []
        for rows in (half, half | True):
            twins = Twins(u[rows], x[rows], change[rows], known[rows])
            mean, variance = learn_signature(np.ones(2), 2.0, twins).predict(u[:8], np.ones(8))
            each.append([np.mean((mean - 0.5) ** 2), np.mean(variance)])
        away.append([each[0][0], each[1][0]])
        said.append([each[0][1], each[1][1]])
    # Ten draws tell a mean to a third.
    assert np.mean(away, axis=0)[1] < 1.3 * np.mean(away, axis=0)[0]
    assert np.mean(said, axis=0)[1] < 1.1 * np.mean(said, axis=0)[0]
