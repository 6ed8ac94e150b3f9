"""One scale per observable, for stages and the joint questions alike."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibrate.causes.studies.from_study import scales_of
from calibrate.questions.core.design import first_cases
from calibrate.questions.core.emulate import training_arrays
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.problem import reading_of, space_of
from calibrate.questions.core.runs import Runs
from calibrate.runs.campaign import run_table
from calibrate.scales import backward, forward, scale_of, slope
from calibrate.staged.earlier import Earlier
from calibrate.staged.result import StageResult
from calibrate.staged.stages import run_stage
from calibrate.study.data import StudyData, load_data
from liggghts_io import CaseResult
from tests.paths import CASES

STUDY = CASES / "hsp13_steel.toml"


@pytest.mark.parametrize(("scale", "value"), [("log", 12.0), ("sqrt", 30.0), ("linear", 35.0)])
def test_slope_is_the_derivative_and_backward_the_inverse(scale: str, value: float) -> None:
    h = 1e-6 * value
    up, down = forward(scale, np.array(value + h)), forward(scale, np.array(value - h))
    # Central difference, error of order h^2 times the third derivative.
    assert slope(scale, value) == pytest.approx(float(up - down) / (2 * h), rel=1e-6)
    assert float(backward(scale, forward(scale, np.array(value)))) == pytest.approx(value)


def test_impossible_values_have_no_place_and_an_almost_empty_box_a_finite_slope() -> None:
    assert np.isnan(forward("log", np.array([0.0, -1.0]))).all()
    assert np.isnan(forward("sqrt", np.array(-1.0)))
    assert forward("sqrt", np.array(0.0)) == 0.0
    assert slope("sqrt", 0.0) == slope("sqrt", 0.01) == pytest.approx(5.0)


def test_the_unit_decides_where_the_study_says_nothing() -> None:
    study = load_data(STUDY).study
    for target in study.targets:
        silent = target.model_copy(update={"scale": None})
        assert silent.model_scale == scale_of(target.unit) == target.model_scale
        assert target.model_copy(update={"scale": "linear"}).model_scale == "linear"


def with_scale(scale: str) -> StudyData:
    """Return the bundled study with the conveyor's times on another scale."""
    data = load_data(STUDY)
    targets = [
        t.model_copy(update={"scale": scale}) if t.observable == "t100_s" else t
        for t in data.study.targets
    ]
    stage = data.study.stages[0].model_copy(update={"infill": 0})
    changes = {"targets": targets, "stages": [stage, *data.study.stages[1:]]}
    return replace(data, study=data.study.model_copy(update=changes))


def staged(data: StudyData, runner) -> StageResult:
    return run_stage(data, 0, Earlier(), runner)


def test_the_scale_of_a_target_rules_stages_and_the_common_problem(runner) -> None:
    predicted = {}
    for scale in ("log", "linear"):
        data = with_scale(scale)
        fit = staged(data, runner).fits[1]
        assert fit.target.observable == "t100_s"
        seconds = backward(scale, fit.surrogate.quality.observed)
        assert 5.0 < seconds.min() < seconds.max() < 40.0  # as the stand-in gives them
        predicted[scale] = fit.predicted
        reading = reading_of(data, fit.target, slice(0, 1), space_of(data.study))
        assert reading.y == forward(scale, np.array(data.scalars["t100_glued"].value))
        assert scales_of(data.study)["t100_glued"] == scale
    assert abs(predicted["log"] - predicted["linear"]) > 1e-6


def test_a_simulated_value_off_the_scale_is_a_run_without_a_number() -> None:
    """A run with an empty box has no logarithm."""
    data = load_data(STUDY)
    targets = [
        t.model_copy(update={"scale": "log"}) if t.observable == "m4_g" else t
        for t in data.study.targets
    ]
    data = replace(data, study=data.study.model_copy(update={"targets": targets}))
    forms = forms_of(data)
    specs = [s for s in first_cases(data.study, forms, np.random.default_rng(1))
             if s.experiment == "plate_impact"][:2]  # fmt: skip
    boxes = {f"m{k}_g": 1.0 for k in range(1, 4)}
    results = [CaseResult("", Path(), "ok", "", {**boxes, "m4_g": m4}, 1.0) for m4 in (0.0, 0.5)]
    key = ("plate_impact", "flat")
    _, y = training_arrays(forms[key], Runs(tuple(specs), run_table(specs, results)))
    column = forms[key].output("m4_g", "log").columns.start
    assert np.isfinite(y[:, column]).tolist() == [False, True]
