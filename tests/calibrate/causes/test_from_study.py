"""From the bundled study of HSP13 to candidates and effect twins."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from calibrate.causes.studies.from_study import candidates_of, considered, with_effects
from calibrate.causes.studies.twins import SCREENED, TWINS, twin_cases
from calibrate.questions.core.design import first_cases
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.runs import Runs
from calibrate.study.data import load_data
from liggghts_io.case.spec import script_of
from liggghts_io.effects import EFFECTS
from tests.paths import ROOT

STUDIES = [
    *sorted(ROOT.glob("cases/proppants/*.toml")),
    *sorted(ROOT.glob("cases/hidden/*.toml")),
    *sorted(ROOT.glob("cases/*/study.toml")),
    ROOT / "cases" / "challenge" / "one_material.toml",
    ROOT / "cases" / "challenge" / "two_materials.toml",
]


@pytest.fixture(scope="module")
def data():
    return load_data(ROOT / "cases" / "proppants" / "hsp13_steel.toml")


def test_all_effects_are_considered_each_where_it_acts(data):
    forms = forms_of(with_effects(data))
    found = {one.name: one for one in candidates_of(data.study, forms)}
    # Its grains have measured sizes.
    assert {one.effect for one in found.values()} == set(EFFECTS) - {"size_distribution"}
    assert {"mass_flow_factor:conveyor_flat", "mass_flow_factor:conveyor_glued"} <= set(found)
    places = data.study.places
    tilted = [places[k].experiment for k, _ in found["plate_tilt_deg"].acts]
    assert tilted == ["conveyor", "conveyor"]
    assert len(found["cohesion_J_m3"].acts) == len(places)
    assert found["torsion"].switch
    walls = {name for name in found if name.startswith("wall_adhesion_J_m3")}
    assert walls == {"wall_adhesion_J_m3", *(f"wall_adhesion_J_m3:{w}" for w in ("steel", "glued"))}
    assert (found["cohesion_J_m3"].low, found["cohesion_J_m3"].high) == (0.0, 90_000.0)


def test_a_spread_of_sizes_is_a_candidate_for_grains_of_one_diameter(data):
    (material,) = data.study.materials
    one = material.model_copy(update={"sizes": "one"})
    study = data.study.model_copy(update={"materials": (one,)})
    assert "size_distribution" in [one.name for one in considered(study)]


def test_an_effect_that_the_study_has_is_no_candidate(data):
    study = data.study.model_copy(update={"effects": {"plate_tilt_deg": 0.5}})
    assert "plate_tilt_deg" not in [one.name for one in considered(study)]


def test_liggghts_is_not_asked_for_what_it_does_not_have(data):
    run = data.study.run.model_copy(update={"engine": "liggghts"})
    study = data.study.model_copy(update={"run": run})
    assert not [one.name for one in considered(study) if one.extension]


@pytest.mark.parametrize("path", STUDIES, ids=lambda path: f"{path.parent.name}_{path.stem}")
def test_every_cause_of_a_ready_study_has_a_script(path):
    # Sizes that a study leaves open once made the spread of sizes a candidate that could not run.
    data = load_data(path)
    specs = first_cases(data.study, forms_of(data), np.random.default_rng(1))
    base = Runs(tuple(specs), pd.DataFrame({"status": ["ok"] * len(specs)}))
    names = [effect.name for effect in considered(data.study) if effect.needs_runs]
    effects = data.study.layout.effects
    twins = twin_cases(forms_of(with_effects(data)), base, effects, names, 2)
    assert {name for spec in twins for name in spec.effects} >= set(names)
    for spec in twins:
        assert script_of(spec)


def test_twins_differ_from_a_run_by_one_effect_only(data):
    forms = forms_of(with_effects(data))
    specs = first_cases(data.study, forms_of(data), np.random.default_rng(1))
    runs = Runs(tuple(specs), pd.DataFrame({"status": ["ok"] * len(specs)}))
    names = tuple(one.name for one in considered(data.study))
    twins = twin_cases(forms, runs, EFFECTS, names, TWINS)
    few = twin_cases(forms, runs, EFFECTS, names, SCREENED)
    assert {repr(one) for one in few} < {repr(one) for one in twins}
    known = {(s.experiment, s.surface, s.seed, tuple(s.parameters.items())) for s in specs}
    assert all(
        (s.experiment, s.surface, s.seed, tuple(s.parameters.items())) in known for s in twins
    )
    assert all(len(s.effects) == 1 for s in twins)
    # What an instrument shows wrongly costs no run.
    assert not {name for s in twins for name in s.effects if not EFFECTS[name].needs_runs}
    tilts = [s.effects["plate_tilt_deg"] for s in twins if "plate_tilt_deg" in s.effects]
    assert min(tilts) < 0.0 < max(tilts)
