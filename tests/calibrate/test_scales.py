"""One scale per observable, for stages and diagnosis alike."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibrate.diagnose import Diagnosis, diagnose
from calibrate.diagnose.from_study import problem_of
from calibrate.diagnose.local.pool import Pool
from calibrate.scales import backward, forward, scale_of, slope
from calibrate.staged.earlier import Earlier
from calibrate.staged.result import StageResult
from calibrate.staged.stages import run_stage
from calibrate.study.data import StudyData, load_data
from liggghts_io import CaseResult
from tests.calibrate.diagnose import engine as recorded

STUDY = recorded.CASES / "hsp13_steel.toml"


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
    return recorded.changed(data, targets=targets, stages=[stage, *data.study.stages[1:]])


def staged(data: StudyData, runner) -> StageResult:
    return run_stage(data, 0, Earlier(), runner)


def diagnosed(data: StudyData) -> Diagnosis:
    """Diagnose with the recorded runs of the engine."""
    problem = problem_of(data, recorded.PUBLISHED)
    runner = recorded.Recorded(recorded.read_runs())
    rng = np.random.default_rng(1)
    return diagnose(problem, runner, rng=rng, options=recorded.OPTIONS)


def test_the_scale_of_a_target_rules_stages_and_diagnosis(runner) -> None:
    predicted, simulated = {}, {}
    for scale in ("log", "linear"):
        data = with_scale(scale)
        fit = staged(data, runner).fits[1]
        assert fit.target.observable == "t100_s"
        seconds = backward(scale, fit.surrogate.quality.observed)
        assert 5.0 < seconds.min() < seconds.max() < 40.0  # as the stand-in gives them
        predicted[scale] = fit.predicted
        found = diagnosed(data)
        names = [row.name for row in found.residuals]
        k = names.index("conveyor_steel.t100_s")
        on_scale = forward(scale, np.array(data.scalars["t100_steel"].value))
        assert found.local.stack.y[k] == on_scale
        simulated[scale] = found.residuals[k].simulated
    assert abs(predicted["log"] - predicted["linear"]) > 1e-6
    assert abs(simulated["log"] - simulated["linear"]) > 1e-6


def test_a_simulated_value_off_the_scale_is_a_failed_run() -> None:
    """A run with an empty box has no logarithm."""
    data = load_data(STUDY)
    problem = problem_of(data, recorded.PUBLISHED)
    observables = tuple(
        replace(o, scale="log") if o.quantity == "m4_g" else o for o in problem.observables
    )
    boxes = {f"m{k}_g": 1.0 for k in range(1, 4)} | {"m4_g": 0.0}

    def runner(specs):
        shown = {**boxes, "angle_deg": 30.0, "t100_s": 10.0}
        return [CaseResult("", Path(), "ok", "", shown, 1.0) for _ in specs]

    pool = Pool(replace(problem, observables=observables), runner)
    pool.infill(problem.start, recorded.OPTIONS.design)
    assert set(pool.failed) == {
        "plate_impact_steel: m4_g = 0 has no place on the scale 'log'",
    }
    assert pool.outputs["heap_steel"][0] is not None
