"""How far a cause is from what parameters can do elsewhere, on curves with known answers."""

from __future__ import annotations

import numpy as np
import pytest

from calibrate.causes.candidates import Board, Candidate
from calibrate.challenge.imitation import unlike_any
from calibrate.emulator.types import Prediction
from calibrate.inference.priors import Prior
from calibrate.inference.problem import Place, Problem, Reading, Source
from calibrate.inference.space import Space, Unknown

SE = 0.01
AT = 0.2


class Arch:
    """Two numbers of one parameter, (u, 4 u (1 - u) + height), and what a cause adds to them."""

    def __init__(self, added: tuple[float, float]) -> None:
        self.added = np.array(added)

    def predict(self, inputs):
        """Return them as known exactly."""
        u = inputs.u[:, 0]
        mean = np.column_stack([u, 4.0 * u * (1.0 - u)]) + inputs.strengths * self.added
        return Prediction(mean, np.zeros_like(mean), np.zeros((*mean.shape, 0)))


def unlike(added: tuple[float, float], strength: float = 1.0, **truth) -> float:
    reading = Reading("r", slice(0, 2), np.zeros(2), np.full(2, SE))
    off = Source(None, 0.0)
    place = Place("heap", Arch(added), (Source(0),), (off,), (reading,))
    problem = Problem(Space((Unknown("mu_pp", "", Prior.uniform(0.0, 1.0)),)), (place,))
    board = Board(problem, (Candidate.of_effect("cause", 0.5, (-3.0, 3.0), ((0, 0),)),))
    hidden = [{"name": "cause", "strength": 0.5 * strength}]
    told = {"kind": "single", "values": {"mu_pp": AT}, "hidden": hidden, **truth}
    return unlike_any(board, told, np.random.default_rng(1))


def test_a_cause_that_other_parameters_do_exactly_is_not_told() -> None:
    # From one foot of the arch to the other: far from its tangent, and on it.
    slope = 4.0 - 8.0 * AT
    across = (1.0 - 2.0 * AT) * slope / np.hypot(1.0, slope) / SE
    assert across > 50.0
    assert unlike((1.0 - 2.0 * AT, 0.0)) == pytest.approx(0.0, abs=1e-3)


def test_a_cause_that_no_parameter_does_is_as_far_as_the_arch() -> None:
    # Above its top by h: the top is nearest.
    height = 0.3
    top = (0.5 - AT, 1.0 + height - 4.0 * AT * (1.0 - AT))
    assert unlike(top) == pytest.approx(height / SE, rel=1e-6)
    # Half as strong, a hundredth beside the arch: that is a distance along its normal.
    beside = 0.01 * np.array([-(4.0 - 8.0 * AT), 1.0]) / np.hypot(1.0, 4.0 - 8.0 * AT)
    assert unlike(tuple(2.0 * beside), 0.5) == pytest.approx(0.01 / SE, rel=1e-6)


def test_what_was_not_measured_tells_nothing_and_what_is_foreign_nobody_knows() -> None:
    elsewhere = [{"name": "of another place", "strength": 1.0}]
    assert unlike((1.0, 1.0), hidden=elsewhere) == pytest.approx(0.0, abs=1e-9)
    assert np.isnan(unlike((1.0, 1.0), kind="foreign"))
