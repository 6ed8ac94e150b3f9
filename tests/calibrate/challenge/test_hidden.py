"""Hidden effects in data of the engine: each must be found, with nothing hidden nothing is named.

The studies were made by `python -m tests.calibrate.challenge.make_hidden tests/data/hidden`; the
diagnosis learns from the runs of `cases/challenge/runs`, none of which lies at their parameters.
"""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
import pytest

from calibrate.causes.candidates import Measured
from calibrate.causes.diagnosis import Diagnosis, Options, diagnose
from calibrate.causes.weighing.evidences import Effort
from calibrate.challenge.folders import Suite
from calibrate.challenge.learnt import learnt_of
from calibrate.challenge.opening import checked_truths
from calibrate.study.data import load_data
from tests.calibrate.challenge.make_hidden import CASES, RULES, TRUTHS
from tests.paths import ROOT

SUITE = Suite(ROOT / "tests" / "data" / "hidden")
OPTIONS = Options(held_out=False, effort=Effort(100.0, 4))
NOTHING, TILT, COHESION, SIZES, SLOPE, PAIR, BOX, MOTION, LATE = range(1, len(TRUTHS) + 1)
# What a laboratory can look up in an hour: a hundred strokes timed, the flows weighed.
LOOKED_UP = (("plate_period", 0.0, 0.002), ("mass_flow_factor", 0.0, 0.01))
Known = tuple[tuple[str, float, float], ...]


@functools.cache
def _learnt():
    return learnt_of(RULES, CASES)[1]


@functools.cache
def _found(number: int, known: Known = ()) -> Diagnosis:
    board = _learnt().board(load_data(SUITE.study(number) / "study.toml"))
    measured = {name: (Measured(value, se),) for name, value, se in known}
    return diagnose(replace(board, known=measured), np.random.default_rng(1), options=OPTIONS)


def _strength(number: int, which: int = 0) -> float:
    return TRUTHS[number - 1][2][which].strength


def test_the_truths_are_those_of_the_command():
    for kept, (kind, _, hidden) in zip(checked_truths(SUITE).values(), TRUTHS, strict=True):
        assert kept["kind"] == kind
        assert [(h["name"], h["strength"]) for h in kept["hidden"]] == [
            (h.name, h.strength) for h in hidden
        ]


def test_nothing_hidden_names_nothing():
    verdict = _found(NOTHING).verdict
    assert verdict.kind == "none"
    assert not verdict.names


@pytest.mark.parametrize(
    ("number", "known"),
    [(COHESION, ()), (SLOPE, ()), (SIZES, LOOKED_UP), (TILT, LOOKED_UP)],
)
def test_a_hidden_cause_is_named_and_sized(number, known):
    found = _found(number, known)
    ((_, _, (hidden,)),) = [TRUTHS[number - 1]]
    assert found.verdict.kind == "named"
    assert found.verdict.names == (hidden.name,)
    span = found.interval(hidden.name, 0.99)
    assert span.low < hidden.strength < span.high


def test_both_causes_of_a_pair_are_named():
    verdict = _found(PAIR).verdict
    assert verdict.kind == "named"
    assert sorted(verdict.names) == sorted(h.name for h in TRUTHS[PAIR - 1][2])


def test_look_alikes_are_a_set_until_what_was_proposed_is_measured():
    before = _found(TILT)
    assert before.verdict.kind == "set"
    assert "plate_tilt_deg" in before.verdict.names
    offer = before.prospect.offers[0].measurement
    truth = _strength(TILT) if offer.effect == "plate_tilt_deg" else 0.0
    after = _found(TILT, ((offer.effect, truth, offer.se),))
    assert after.verdict.names == ("plate_tilt_deg",)


@pytest.mark.parametrize(("number", "where"), [(BOX, "m1"), (MOTION, "curve"), (LATE, "curve")])
def test_what_no_candidate_describes_is_unknown_in_the_right_experiment(number, where):
    verdict = _found(number).verdict
    assert verdict.kind == "unknown"
    assert where in next(iter(verdict.answers.where))
