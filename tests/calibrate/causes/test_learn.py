"""What causes do is learnt from twins, and of instruments from finished runs."""

from __future__ import annotations

import numpy as np
import pytest

from calibrate.causes.studies.from_study import with_effects
from calibrate.causes.studies.learn import learn_effects
from calibrate.causes.studies.twins import TWINS, twin_cases
from calibrate.emulator.types import Inputs
from calibrate.questions.core.emulate import emulators_of
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.runs import make_runs
from liggghts_io.effects import EFFECTS
from tests.calibrate.causes import studies


@pytest.fixture(scope="module")
def learnt(tmp_path_factory):
    """Learn two causes of the conveyor on the formulas, and the clock."""
    data = studies.study(tmp_path_factory.mktemp("learn"), {}, 3)
    base = studies.base_runs(data)
    wider = forms_of(with_effects(data))
    names = ["plate_tilt_deg", "mass_flow_factor"]
    specs = twin_cases(wider, base, EFFECTS, names, TWINS)
    runs = make_runs([*base.specs, *specs], "", studies.run, wider)
    forms = forms_of(data)
    emulators = emulators_of(forms, runs.where([not s.effects for s in runs.specs]))
    return wider, learn_effects(emulators, wider, runs, EFFECTS)


def _change(learnt, surface: str, effect: str, strength: float) -> float:
    """Return what an effect changes of ln t100 in the middle of the ranges."""
    wider, wide = learnt
    key = next(k for k in wider if k[0] == "conveyor" and k[1] == surface)
    form = wider[key]
    column = next(k for k, one in enumerate(form.switches) if one.name == effect)
    u = np.full((1, len(form.axes)), 0.5)
    none = np.zeros((1, len(form.switches)))
    on = none.copy()
    on[0, column] = strength / form.switches[column].step
    at = next(one.columns for one in form.outputs if one.name == "t100_s")
    found = [wide[key].predict(Inputs.at(u, x)).mean[0, at] for x in (on, none)]
    return float(found[0][0] - found[1][0])


@pytest.mark.parametrize(
    ("surface", "effect", "strength", "change"),
    [
        ("flat", "plate_tilt_deg", 2.0, -0.1),
        ("flat", "plate_tilt_deg", -2.0, 0.1),
        ("glued", "plate_tilt_deg", 2.0, -0.04),
        ("flat", "mass_flow_factor", 0.1, -0.1),
    ],
)
def test_twins_of_one_seed_tell_what_a_cause_does(learnt, surface, effect, strength, change):
    # The luck of a run cancels between twins, so little is lost to it.
    assert _change(learnt, surface, effect, strength) == pytest.approx(change, abs=0.01)


def test_a_clock_is_learnt_without_any_run(learnt):
    assert _change(learnt, "flat", "clock_factor", 0.05) == pytest.approx(np.log(1.05), abs=1e-3)


def test_what_had_no_twins_adds_nothing(learnt):
    assert _change(learnt, "flat", "plate_period", 0.1) == 0.0
