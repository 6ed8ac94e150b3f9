"""Stages that free one, three and more parameters, and stages whose target is a curve."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibrate.report.figures import stage_figure
from calibrate.staged.earlier import Earlier
from calibrate.staged.posterior.cloud import CloudPosterior
from calibrate.staged.posterior.grid import GridPosterior
from calibrate.staged.stages import run_stage
from calibrate.study.data import load_data
from calibrate.study.measured.curves import MeasuredCurve
from calibrate.study.measured.scalars import Measured
from calibrate.study.resources import bundled_study
from calibrate.study.schema.targets import Target
from tests.calibrate import stand_in

TRUTH = {"mu_pp": 0.5, "mu_roll_pp": 0.25, "mu_pw": 0.3, "e_pw": 0.6, "e_pp": 0.6,
         "mu_roll_pw": 0.2}  # fmt: skip
SE = {"deg": 0.5, "s": 0.1, "g": 0.1}
LEVELS = (25.0, 50.0, 100.0)
PNG = b"\x89PNG"


def asked(free, targets, *, points=12, infill=0, values=TRUTH):
    """Return the bundled study with one stage; what is not free has its true value."""
    data = load_data(bundled_study())
    stage = data.study.stages[0].model_copy(
        update={"free": free, "targets": targets, "points": points, "infill": infill}
    )
    parameters = {
        name: one.model_copy(update={"value": {"": values[name]}})
        for name, one in data.study.parameters.items()
    }
    study = data.study.model_copy(update={"stages": [stage], "parameters": parameters})
    scalars = {}
    for target in study.targets:
        spec = stand_in.CaseSpec(target.experiment, study.materials[0].particle, target.surface,
                                 "quick", values, seed=1)  # fmt: skip
        value = stand_in.means(spec)[target.observable]
        scalars[target.name] = Measured(value, SE[target.unit], 5)
    return replace(data, study=study, scalars=scalars)


def holds_truth(result) -> bool:
    return all(
        result.intervals[name][0.95].low <= TRUTH[name] <= result.intervals[name][0.95].high
        and result.intervals[name][0.68].low <= value <= result.intervals[name][0.68].high
        for name, value in result.found.items()
    )


@pytest.mark.parametrize("infill", [0, 1])
def test_a_stage_frees_one_parameter(runner, infill):
    data = asked(["mu_roll_pp"], ["angle_glued"], points=8, infill=infill)
    result = run_stage(data, 0, Earlier(), runner)
    assert isinstance(result.posterior, GridPosterior)
    assert result.posterior.density.shape == (121,)
    assert holds_truth(result)
    assert result.verdict.status == "crossing"
    assert len(result.planned) == 8 + 4 + infill
    assert stage_figure(result).startswith(PNG)


def test_one_parameter_out_of_reach_and_two_targets_that_contradict(runner):
    data = asked(["mu_pp"], ["angle_glued", "t100_glued"], points=8)
    far = replace(data, scalars={**data.scalars, "angle_glued": Measured(70.0, 0.3, 5)})
    assert run_stage(far, 0, Earlier(), runner).verdict.status == "out_of_reach"
    # The angle of mu_pp = 0.2 and the time of mu_pp = 0.7.
    wrong = {"angle_glued": Measured(31.7, 0.3, 30), "t100_glued": Measured(19.2, 0.1, 30)}
    result = run_stage(replace(data, scalars=data.scalars | wrong), 0, Earlier(), runner)
    assert not result.verdict.is_point
    assert stage_figure(result).startswith(PNG)


@pytest.mark.long
def test_a_stage_frees_three_parameters(runner):
    targets = ["angle_glued", "t100_glued", "angle_steel"]
    data = asked(["mu_pp", "mu_roll_pp", "mu_pw"], targets, points=24)
    result = run_stage(data, 0, Earlier(), runner)
    assert isinstance(result.posterior, CloudPosterior)
    assert holds_truth(result)
    draws = result.samples(200, np.random.default_rng(1))
    assert draws.shape == (200, 3)
    low, high = result.freed.bounds.T
    assert ((draws >= low) & (draws <= high)).all()
    assert stage_figure(result).startswith(PNG)
    again = run_stage(data, 0, Earlier(), runner)
    assert again.found == result.found


def read(spec, path: Path, name: str, levels):
    """Stand in for a curve of the conveyor: the time of 100 g, less for less."""
    del path, name
    end = stand_in.simulate(spec)["t100_s"]
    return end * np.array([0.4 + 0.6 * level / 100.0 for level in levels])


def with_curve(data, end: float):
    """Return a study whose conveyor time is a measured curve that ends at a time."""
    old = data.study.target_named("t100_glued")
    given = old.model_dump(exclude_unset=True) | {
        "observable": "mass_time", "x_column": "x", "levels": list(LEVELS),
    }  # fmt: skip
    new = Target.model_validate(given)
    targets = [new if t.name == new.name else t for t in data.study.targets]
    study = data.study.model_copy(update={"targets": targets})
    values = end * np.array([0.4 + 0.6 * level / 100.0 for level in LEVELS])
    curve = MeasuredCurve(np.array(LEVELS), values, 0.01 * values, 5, "planted")
    scalars = {name: one for name, one in data.scalars.items() if name != "t100_glued"}
    return replace(data, study=study, scalars=scalars, curves={"t100_glued": curve})


def test_a_target_may_be_a_curve(runner):
    data = asked(["mu_pp", "mu_roll_pp"], ["angle_glued", "t100_glued"])
    curved = with_curve(data, data.scalars["t100_glued"].value)
    result = run_stage(curved, 0, Earlier(), runner, read)
    number, curve = (run_stage(data, 0, Earlier(), runner).fits[1], result.fits[1])
    assert curve.surrogate.predict.__self__.components.basis.shape[0] == len(LEVELS)
    # All levels of this curve are shares of its end: their geometric mean is 0.55 times it.
    share = float(np.prod([0.4 + 0.6 * level / 100.0 for level in LEVELS]) ** (1 / 3))
    assert curve.predicted == pytest.approx(share * number.predicted, rel=0.03)
    assert holds_truth(result)
    assert stage_figure(result).startswith(PNG)
