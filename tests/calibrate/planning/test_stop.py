"""When enough is enough."""

from __future__ import annotations

import numpy as np
import pytest

from calibrate.planning.stop import Outlook, expected_moves, weighted_quantiles


def test_weights_count_like_copies(rng) -> None:
    values = rng.normal(size=(400, 2))
    weights = rng.integers(1, 4, size=400)
    copies = np.repeat(values, weights, axis=0)
    ours = weighted_quantiles(values, weights.astype(float), (0.1, 0.5, 0.9))
    # A copy more or less at a quantile moves it by the distance of neighbours.
    assert ours == pytest.approx(np.quantile(copies, (0.1, 0.5, 0.9), axis=0), abs=0.03)


def test_outcomes_that_change_no_likelihood_move_nothing(rng) -> None:
    samples = rng.normal(size=(300, 3))
    assert expected_moves(samples, np.full((4, 300), -7.0)) == pytest.approx(np.zeros(3))


def test_a_shift_of_the_posterior_is_told_in_lengths_of_the_interval(rng) -> None:
    # exp(a x) turns N(0, 1) into N(a, 1); its 90 % interval is 3.29 long.
    samples = np.column_stack([rng.normal(size=20_000), rng.normal(size=20_000)])
    shift = 0.5
    ratios = np.array([shift * samples[:, 0], -shift * samples[:, 0]])
    moves = expected_moves(samples, ratios)
    # Tails of weighted draws are thin: three standard errors of a quantile.
    assert moves[0] == pytest.approx(shift / 3.29, rel=0.15)
    assert moves[1] < 0.02


@pytest.mark.parametrize(
    ("outlook", "stops", "words"),
    [
        (Outlook(50, 400, 20, ("a", "b"), (0.05, 0.02)), True, "no interval by more than 5 %"),
        (Outlook(50, 400, 20, ("a", "b"), (0.05, 0.3)), False, "move b by 30 %"),
        (Outlook(400, 400, 20, ("a", "b"), (0.05, 0.3)), True, "budget of 400 runs is spent"),
        (Outlook(50, 400, 20, error_ratio=0.02, tolerance=0.1), True, "0.02 of the measurements'"),
        (Outlook(50, 400, 20, error_ratio=0.2, tolerance=0.1), False, "50 of 400 runs"),
    ],
)
def test_the_reason_is_said(outlook, stops, words) -> None:
    assert outlook.stop is stops
    assert words in outlook.words
