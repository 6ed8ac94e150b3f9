"""A new experiment or effect is one entry of its registry: nothing in calibrate lists them."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibrate.causes.studies.from_study import candidates_of, with_effects
from calibrate.errors import CalibrationError, StudyError
from calibrate.questions.core.from_study import forms_of
from calibrate.report.drawing import SYMBOLS, WORDS
from calibrate.study.cases import case_spec, middle
from calibrate.study.data import StudyData, load_data
from calibrate.study.load import load_study
from calibrate.study.places import Place
from calibrate.study.write import study_text
from liggghts_io import CaseResult, read_curve
from liggghts_io.case.results import store_tables
from liggghts_io.effects import EFFECTS
from liggghts_io.experiments import EXPERIMENTS, Curve
from liggghts_io.materials import CONTACT_PARAMETERS
from tests.paths import CASES

STUDY = CASES / "hsp13_steel.toml"
HSP13 = "Carbo HSP13"
PUBLISHED = {
    "mu_pp": 0.694, "mu_roll_pp": 0.0856, "mu_pw": 0.307,
    "mu_roll_pw": 0.274, "e_pp": 0.742, "e_pw": 0.439,
}  # fmt: skip


@pytest.fixture
def written(tmp_path: Path):
    """Return a function that writes the bundled study with a word replaced and tables added."""
    for csv in STUDY.parent.glob("*.csv"):
        (tmp_path / csv.name).write_bytes(csv.read_bytes())

    def write(old: str = "", new: str = "", more: str = "") -> Path:
        text = study_text(load_study(STUDY))
        assert old in text
        path = tmp_path / "study.toml"
        path.write_text(text.replace(old, new) + more, encoding="utf-8")
        return path

    return write


CURVE = Curve(
    "start", "N m", "torque of the drive", "time", "s", (2.0, 5.0), "start.csv", "t", "torque"
)


@pytest.fixture
def mound(monkeypatch: pytest.MonkeyPatch):
    """Register an experiment that nobody here knows: a mound, which is a heap."""
    one = replace(
        EXPERIMENTS["heap"], name="mound", title="Mound of grains", caption="Mound", curves=(CURVE,)
    )
    monkeypatch.setitem(EXPERIMENTS, "mound", one)
    return one


def test_a_new_experiment_needs_no_edit_in_calibrate(mound, written, tmp_path: Path) -> None:
    more = '\n[[experiment]]\nname = "mound"\napparatus = { pour_grains = 100.0 }\n'
    data: StudyData = load_data(written('experiment = "heap"', 'experiment = "mound"', more))
    forms = forms_of(data)
    assert {("mound", "glued"), ("mound", "flat")} <= set(forms)
    spec = case_spec(data.study, Place(HSP13, "steel", "mound"), middle(data.study), 1)
    assert spec.apparatus == {"pour_grains": 100.0}
    curve = {"t": np.array([0.0, 10.0]), "torque": np.array([0.0, 100.0])}
    tables = store_tables(tmp_path, {CURVE.file: curve})
    result = CaseResult("", tmp_path, "ok", "", {}, 1.0, tables=tables)
    assert read_curve(result, replace(CURVE, levels=(5.0,))) == pytest.approx([50.0])


def test_the_command_takes_a_new_experiment(mound, bulkcal, tmp_path: Path) -> None:
    pairs = [word for k, v in PUBLISHED.items() for word in ("-p", f"{k}={v}")]
    code, _, err = bulkcal("generate", "mound", *pairs, "--out", str(tmp_path / "case"))
    assert code == 0, err
    assert (tmp_path / "case" / "in.script").is_file()


def test_a_new_effect_is_a_candidate_and_may_act_in_one_apparatus_alone(
    monkeypatch: pytest.MonkeyPatch, written
) -> None:
    humid = replace(EFFECTS["cohesion_J_m3"], name="humidity", title="Humid air", scope="funnel")
    monkeypatch.setitem(EFFECTS, "humidity", humid)
    path = written(more="\n[known.humidity]\nse = 100.0\n")
    data = load_data(path)
    found = candidates_of(data.study, forms_of(with_effects(data)))
    names = {one.name for one in found if one.effect == "humidity"}
    kinds = data.study.layout.kinds
    funnels = {f"{place.experiment}_{kinds[place.surface]}" for place in data.study.places}
    assert names == {"humidity", *(f"humidity:{funnel}" for funnel in funnels)}


def test_an_effect_that_is_no_candidate_is_not_considered(
    monkeypatch: pytest.MonkeyPatch, written
) -> None:
    quiet = replace(EFFECTS["cohesion_J_m3"], candidate=False)
    monkeypatch.setitem(EFFECTS, "cohesion_J_m3", quiet)
    data = load_data(written())
    found = candidates_of(data.study, forms_of(with_effects(data)))
    assert "cohesion_J_m3" not in {one.effect for one in found}


UNKNOWN = {
    "experiment": ('experiment = "heap"', 'experiment = "heep"', "'heep'; did you mean 'heap'?"),
    "surface": ('surface = "steel"', 'surface = "steal"', "'steal'; did you mean 'steel'?"),
    "engine": ("seed = 2019", 'seed = 2019\nengine = "minidemm"', "'minidemm'; did you mean 'min"),
    "effect": ("", "\n[effects]\nplate_tilt = 1.0\n", "effects: unknown name 'plate_tilt'; did"),
    "known": ("", "\n[known.plate_tilt]\nse = 0.1\n", "unknown parameter 'plate_tilt'; did you"),
    "apparatus": ("", '\n[[experiment]]\nname = "heep"\n', "experiment: unknown name 'heep'"),
}


@pytest.mark.parametrize("what", UNKNOWN)
def test_an_unknown_name_is_refused_with_the_nearest(what: str, written) -> None:
    old, new, words = UNKNOWN[what]
    path = written(old, new) if old else written(more=new)
    with pytest.raises(StudyError) as caught:
        load_study(path)
    assert all(re.match(rf"{re.escape(str(path))}:\d+: ", m) for m in caught.value.mistakes)
    assert words in str(caught.value)


def test_a_curve_belongs_to_an_experiment_that_writes_one(written) -> None:
    curve = """
[[target]]
name = "c"
material = "Carbo HSP13"
surface = "steel"
experiment = "heap"
observable = "mass_time"
file = "conveyor.csv"
x_column = "time_s"
column = "mass_g"
se_column = "sem_g"
"""
    with pytest.raises(
        CalibrationError, match=r"heap: unknown observable 'mass_time'; known names"
    ):
        load_study(written(more=curve))


def test_every_contact_parameter_has_a_symbol_and_words() -> None:
    assert set(SYMBOLS) == set(WORDS) == set(CONTACT_PARAMETERS)
