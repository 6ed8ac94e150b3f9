"""Laws of one emulated number: what is known exactly is found, and units do not matter."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import approx_fprime

from calibrate.emulator import search
from calibrate.emulator.covariance import Hyper
from calibrate.emulator.emulator import TrainedEmulator, train_emulator
from calibrate.emulator.process import Runs, condition
from calibrate.emulator.types import Inputs
from tests.calibrate.emulator.synthetic import ONE, draw, runs_at, spread_points, with_repeats

SMOOTH = Hyper(np.array([0.6, 1.2, 3.0]), 1.0, np.zeros(0), 0.0, 0.01)
EFFECT = Hyper(np.array([0.6, 1.2, 3.0]), 1.0, np.array([0.2]), 0.0, 0.01)


def effect_runs(rng: np.random.Generator) -> tuple[Inputs, np.ndarray]:
    """Return 60 points, 20 of them again with an effect, and y = base + s (2 + u_0)."""
    u = spread_points(60, 3, rng)
    strengths = np.zeros((80, 1))
    strengths[60:, 0] = rng.uniform(0.5, 3.0, 20)
    u = np.vstack([u, u[:20]])
    inputs = Inputs(u, strengths, np.concatenate([np.arange(60.0), np.arange(20.0)]))
    base = np.sin(3 * u[:, 0]) + u[:, 1]
    return inputs, base + strengths[:, 0] * (2.0 + u[:, 0]) + 0.02 * rng.standard_normal(80)


def test_a_plane_without_noise_is_recovered(rng):
    inputs = runs_at(spread_points(40, 4, rng))
    slopes = np.array([3.0, -1.0, 0.0, 1e-3])
    emulator = train_emulator(inputs, ONE, (7.0 + inputs.u @ slopes)[:, None])
    u = rng.random((50, 4))
    found = emulator.predict(Inputs.at(u))
    # The smallest noise that is searched for is 1e-7 of the variance; the mean errs by far less.
    np.testing.assert_allclose(found.mean[:, 0], 7.0 + u @ slopes, atol=1e-5)
    assert np.sqrt(found.total).max() < 3e-3
    assert emulator.quality["Q2"][0] > 1.0 - 1e-8


def test_gradient_of_the_search_is_that_of_its_objective(rng):
    inputs, y = effect_runs(rng)
    design = search.Design(inputs.u, inputs.strengths, inputs.seeds)
    task = search.task_of(design, (y - y.mean()) / y.std())
    at = task.start[task.free] + 0.3 * rng.standard_normal(np.count_nonzero(task.free))
    slopes = search.objective(at, task)[1]
    numeric = approx_fprime(at, lambda x: search.objective(x, task)[0], 1e-6)
    np.testing.assert_allclose(slopes, numeric, rtol=1e-3, atol=1e-3)
    assert len(slopes) == 3 + 1 + 1 + 2  # lengths, surface, bend, offset and noise


def test_last_digits_of_the_outputs_move_no_hyperparameter(rng):
    """Where a search ends differs between processors by 1e-12, now and then by 1e-5."""
    inputs, y = effect_runs(rng)
    design = search.Design(inputs.u, inputs.strengths, inputs.seeds)
    y = (y - y.mean()) / y.std()
    one, other = search.search(design, y), search.search(design, y + 1e-9 * rng.normal(size=80))
    np.testing.assert_array_equal(np.hstack(vars_of(one)), np.hstack(vars_of(other)))


def vars_of(hyper: Hyper) -> tuple[np.ndarray | float, ...]:
    """Return all hyperparameters."""
    return hyper.lengths, hyper.surface, hyper.bends, hyper.offset, hyper.noise


def test_draws_of_a_known_process_are_covered(rng):
    inside, z = [], []
    for _ in range(8):
        every = runs_at(spread_points(160, 3, rng))
        truth = draw(SMOOTH, Inputs(every.u, every.strengths, np.full(160, np.nan)), rng)
        y = truth + np.sqrt(SMOOTH.noise) * rng.standard_normal(160)
        train, test = every.rows(slice(0, 80)), every.rows(slice(80, 160))
        emulator = train_emulator(train, ONE, y[:80, None])
        found = emulator.predict(test)
        away = (found.mean[:, 0] - truth[80:]) / np.sqrt(found.total[:, 0])
        inside.append(np.mean(np.abs(away) < 1.645))
        z.append(np.mean(away**2))
        assert emulator.noise[0] == pytest.approx(SMOOTH.noise, rel=1.0)
    # 640 errors, correlated within a draw: about four standard errors on both sides.
    assert 0.82 < np.mean(inside) < 0.97
    assert 0.7 < np.sqrt(np.mean(z)) < 1.3


def test_offsets_of_seeds_are_recovered(rng):
    # Four seeds at each of 40 points; the luck of a seed is alike everywhere.
    inputs = with_repeats(spread_points(40, 2, rng), 4)
    luck = np.array([0.5, -0.3, 0.2, -0.4])
    u, seeds = inputs.u, inputs.seeds.astype(int)
    y = np.sin(3 * u[:, 0]) + u[:, 1] + luck[seeds] + 0.02 * rng.standard_normal(160)
    process = train_emulator(inputs, ONE, y[:, None]).parts[0].processes[0]
    hyper, scale = process.form.hyper, process.form.scale
    assert scale**2 * hyper.offset == pytest.approx(np.mean(luck**2), rel=0.7)
    assert scale**2 * hyper.noise == pytest.approx(0.02**2, rel=0.5)
    # What a run says of another with its seed: all but the noise of one run.
    found = process.reduction(inputs.rows(slice(0, 1)), Inputs.at(u[:1]))
    assert found.shape == (1, 1)
    expected = process.predict(Inputs.at(u[:1]))[0][0]
    truth = np.sin(3 * u[0, 0]) + u[0, 1] + luck.mean()
    assert expected == pytest.approx(truth, abs=0.1)


def test_common_seeds_make_differences_sharp(rng):
    # With an offset per seed, the influence of an effect is the difference of twins.
    inputs, y = effect_runs(rng)
    luck = 0.3 * rng.standard_normal(60)
    y = y + luck[inputs.seeds.astype(int)]
    emulator = train_emulator(inputs, ONE, y[:, None])
    u = rng.random((50, 3))
    rise = (
        emulator.predict(Inputs.at(u, np.ones((50, 1)))).mean
        - emulator.predict(Inputs.at(u, np.zeros((50, 1)))).mean
    )
    assert np.sqrt(np.mean((rise[:, 0] - 2.0 - u[:, 0]) ** 2)) < 0.1  # a third of the luck


def test_slope_of_an_effect_is_recovered(rng):
    inputs, y = effect_runs(rng)
    emulator = train_emulator(inputs, ONE, y[:, None])
    u = rng.random((50, 3))
    for strength in (-1.0, 0.5, 2.0):
        on = emulator.predict(Inputs.at(u, np.full((50, 1), strength)))
        off = emulator.predict(Inputs.at(u, effects=1))
        rise = on.mean[:, 0] - off.mean[:, 0]
        np.testing.assert_allclose(rise, strength * (2.0 + u[:, 0]), atol=0.12 * abs(strength))


def test_an_effect_without_runs_does_not_act(rng):
    inputs, y = effect_runs(rng)
    none = np.zeros((80, 1))
    wider = Inputs(inputs.u, np.hstack([none, inputs.strengths, none]), inputs.seeds)
    at = Inputs.at(rng.random((9, 3)), rng.normal(size=(9, 3)))
    alone = Inputs(at.u, at.strengths[:, 1:2], at.seeds)
    wide, one = train_emulator(wider, ONE, y[:, None]), train_emulator(inputs, ONE, y[:, None])
    np.testing.assert_array_equal(wide.predict(at).mean, one.predict(alone).mean)
    np.testing.assert_array_equal(wide.predict(at).total, one.predict(alone).total)


def trained(inputs: Inputs, y: np.ndarray) -> TrainedEmulator:
    return train_emulator(inputs, ONE, y[:, None])


# A search ends where the objective is flat to about 1e-9: predictions agree to a thousandth of
# their error, not to the last bit, when rounding sends it another way.
CLOSE = 3e-3


@pytest.mark.parametrize("change", ["units", "order of runs", "order of inputs", "strengths"])
def test_what_does_not_matter_changes_nothing(rng, change):
    inputs, y = effect_runs(rng)
    u, strengths = rng.random((30, 3)), rng.uniform(0.0, 3.0, (30, 1))
    before = trained(inputs, y).predict(Inputs.at(u, strengths))
    factor, shift, at = 1.0, 0.0, Inputs.at(u, strengths)
    if change == "units":
        factor, shift = -1e3, 5.0
        inputs, y = inputs, shift + factor * y
    elif change == "order of runs":
        order = rng.permutation(len(y))
        inputs, y = inputs.rows(order), y[order]
    elif change == "order of inputs":
        inputs = Inputs(inputs.u[:, ::-1], inputs.strengths, inputs.seeds)
        at = Inputs.at(u[:, ::-1], strengths)
    else:
        inputs = Inputs(inputs.u, 1e4 * inputs.strengths, inputs.seeds)
        at = Inputs.at(u, 1e4 * strengths)
    after = trained(inputs, y).predict(at)
    error = np.sqrt(before.total)
    assert np.abs((after.mean - shift) / factor - before.mean).max() < CLOSE * error.max()
    np.testing.assert_allclose(np.sqrt(after.total) / abs(factor), error, rtol=10 * CLOSE)


def test_leaving_out_in_closed_form_is_leaving_out(rng):
    inputs, y = effect_runs(rng)
    process = trained(inputs, y).parts[0].processes[0]
    for point in (0, 5, 59):  # the first two have a twin with the effect on
        out = (inputs.u == inputs.u[point]).all(axis=1)
        assert out.sum() == (2 if point < 20 else 1)
        rest = condition(process.form, Runs(inputs.rows(~out), y[~out], np.ones(sum(~out), bool)))
        mean, variance = rest.predict(inputs.rows(out))
        np.testing.assert_allclose(process.left_out.mean[out], mean, rtol=1e-6)
        np.testing.assert_allclose(
            process.left_out.variance[out],
            variance / rest.inflation + process.form.noise,
            rtol=1e-6,
        )


def test_variance_is_inflated_where_left_out_points_say_so(rng):
    # A process that believes in a quarter of its variance is wrong by twice what it expects.
    inputs, y = effect_runs(rng)
    honest = trained(inputs, y).parts[0].processes[0]
    believes = replace(honest.form, scale=honest.form.scale / 2.0)
    # The data in its units are twice as large, its variances those of the honest one.
    proud = condition(believes, honest.runs)
    assert proud.z_rms == pytest.approx(2.0 * honest.z_rms)
    learnt = honest.inflation / max(honest.z_rms, 1.0) ** 2
    assert proud.inflation == pytest.approx(learnt * proud.z_rms**2)
    at = Inputs.at(rng.random((5, 3)), effects=1)
    ratio = proud.predict(at)[1] / honest.predict(at)[1]
    np.testing.assert_allclose(ratio, proud.inflation / honest.inflation / 4.0, rtol=1e-6)


def test_variance_never_falls_by_inflation(rng):
    inputs, y = effect_runs(rng)
    honest = trained(inputs, y).parts[0].processes[0]
    modest = condition(replace(honest.form, scale=honest.form.scale * 3.0), honest.runs)
    assert modest.z_rms < 1.0
    points, learnt = len(np.unique(inputs.u, axis=0)), honest.form.hyper.count
    # Akaike's factor for numbers that were learnt from the same points.
    assert modest.inflation == pytest.approx((points + learnt) / (points - learnt))
