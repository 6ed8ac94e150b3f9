"""Simple methods on a linear bench: each sees a strong cause, the oracle a weaker one."""

from __future__ import annotations

import numpy as np
import pytest

from calibrate.causes.candidates import Candidate
from calibrate.challenge.judges.baselines import BASELINES, baseline
from calibrate.inference.priors import Prior
from tests.calibrate.causes.formula import board, linear

SLOPES = np.array([[1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.0, 0.0]])
EFFECTS = np.array([[0.0, 1.0], [0.0, 0.0], [0.5, 0.0], [1.0, 0.0]])
THETA = np.array([0.3, -0.2])
CAUSES = tuple(Candidate(n, n, 1.0, -6.0, 6.0, ((0, k),)) for k, n in enumerate(("seen", "hidden")))


def _bench(strengths):
    y = SLOPES @ THETA + EFFECTS @ np.array(strengths)
    priors = (Prior.normal(0.0, 1.0), Prior.normal(0.0, 1.0))
    return board(linear(SLOPES, EFFECTS), y, np.full(4, 0.2), CAUSES, priors=priors, effects=2)


VALUES = {"p0": 0.3, "p1": -0.2}


@pytest.mark.parametrize("name", ["signature", "rule_31a2ed1", "oracle"])
def test_a_strong_cause_is_named_and_nothing_where_nothing_is(name):
    strong, none = (baseline(name, _bench(x), VALUES) for x in ((2.5, 0.0), (0.0, 0.0)))
    assert (strong["verdict"], strong["names"]) == ("named", ["seen"])
    assert (none["verdict"], none["names"]) == ("none", [])


def test_the_oracle_sees_what_parameters_imitate():
    """Half a unit of the second cause is half a unit of the first parameter, but for a reading."""
    bench = _bench((0.0, 1.0))
    assert baseline("oracle", bench, VALUES)["names"] == ["hidden"]
    assert baseline("signature", bench)["inclusion"].get("hidden", 0.0) < 1.0


def test_the_prior_knows_no_data():
    one, other = (baseline("prior", _bench(x)) for x in ((0.0, 0.0), (2.5, 0.0)))
    assert one == other
    assert set(BASELINES) == {"prior", "signature", "rule_31a2ed1", "oracle"}
