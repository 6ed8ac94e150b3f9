"""Emulators of several outputs: curves, failed runs, new runs, files, mistakes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from calibrate.emulator.emulator import TrainedEmulator, train_emulator
from calibrate.emulator.quality import draw_left_out
from calibrate.emulator.store import load_emulator, save_emulator
from calibrate.emulator.types import Inputs, Output
from calibrate.errors import CalibrationError
from tests.calibrate.emulator.synthetic import ONE, runs_at, spread_points

BOTH = (Output("angle", slice(0, 1)), Output("curve", slice(1, 7)))
LEVELS = np.linspace(0.5, 1.0, 6)


def two_outputs(u: np.ndarray, rng: np.random.Generator, noise: float = 0.01) -> np.ndarray:
    """Return a number, and a curve that two amplitudes make, shape (n, 7)."""
    number = np.sin(3 * u[:, 0]) + u[:, 1]
    curve = np.multiply.outer(u[:, 0] ** 2, LEVELS) + np.multiply.outer(u[:, 1], LEVELS**2)
    seen = np.column_stack([number, curve])
    return seen + noise * rng.standard_normal(seen.shape)


@pytest.fixture
def inputs(rng) -> Inputs:
    return runs_at(spread_points(60, 2, rng))


@pytest.fixture
def emulator(inputs, rng) -> TrainedEmulator:
    return train_emulator(inputs, BOTH, two_outputs(inputs.u, rng))


def test_a_number_and_a_curve(emulator, rng):
    u = rng.random((40, 2))
    found = emulator.predict(Inputs.at(u))
    np.testing.assert_allclose(found.mean, two_outputs(u, rng, noise=0.0), atol=0.03)
    assert found.factors.shape[:2] == (40, 7)
    assert not found.factors[:, 0].any()  # only the values of one curve have errors in common
    assert (found.factors[:, 1:] != 0.0).any()
    cut_off = np.concatenate([[0.0], emulator.parts[1].components.truncation])
    scatter = emulator.noise + cut_off
    assert scatter[0] == pytest.approx(1e-4, rel=0.5)
    assert scatter[1:].mean() == pytest.approx(1e-4, rel=0.5)  # components share it among levels
    assert list(emulator.quality["output"]) == ["angle", "curve"]
    assert (emulator.quality["Q2"] > 0.98).all()


def test_covariance_of_a_curve_is_that_of_its_errors(rng):
    # Over many training sets, errors at one place scatter as one prediction says.
    errors, said = [], []
    at = Inputs.at([[0.3, 0.6]])
    for _ in range(40):
        inputs = runs_at(spread_points(32, 2, rng))
        emulator = train_emulator(inputs, BOTH, two_outputs(inputs.u, rng, noise=0.05))
        found = emulator.predict(at)
        errors.append((found.mean - two_outputs(at.u, rng, noise=0.0))[0, 1:])
        factors = found.factors[0, 1:]
        said.append(np.diag(found.variance[0, 1:]) + factors @ factors.T)
    whole = np.ones(6)  # the sum over the curve sees the covariances
    seen, expected = np.mean((errors @ whole) ** 2), np.mean(whole @ said @ whole)
    assert 0.4 < seen / expected < 1.8  # 40 draws tell a variance to a quarter


def test_what_is_cut_off_a_curve_is_kept_as_variance(rng):
    inputs = runs_at(spread_points(50, 2, rng))
    emulator = train_emulator(inputs, BOTH, two_outputs(inputs.u, rng, noise=0.02))
    part = emulator.parts[1]
    rest = part.y - part.components.centre
    rest = rest - part.components.scores(part.y) @ part.components.basis.T
    assert (part.components.truncation > 0.0).all()
    np.testing.assert_allclose(part.components.truncation, np.mean(rest**2, axis=0))
    found = emulator.predict(inputs.rows(slice(0, 3)))
    np.testing.assert_allclose(found.variance[:, 1:], np.tile(part.components.truncation, (3, 1)))


def test_a_failed_run_is_left_out_of_its_output_only(inputs, rng):
    y = two_outputs(inputs.u, rng)
    y[3, 0] = np.nan
    y[4:6, 2] = np.nan
    emulator = train_emulator(inputs, BOTH, y)
    assert list(emulator.quality["n"]) == [59, 58]
    alone = train_emulator(inputs.rows(np.arange(60) != 3), ONE, np.delete(y, 3, axis=0)[:, :1])
    at = Inputs.at(rng.random((5, 2)))
    np.testing.assert_array_equal(emulator.predict(at).mean[:, 0], alone.predict(at).mean[:, 0])


def test_two_materials_are_a_column_of_the_inputs(rng):
    # The second material has a steeper response; its few runs borrow from the first.
    u = np.column_stack([spread_points(72, 2, rng), np.zeros(72)])
    u[48:, 2] = 1.0
    inputs = runs_at(u)

    def truth(u):
        return np.sin(2 * u[:, 0]) + u[:, 1] * (1.0 + 0.5 * u[:, 2])

    def errors(used):
        y = truth(u[used]) + noise[used]
        emulator = train_emulator(inputs.rows(used), ONE, y[:, None])
        return emulator.predict(Inputs.at(at)).mean[:, 0] - truth(at)

    noise = 0.03 * rng.standard_normal(72)
    at = np.column_stack([rng.random((200, 2)), np.ones(200)])
    joint, alone = np.std(errors(np.arange(72))), np.std(errors(np.arange(48, 72)))
    assert joint < 0.03
    assert joint < alone


def test_new_runs_count_at_once(emulator, inputs, rng):
    at = Inputs.at([[0.5, 0.5]])
    new = Inputs(np.full((4, 2), 0.5), np.zeros((4, 0)), 100.0 + np.arange(4))
    y = two_outputs(new.u, rng)
    y[0, 1] = np.nan
    after = emulator.updated(new, y)
    assert list(after.quality["n"]) == [64, 63]
    assert (after.predict(at).total < emulator.predict(at).total).all()
    for before, now in zip(emulator.parts, after.parts, strict=True):
        for one, other in zip(before.processes, now.processes, strict=True):
            assert one.form is other.form
    same = emulator.updated(new, np.full((4, 7), np.nan))
    np.testing.assert_array_equal(same.predict(at).mean, emulator.predict(at).mean)


def test_reduction_is_what_a_run_brings(emulator, rng):
    candidates = Inputs.at(rng.random((3, 2)))
    at = Inputs.at(rng.random((4, 2)))
    said = emulator.reduction(candidates, at)
    assert said.shape == (3, 4, 7)
    inflation = np.array([one.inflation for p in emulator.parts for one in p.processes])
    for k in range(3):
        after = emulator.updated(candidates.rows([k]), two_outputs(candidates.u[[k]], rng))
        for part, now in zip(emulator.parts, after.parts, strict=True):
            fall = np.zeros((4, part.y.shape[1]))
            for f, (one, other) in enumerate(zip(part.processes, now.processes, strict=True)):
                new = other.predict(at)[1] / other.inflation * one.inflation
                fall += np.outer(one.predict(at)[1] - new, part.components.basis[:, f] ** 2)
            np.testing.assert_allclose(said[k][:, part.output.columns], fall, rtol=1e-5, atol=1e-12)
    assert (inflation >= 1.0).all()
    weights = rng.random((4, 7))
    np.testing.assert_allclose(
        emulator.weighted_reduction(candidates, at, weights),
        np.einsum("cam,am->c", said, weights),
    )


def test_where_noise_dominates_repeats_bring_little_each(rng):
    u = spread_points(40, 1, rng)
    y = (u[:, 0] + 0.5 * rng.standard_normal(40))[:, None]
    emulator = train_emulator(runs_at(u), ONE, y)
    at = Inputs.at([[0.5]])
    share = emulator.reduction(at, at)[0, 0, 0] / emulator.predict(at).total[0, 0]
    noise = emulator.noise[0]
    error = emulator.predict(at).total[0, 0] / emulator.quality["inflation"][0]
    assert share == pytest.approx(error / (error + noise), rel=0.1)
    assert share < 0.3


def test_the_same_numbers_from_a_file(emulator, tmp_path: Path, rng):
    path = tmp_path / "heap.npz"
    save_emulator(emulator, path)
    assert [one.name for one in tmp_path.iterdir()] == ["heap.npz"]
    again, at = load_emulator(path), Inputs.at(rng.random((20, 2)))
    for field in ("mean", "variance", "factors"):
        one, other = (getattr(e.predict(at), field) for e in (emulator, again))
        np.testing.assert_array_equal(one, other)
    assert again.outputs == emulator.outputs
    assert again.quality.equals(emulator.quality)
    save_emulator(again, tmp_path / "again.npz")
    twice = load_emulator(tmp_path / "again.npz")
    np.testing.assert_array_equal(twice.predict(at).mean, again.predict(at).mean)


@pytest.mark.parametrize("damage", ["cut", "text", "missing"])
def test_a_damaged_file_is_named(emulator, tmp_path: Path, damage):
    path = tmp_path / "heap.npz"
    save_emulator(emulator, path)
    if damage == "cut":
        path.write_bytes(path.read_bytes()[:-200])
    elif damage == "text":
        path.write_text("u = 1")
    else:
        path.unlink()
    with pytest.raises(CalibrationError, match=r"heap\.npz.*train it again"):
        load_emulator(path)


def test_the_figure_shows_every_left_out_run(emulator):
    axis = Figure().subplots()
    draw_left_out(axis, emulator.parts[1])
    seen = axis.containers[0].lines[0].get_xdata()
    assert len(seen) == 60 * 6
    left = emulator.parts[1].left_out
    np.testing.assert_array_equal(seen, left.y.ravel())


def test_a_prediction_of_some_columns(emulator, rng):
    found = emulator.predict(Inputs.at(rng.random((3, 2))))
    part = found.columns(slice(1, 7))
    np.testing.assert_array_equal(part.total, found.total[:, 1:])


def test_the_luck_of_the_first_levels_of_a_curve(emulator):
    number, curve = emulator.outputs
    whole = emulator.luck(curve.columns)
    first = slice(curve.columns.start, curve.columns.start + 2)
    assert np.array_equal(emulator.luck(first), whole[:2, :2])
    assert emulator.luck(number.columns).shape == (1, 1)
    with pytest.raises(ValueError, match="those of no output"):
        emulator.luck(slice(0, curve.columns.start + 1))
