"""Studies with a hidden cause: it is named or in the set; without one nothing is named."""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
import pytest

from calibrate.causes.candidates import Measured
from calibrate.causes.diagnosis import Options, diagnose
from calibrate.causes.judging.levels import Levels
from calibrate.causes.strengths.widened import FACTOR
from calibrate.causes.told.figure import diagnosis_figure
from calibrate.causes.told.record import diagnosis_record
from calibrate.causes.told.words import headline, sentences
from calibrate.causes.weighing.evidences import Effort
from tests.calibrate.causes.planted import study

QUICK = Options(Levels(studies=400), held_out=False, effort=Effort(150.0, 4))


@functools.cache
def _found(seed, held_out=False, **hidden):
    rng = np.random.default_rng([11, seed])
    return diagnose(study(hidden, rng), rng, options=replace(QUICK, held_out=held_out))


def _strong():
    return _found(1, held_out=True, cohesion=5.0)


def test_a_strength_is_told_less_surely_than_its_draws_unless_it_was_measured():
    found = _strong()
    drawn = found.strengths("cohesion")
    bench = {"cohesion": (Measured(found.strength("cohesion"), 100.0),)}
    board = replace(found.board, known=bench)  # so vague that it says nothing
    measured = replace(found, found=replace(found.found, board=board)).strengths("cohesion")
    # Weights are a little others, and with them which draws are taken: two of 2000.
    assert np.std(drawn) == pytest.approx(FACTOR * np.std(measured), rel=0.02)


@pytest.mark.parametrize("seed", range(2))
def test_nothing_hidden_names_nothing(seed):
    verdict = _found(seed).verdict
    assert verdict.kind in ("none", "unknown")
    assert verdict.names == ()
    assert verdict.answers.none > 0.3


def test_a_strong_cause_is_named_or_in_the_set():
    for name, found in (("tilt", _found(0, tilt=3.0)), ("cohesion", _strong())):
        assert found.verdict.kind in ("named", "set")
        assert name in found.verdict.names


def test_a_shift_outside_the_library_is_unknown_and_located():
    rng = np.random.default_rng(5)
    shift = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 12.0])
    verdict = diagnose(study({}, rng, shift), rng, options=QUICK).verdict
    assert verdict.kind == "unknown"
    assert next(iter(verdict.answers.where)) in {f"unknown at y{k}" for k in (4, 5, 6)}


def test_a_cause_that_parameters_imitate_gets_no_credit():
    found = _found(0)
    row = found.visibility.of("wear")
    assert row.absorbed > 0.9
    assert row.bias["p1"] == pytest.approx(0.05, abs=0.01)
    assert found.log_ratio("wear") < 1.0


def test_the_strength_lies_in_its_interval_and_the_held_out_test_claims_the_gain():
    found = _strong()
    span = found.interval("cohesion")
    assert span.low < 50.0 < span.high
    # Few strengths are as large before the data; what is told of one that acts is what they say.
    assert found.strength("cohesion") > np.median(found.samples(("cohesion",))[1])
    assert found.gains[0].candidates == ("cohesion",)
    assert found.gains[0].claimed
    before = {one.name: one.z_left_out for one in found.residuals}
    after = {one.name: one.z_left_out for one in found.after}
    assert sum(z**2 for z in after.values()) < sum(z**2 for z in before.values())


def test_sentences_begin_with_the_verdict_and_end_with_the_next_measurement():
    found = _strong()
    said = sentences(found)
    assert said[0] == headline(found)
    assert "cohesion" in said[0]
    assert "a shear cell" in said[-1]
    assert len(diagnosis_figure(diagnosis_record(found)).axes) == 3
    assert set(found.table().index) == {"tilt", "flow", "cohesion", "wear"}
    assert found.residual_table().shape[0] == 7
