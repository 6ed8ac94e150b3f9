"""The next runs: where the answer is uncertain, what it costs, and when to repeat."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibrate.emulator.types import Inputs
from calibrate.planning.infill import Field, best_batch, flattened
from tests.calibrate.planning.process import FixedProcess

POSTERIOR = (0.6, 0.05)  # centre and width of the draws in these tests


def weighted_error(field: Field) -> float:
    return float(np.sum(field.emulator.predict(field.at).total * field.weights))


@pytest.fixture
def field(rng) -> Field:
    """Return one input, runs at five places, draws around 0.6, candidates everywhere."""
    u = np.linspace(0.0, 1.0, 3)[:, None]
    draws = np.clip(rng.normal(*POSTERIOR, size=(60, 1)), 0.0, 1.0)
    candidates = np.vstack([np.linspace(0.0, 1.0, 41)[:, None], u])
    return Field(
        emulator=FixedProcess(u, np.sin(6.0 * u), length=0.2),
        at=Inputs.at(draws),
        weights=np.full((60, 1), 1.0 / 60 / 0.01),
        candidates=Inputs.at(candidates),
        known=np.arange(44) >= 41,
        costs=np.ones(44),
    )


def test_a_run_goes_where_the_posterior_is(field) -> None:
    (one,) = best_batch([field], 1)
    assert field.candidates.u[one.candidate, 0] == pytest.approx(POSTERIOR[0], abs=0.06)


def test_the_promised_gain_is_the_fall_of_the_error(field) -> None:
    (one,) = best_batch([field], 1)
    run = field.candidates.rows(slice(one.candidate, one.candidate + 1))
    after = replace(field, emulator=field.emulator.updated(run, np.zeros((1, 1))))
    assert one.gain == pytest.approx(weighted_error(field) - weighted_error(after), rel=1e-9)


def test_a_batch_is_told_of_its_own_runs(field) -> None:
    batch = best_batch([field], 4)
    gains = [one.gain for one in batch]
    assert gains == sorted(gains, reverse=True)
    assert len({one.candidate for one in batch}) > 1
    assert sum(gains) < weighted_error(field)


def test_runs_that_measure_nothing_are_not_made(field) -> None:
    assert best_batch([replace(field, weights=np.zeros((60, 1)))], 3) == []


def test_the_precise_measurement_and_the_cheap_run_come_first(field) -> None:
    sloppy = replace(field, weights=field.weights / 9.0)
    assert best_batch([sloppy, field], 1)[0].field == 1
    dear = replace(field, costs=4.0 * field.costs)
    assert best_batch([dear, field], 1)[0].field == 1
    assert best_batch([dear, sloppy], 1)[0].field == 0


def test_noise_is_fought_by_repeats_and_ignorance_by_new_points(field) -> None:
    # Runs every 0.025 and all the uncertainty is noise: where matters little.
    u = np.linspace(0.0, 1.0, 41)[:, None]
    noisy = replace(
        field,
        emulator=FixedProcess(u, np.sin(u), length=0.6, noise=1.0),
        candidates=Inputs.at(np.vstack([u + 0.0125, u])),
        known=np.arange(82) >= 41,
        costs=np.ones(82),
    )
    assert all(noisy.known[one.candidate] for one in best_batch([noisy], 3))
    assert not field.known[best_batch([field], 1)[0].candidate]


def test_the_budget_is_kept(field) -> None:
    assert len(best_batch([field], 10, budget=3.5)) == 3


def test_flattened_points_are_wider_than_the_posterior_and_inside(rng) -> None:
    samples = np.clip(rng.normal([0.1, 0.5], [0.05, 0.02], size=(500, 2)), 0.0, 1.0)
    around = flattened(samples, 1000, rng)
    assert around.min() >= 0.0
    assert around.max() <= 1.0
    assert around[:, 1].std() > 1.1 * samples[:, 1].std()
    assert around * 1000 == pytest.approx(np.round(around * 1000), abs=1e-9)
    assert around.mean(axis=0) == pytest.approx(samples.mean(axis=0), abs=0.02)
