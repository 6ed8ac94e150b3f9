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
    slope, bend, _ = wide.parts(0, u)
    assert slope * x[:, None] + bend * x[:, None] ** 2 == pytest.approx(on.mean - off.mean)


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


@pytest.mark.parametrize(("shared", "worst"), [(0.0, 0.8), (0.3, 0.85), (1.0, 0.05)])
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
