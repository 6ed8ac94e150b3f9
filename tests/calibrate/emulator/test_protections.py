"""What an emulator is protected from: wrong inputs, few runs, constants, outliers, copies."""

from __future__ import annotations

import numpy as np
import pytest

from calibrate.emulator.covariance import Hyper
from calibrate.emulator.emulator import train_emulator
from calibrate.emulator.types import Inputs, Output
from calibrate.errors import CalibrationError
from tests.calibrate.emulator.synthetic import ONE, draw, runs_at, spread_points


def smooth(u: np.ndarray) -> np.ndarray:
    return np.asarray(np.sin(3 * u[:, 0]) + u[:, 1])


@pytest.mark.parametrize("value", [1.1, -0.01, np.nan])
def test_inputs_outside_the_range_are_refused(rng, value):
    inputs = runs_at(spread_points(20, 2, rng))
    emulator = train_emulator(inputs, ONE, smooth(inputs.u)[:, None])
    u = rng.random((5, 2))
    u[3, 1] = value
    for refusing in (
        lambda: emulator.predict(Inputs.at(u)),
        lambda: train_emulator(runs_at(u), ONE, smooth(u)[:, None]),
    ):
        with pytest.raises(CalibrationError, match=r"input 1 of row 3 is .* range 0 to 1"):
            refusing()
    u[3, 1] = 1.0 + 1e-12  # rounding is none
    emulator.predict(Inputs.at(u))


def test_shapes_are_checked(rng):
    inputs = runs_at(spread_points(20, 2, rng))
    y = smooth(inputs.u)[:, None]
    emulator = train_emulator(inputs, ONE, y)
    with pytest.raises(CalibrationError, match=r"u has shape \(4, 3\); give \(4, 2\)"):
        emulator.predict(Inputs.at(rng.random((4, 3))))
    with pytest.raises(CalibrationError, match="strengths has shape"):
        emulator.predict(Inputs.at(rng.random((4, 2)), effects=1))
    with pytest.raises(CalibrationError, match="y has shape"):
        emulator.updated(inputs, y[:3])
    with pytest.raises(CalibrationError, match="each of the 1 columns"):
        train_emulator(inputs, [*ONE, Output("twice", slice(0, 1))], y)
    y[7] = np.inf
    with pytest.raises(CalibrationError, match="infinite in row 7"):
        train_emulator(inputs, ONE, y)


def test_too_few_runs_say_how_many_are_needed(rng):
    inputs = runs_at(spread_points(12, 6, rng))
    y = inputs.u[:, :1].copy()
    y[8:] = np.nan
    with pytest.raises(
        CalibrationError, match=r"'y': 8 of 12 runs .* 8 different points; .* at least 9 .* 60"
    ):
        train_emulator(inputs, ONE, y)
    repeated = Inputs(np.repeat(inputs.u[:4], 3, axis=0), np.zeros((12, 0)), np.arange(12.0))
    with pytest.raises(CalibrationError, match="at 4 different points"):
        train_emulator(repeated, ONE, inputs.u[:, :1])


def test_an_output_that_never_changes(rng):
    inputs = runs_at(spread_points(20, 2, rng))
    emulator = train_emulator(inputs, ONE, np.full((20, 1), 0.3))
    found = emulator.predict(Inputs.at(rng.random((5, 2))))
    np.testing.assert_allclose(found.mean, 0.3)
    np.testing.assert_array_equal(found.total, 0.0)
    row = emulator.quality.iloc[0]
    assert np.isnan(row["Q2"])
    assert row["z_rms"] == 0.0
    changed = emulator.updated(runs_at(inputs.u[:2] * 0.5), np.full((2, 1), 0.3))
    assert changed.predict(Inputs.at(inputs.u)).mean[0, 0] == pytest.approx(0.3)


def test_a_level_of_a_curve_that_never_changes(rng):
    inputs = runs_at(spread_points(30, 2, rng))
    y = np.column_stack([smooth(inputs.u), np.zeros(30), 2.0 * inputs.u[:, 0]])
    emulator = train_emulator(inputs, [Output("curve", slice(0, 3))], y)
    found = emulator.predict(Inputs.at(rng.random((5, 2))))
    np.testing.assert_allclose(found.mean[:, 1], 0.0, atol=1e-12)


def test_outliers_are_not_believed(rng):
    inputs = runs_at(spread_points(100, 2, rng))
    y = smooth(inputs.u) + 0.02 * rng.standard_normal(100)
    clean = train_emulator(inputs, ONE, y[:, None])
    y[[17, 60]] += [2.0, -3.0]
    emulator = train_emulator(inputs, ONE, y[:, None])
    assert list(np.flatnonzero(~emulator.parts[0].processes[0].runs.believed)) == [17, 60]
    assert emulator.quality["outliers"][0] == 2
    at = Inputs.at(rng.random((200, 2)))
    away = emulator.predict(at).mean[:, 0] - smooth(at.u)
    best = clean.predict(at).mean[:, 0] - smooth(at.u)
    assert np.std(away) < 1.5 * np.std(best)
    assert clean.quality["outliers"][0] == 0


def test_many_outliers_are_the_rule(rng):
    inputs = runs_at(spread_points(100, 2, rng))
    y = smooth(inputs.u) + 0.02 * rng.standard_normal(100)
    y[::10] += rng.choice([-3.0, 3.0], 10)
    emulator = train_emulator(inputs, ONE, y[:, None])
    assert emulator.quality["outliers"][0] == 0
    assert np.sqrt(emulator.noise[0]) == pytest.approx(3.0 * np.sqrt(0.1), rel=0.3)


def test_copies_of_a_run_are_one_run(rng):
    inputs = runs_at(spread_points(40, 2, rng))
    y = (smooth(inputs.u) + 0.1 * rng.standard_normal(40))[:, None]
    once = train_emulator(inputs, ONE, y)
    twice = train_emulator(inputs.joined(inputs), ONE, np.vstack([y, y]))
    at = Inputs.at(rng.random((9, 2)))
    np.testing.assert_array_equal(once.predict(at).total, twice.predict(at).total)
    again = once.updated(inputs, y)
    np.testing.assert_array_equal(once.predict(at).total, again.predict(at).total)


def test_repeats_at_a_point_are_noise_and_no_fault(rng):
    inputs = runs_at(np.repeat(spread_points(20, 2, rng), 3, axis=0))
    y = smooth(inputs.u) + 0.1 * rng.standard_normal(60)
    emulator = train_emulator(inputs, ONE, y[:, None])
    assert np.sqrt(emulator.noise[0]) == pytest.approx(0.1, rel=0.4)


def test_variance_is_honest_far_from_the_runs(rng):
    # Runs in one corner only: in the others, the emulator must know that it knows little.
    hyper = Hyper(np.array([0.4, 0.4]), 1.0, np.zeros(0), 0.0, 1e-4)
    far = np.array([[1.0, 1.0], [0.1, 0.9], [0.9, 0.2]])
    z = []
    for _ in range(8):
        every = Inputs.at(np.vstack([0.4 * spread_points(60, 2, rng), far]))
        truth = draw(hyper, every, rng)
        y = truth[:60] + 0.01 * rng.standard_normal(60)
        emulator = train_emulator(every.rows(slice(0, 60)), ONE, y[:, None])
        near, away = emulator.predict(Inputs.at([[0.2, 0.2]])), emulator.predict(Inputs.at(far))
        assert away.total.min() > 50.0 * near.total[0, 0]
        z.append((away.mean[:, 0] - truth[60:]) / np.sqrt(away.total[:, 0]))
    assert 0.5 < np.sqrt(np.mean(np.square(z))) < 1.6


def test_an_effect_that_is_new_asks_for_training(rng):
    inputs = runs_at(spread_points(20, 2, rng), effects=1)
    emulator = train_emulator(inputs, ONE, smooth(inputs.u)[:, None])
    new = Inputs(inputs.u[:1], np.ones((1, 1)), np.array([99.0]))
    with pytest.raises(CalibrationError, match="no earlier run had effect 0 on"):
        emulator.updated(new, np.ones((1, 1)))
