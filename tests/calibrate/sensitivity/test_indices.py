"""Sobol indices with known answers, of exact functions and by way of an emulator."""

from __future__ import annotations

import numpy as np
import pytest

from calibrate.emulator.emulator import train_emulator
from calibrate.emulator.types import Inputs
from calibrate.inference.sensitivity import Indices, sobol
from tests.calibrate.emulator.synthetic import ONE, runs_at, spread_points

ISHIGAMI_FIRST = [0.3139, 0.4424, 0.0]
ISHIGAMI_TOTAL = [0.5576, 0.4424, 0.2437]
"""Of a = 7, b = 0.1: Saltelli, Chan and Scott 2000, Sensitivity Analysis, table 2.9."""
SAMPLING = 0.03
"""Error of 1024 base points."""


def ishigami(u: np.ndarray) -> np.ndarray:
    x = np.pi * (2.0 * u - 1.0)
    return np.sin(x[:, 0]) * (1.0 + 0.1 * x[:, 2] ** 4) + 7.0 * np.sin(x[:, 1]) ** 2


def g_function(u: np.ndarray, a: np.ndarray) -> np.ndarray:
    return np.prod((np.abs(4.0 * u - 2.0) + a) / (1.0 + a), axis=1)


def exact(function, size: int, rng) -> Indices:
    return sobol(function, lambda u, count: np.zeros((count, len(u))), size, rng)


def by_emulator(inputs: Inputs, y: np.ndarray, rng) -> Indices:
    process = train_emulator(inputs, ONE, y[:, None]).parts[0].processes[0]
    return sobol(
        lambda u: process.predict(Inputs.at(u))[0],
        lambda u, count: process.errors(Inputs.at(u), count, rng),
        inputs.u.shape[1],
        rng,
    )


def test_indices_of_ishigamis_function_are_known(rng) -> None:
    found = exact(ishigami, 3, rng)
    assert found.first == pytest.approx(ISHIGAMI_FIRST, abs=SAMPLING)
    assert found.total == pytest.approx(ISHIGAMI_TOTAL, abs=SAMPLING)
    assert found.made.max() == 0.0
    assert found.error_share == 0.0


def test_indices_of_the_g_function_are_known(rng) -> None:
    a = np.array([0.0, 1.0, 9.0])
    alone = 1.0 / (3.0 * (1.0 + a) ** 2)
    variance = np.prod(1.0 + alone) - 1.0
    found = exact(lambda u: g_function(u, a), 3, rng)
    assert found.first == pytest.approx(alone / variance, abs=SAMPLING)
    total = alone * np.prod(1.0 + alone) / (1.0 + alone) / variance
    assert found.total == pytest.approx(total, abs=SAMPLING)


def test_an_emulator_finds_them_and_its_intervals_hold_them(rng) -> None:
    inputs = runs_at(spread_points(128, 3, rng))
    found = by_emulator(inputs, ishigami(inputs.u), rng)
    for truth, span in ((ISHIGAMI_FIRST, found.first_span), (ISHIGAMI_TOTAL, found.total_span)):
        assert np.all(span[:, 0] - SAMPLING <= truth)
        assert np.all(truth <= span[:, 1] + SAMPLING)
        assert np.all(span[:, 1] - span[:, 0] < 0.3)
    assert found.total == pytest.approx(ISHIGAMI_TOTAL, abs=0.1)


def test_what_the_emulator_does_not_know_is_no_influence(rng) -> None:
    """Few noisy runs of y = u0: the index of what does nothing is within what the error makes."""
    seen = []
    for _ in range(8):
        inputs = runs_at(spread_points(24, 3, rng))
        found = by_emulator(inputs, inputs.u[:, 0] + 0.1 * rng.normal(size=24), rng)
        assert found.total[0] > 5.0 * found.made[0]
        assert found.total_span[0, 1] > 0.95
        seen += list(found.total[1:] > found.made[1:])
    assert np.mean(seen) < 0.5


def test_draws_of_the_error_have_the_variance_that_is_predicted(rng) -> None:
    inputs = runs_at(spread_points(16, 2, rng))
    y = np.sin(4.0 * inputs.u[:, 0]) + 0.05 * rng.normal(size=16)
    process = train_emulator(inputs, ONE, y[:, None]).parts[0].processes[0]
    at = Inputs.at(rng.random((20, 2)))
    drawn = process.errors(at, 4000, rng)
    # The relative error of a variance from 4000 draws is 2 %.
    assert drawn.var(axis=0) == pytest.approx(process.predict(at)[1], rel=0.1)
    near = Inputs.at(np.array([[0.4, 0.4], [0.4, 0.401]]))
    pair = process.errors(near, 1000, rng)
    assert np.corrcoef(pair.T)[0, 1] > 0.99
