"""Surrogates of known functions with known noise."""

from __future__ import annotations

import numpy as np
import pytest

from calibrate.errors import CalibrationError
from calibrate.scales import backward, forward, slope
from calibrate.staged.design import latin_hypercube
from calibrate.staged.surrogates.samples import Samples
from calibrate.staged.surrogates.surface import Surrogate, fit_surrogate

UNIT = np.array([[0.0, 1.0], [0.0, 1.0]])
NOISE = 0.5


def smooth(x: np.ndarray) -> np.ndarray:
    return 30.0 + 8.0 * x[:, 0] + 5.0 * np.sqrt(x[:, 1]) + 2.0 * np.sin(4.0 * x[:, 0])


def sampled(seed: int, noise: float, points: int = 24, nuisance: float = 0.0) -> Samples:
    rng = np.random.default_rng(seed)
    x = latin_hypercube(UNIT, points, rng)
    w = rng.normal(size=(points, 2)) if nuisance else np.empty((points, 0))
    x, w = np.vstack([x, x[:6]]), np.vstack([w, w[:6]])
    effect = nuisance * w[:, 0] if nuisance else 0.0
    return Samples(x, smooth(x) + effect + noise * rng.normal(size=len(x)), w)


@pytest.fixture(scope="module")
def fits() -> list[Surrogate]:
    return [fit_surrogate(sampled(seed, NOISE), 1) for seed in range(8)]


@pytest.fixture(scope="module")
def inside() -> np.ndarray:
    return np.random.default_rng(9).uniform(0.05, 0.95, size=(400, 2))


def test_prediction_is_better_than_one_run(fits, inside):
    errors = [np.sqrt(np.mean((fit.predict(inside)[0] - smooth(inside)) ** 2)) for fit in fits]
    # Smoothing over 24 points must beat the noise of a single run at least in the median.
    assert np.median(errors) < NOISE


def test_error_bars_are_right_over_many_designs(fits, inside):
    z = []
    for fit in fits:
        mean, variance = fit.predict(inside)
        z.append((mean - smooth(inside)) / np.sqrt(variance))
    # 1 is exact; errors within one design are correlated, so 8 designs tell it to about a third.
    assert 0.5 < np.sqrt(np.mean(np.square(z))) < 1.6


def test_noise_is_found_from_few_repeats(fits):
    noise = np.array([fit.quality.noise_sd for fit in fits])
    # 6 repeats and the surface, about 10 degrees of freedom: 22 % per design.
    assert np.all((noise > 0.4 * NOISE) & (noise < 2.0 * NOISE)), noise
    assert np.mean(noise) == pytest.approx(NOISE, rel=0.25)


def test_quality_is_high_and_inflation_never_shrinks(fits):
    for fit in fits:
        assert fit.quality.q2 > 0.8
        assert fit.quality.inflation >= max(1.0, fit.quality.z_rms**2)
        assert (fit.quality.points, fit.quality.runs) == (24, 30)


def test_table_agrees_with_the_model_it_was_made_from(inside):
    # The spline replaces smt's own prediction; a tenth of the predicted sd does not matter.
    from calibrate.staged.surrogates import surface as module

    samples = sampled(3, NOISE)
    points = module._gather(samples)
    fitted = module._train_all(points, points.y, 1)
    weights = np.array([1.0, 0.0, 0.0])
    mean, variance = module._table([f.model for f in fitted], weights)(inside)
    direct = fitted[0].model.predict_values(inside)[:, 0]
    sd = np.sqrt(fitted[0].model.predict_variances(inside)[:, 0])
    assert np.all(np.abs(mean - direct) < 0.1 * sd)
    np.testing.assert_allclose(np.sqrt(variance), sd, rtol=0.1)


def test_left_out_formula_equals_refitting():
    """The closed form must equal a fit that really lacks the point, lengths and noise held."""
    from calibrate.staged.surrogates import surface as module

    points = module._gather(sampled(1, NOISE))
    model = module._train(points, points.y, ("matern52", "linear"), 1, NOISE**2).model
    residual, variance = module.leave_one_out(model, points.y)
    sigma2 = float(np.squeeze(model.optimal_par["sigma2"]))
    chol = np.asarray(model.optimal_par["C"]) * np.sqrt(sigma2)
    k, trend = chol @ chol.T, np.asarray(model.F)
    for i in (0, 7, 20):
        rest = np.delete(np.arange(len(points.y)), i)
        inverse = np.linalg.inv(k[np.ix_(rest, rest)])
        f, y = trend[rest], points.y[rest]
        beta = np.linalg.solve(f.T @ inverse @ f, f.T @ inverse @ y)
        guess = trend[i] @ beta + k[i, rest] @ inverse @ (y - f @ beta)
        open_ = trend[i] - f.T @ inverse @ k[rest, i]
        expected = k[i, i] - k[i, rest] @ inverse @ k[rest, i]
        expected += open_ @ np.linalg.solve(f.T @ inverse @ f, open_)
        # Two orders of the same linear algebra: rounding only.
        assert residual[i] == pytest.approx(points.y[i] - guess, rel=1e-6)
        assert variance[i] == pytest.approx(expected, rel=1e-6)


def test_influence_of_earlier_parameters_is_found_and_removed(inside):
    fit = fit_surrogate(sampled(2, NOISE, nuisance=1.5), 1)
    # 1.5 per sd from 24 points with noise 0.5: standard error about 0.15, prior shrinks a little.
    assert fit.gradient[0] == pytest.approx(1.5, abs=0.5)
    assert fit.gradient[1] == pytest.approx(0.0, abs=0.5)
    error = np.sqrt(np.mean((fit.predict(inside)[0] - smooth(inside)) ** 2))
    assert error < 2.0 * NOISE


def test_too_few_points_are_refused():
    samples = sampled(1, NOISE)
    few = Samples(samples.x[:5], samples.y[:5], samples.nuisance[:5])
    with pytest.raises(CalibrationError, match="only 5 usable points"):
        fit_surrogate(few, 1)


def test_constant_observable_is_refused():
    samples = sampled(1, NOISE)
    flat = Samples(samples.x, np.full(len(samples.y), 3.0), samples.nuisance)
    with pytest.raises(CalibrationError, match="is 3 in every run"):
        fit_surrogate(flat, 1)


@pytest.mark.parametrize("kind", ["linear", "log", "sqrt"])
def test_transform_is_undone_and_its_slope_is_the_derivative(kind: str):
    y = np.array([0.5, 2.0, 30.0])
    np.testing.assert_allclose(backward(kind, forward(kind, y)), y, rtol=1e-14)
    step = 1e-6
    for value in y:
        numeric = (forward(kind, value + step) - forward(kind, value - step)) / (2.0 * step)
        assert slope(kind, value) == pytest.approx(float(numeric), rel=1e-6)


def test_transform_of_impossible_values_is_nan():
    assert np.isnan(forward("log", np.array([0.0, -1.0]))).all()
    assert forward("sqrt", np.array([0.0]))[0] == 0.0
    assert np.isnan(forward("sqrt", np.array([-1.0])))[0]
