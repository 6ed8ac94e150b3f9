"""Instances, values and ties of studies with several materials and walls."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from calibrate.errors import CalibrationError
from calibrate.questions.core.design import first_cases, joint_rng
from calibrate.questions.core.from_study import forms_of
from calibrate.study.cases import case_spec, middle
from calibrate.study.data import load_data
from calibrate.study.load import load_study
from calibrate.study.model import Study
from calibrate.study.places import Place
from calibrate.study.resources import bundled_study, cases_directory
from tests.calibrate.study.two import FREE, TARGETS, TWO


@pytest.fixture
def study(tmp_path: Path):
    """Return a function that loads the study of two materials with words replaced or added."""

    def load(old: str = "", new: str = "", more: str = "") -> Study:
        text = TWO + TARGETS + FREE
        assert old in text
        path = tmp_path / "two.toml"
        path.write_text(text.replace(old, new, 1) + more, encoding="utf-8")
        return load_study(path)

    return load


def test_scopes_follow_from_names(study):
    one = study(more='\n[parameter."conveyor.period_s"]\nrange = [0.07, 0.09]\n'
                     "\n[parameter.timestep_fraction]\nvalue = 0.1\n"
                     "\n[parameter.youngs_modulus_pa]\nrange = [5e6, 2e7]\n"
                     "\n[parameter.plate_tilt_deg]\nrange = [-1, 1]\n"
                     "\n[parameter.mass_flow_factor]\nrange = [-0.1, 0.1]\n")  # fmt: skip
    assert one.instances("mu_pp") == ("coarse", "fine")
    assert one.instances("e_pw") == ("coarse/steel", "coarse/brass", "fine/steel")
    assert one.instances("conveyor.period_s") == ("conveyor",)
    assert one.instances("timestep_fraction") == ("",)  # heap and conveyor have it, and share it
    assert one.instances("youngs_modulus_pa") == ("coarse", "fine")
    assert one.instances("plate_tilt_deg") == ("",)
    assert one.instances("mass_flow_factor") == ("conveyor",)  # the effect, which says so
    assert one.label("mu_pp", "fine") == "mu_pp fine"
    assert one.label("plate_tilt_deg", "") == "plate_tilt_deg"
    assert len(one.free) == 3 * 2 + 3 * 3 + 1 + 2 + 1 + 1


@pytest.mark.parametrize(
    ("scope", "expected"),
    [
        ("material", ("coarse", "fine")), ("surface", ("steel", "brass")),
        ("material+surface", ("coarse/steel", "coarse/brass", "fine/steel")), ("global", ("",)),
    ],
)  # fmt: skip
def test_a_scope_may_be_given(study, scope: str, expected: tuple[str, ...]):
    one = study("[parameter.mu_pw]\n", f'[parameter.mu_pw]\nscope = "{scope}"\n')
    assert one.instances("mu_pw") == expected


def test_a_number_of_a_material_may_differ_between_experiments(study):
    one = study(
        more="""
[parameter.coarse_graining]
scope = "material+apparatus"
value = { "fine/conveyor" = 1.005 }
"""
    )
    assert one.value_of("coarse_graining", "fine", "steel", "conveyor") == 1.005
    assert one.value_of("coarse_graining", "fine", "steel", "heap") == 1.0
    case = case_spec(one, Place("fine", "steel", "conveyor"), middle(one), 1)
    assert case.particle.coarse_graining == 1.005
    assert (
        case_spec(one, Place("fine", "steel", "heap"), middle(one), 1).particle.coarse_graining
        == 1.0
    )
    with pytest.raises(CalibrationError, match="'material\\+apparatus' is for apparatus, effects"):
        study("[parameter.mu_pp]\n", '[parameter.mu_pp]\nscope = "material+apparatus"\n')


def test_coarse_grains_in_one_experiment_need_their_restitution_there(study):
    more = """
[parameter.coarse_graining]
scope = "material+apparatus"
value = { "fine/conveyor" = 3.0 }
"""
    with pytest.raises(CalibrationError, match=r"material 'fine'.*e_pp"):
        study(more=more)


def test_ties_hold_together_what_differs_in_one_thing_only(study):
    one = study("[parameter.mu_pw]\n", '[parameter.mu_pw]\ntie = "material"\n')
    assert one.ties("mu_pw") == (("coarse/steel", "fine/steel"),)  # brass knows one material
    one = study("[parameter.mu_pw]\n", '[parameter.mu_pw]\ntie = "surface"\n')
    assert one.ties("mu_pw") == (("coarse/steel", "coarse/brass"),)
    assert one.ties("mu_pp") == ()


def test_values_by_instance_and_defaults(study):
    more = """
[parameter.poisson_ratio]
value = { fine = 0.2 }

[parameter.period_s]
value = 0.07

[effects]
plate_tilt_deg = 0.5
"""
    value = 'value = { "coarse/steel" = 0.3, "fine/steel" = 0.4 }\n'
    one = study("[parameter.mu_pw]\n", f"[parameter.mu_pw]\n{value}", more)
    assert one.value_of("mu_pw", "coarse", "steel", "heap") == 0.3
    assert one.value_of("mu_pw", "coarse", "brass", "heap") is None
    assert one.value_of("poisson_ratio", "fine", "steel", "heap") == 0.2
    assert one.value_of("poisson_ratio", "coarse", "steel", "heap") == 0.3  # the usual one
    assert one.value_of("period_s", "fine", "steel", "conveyor") == 0.07
    assert one.value_of("conveyor.amplitude_m", "fine", "steel", "conveyor") == 0.002
    assert one.value_of("plate_tilt_deg", "fine", "steel", "conveyor") == 0.5
    with pytest.raises(CalibrationError, match="unknown parameter 'mu_pq'; did you mean 'mu_p"):
        one.value_of("mu_pq", "fine", "steel", "heap")


def test_a_case_takes_what_matters_at_its_place(study):
    more = """
[parameter.youngs_modulus_pa]
range = [5e6, 2e7]

[parameter."conveyor.period_s"]
range = [0.07, 0.09]

[parameter.plate_tilt_deg]
range = [-1.0, 1.0]

[[experiment]]
name = "conveyor"
apparatus = { pour_depth_d = 6.0 }
"""
    one = study(more=more)
    values = middle(one) | {
        ("mu_pw", "fine/steel"): 0.123, ("youngs_modulus_pa", "fine"): 8e6,
        ("conveyor.period_s", "conveyor"): 0.085, ("plate_tilt_deg", ""): 0.7,
    }  # fmt: skip
    fine = case_spec(one, Place("fine", "steel", "conveyor"), values, 7)
    assert fine.parameters["mu_pw"] == 0.123
    assert fine.particle.d32_m == pytest.approx(800e-6)
    assert fine.particle.youngs_modulus == 8e6
    assert fine.apparatus == {"pour_depth_d": 6.0, "period_s": 0.085}
    assert (dict(fine.effects), fine.seed) == ({"plate_tilt_deg": 0.7}, 7)
    heap = case_spec(one, Place("coarse", "brass", "heap"), values, 7)
    assert heap.parameters["mu_pw"] == pytest.approx(0.45)
    assert (dict(heap.apparatus), dict(heap.effects)) == ({}, {})
    assert heap.particle.youngs_modulus == pytest.approx(1.25e7)


def test_flat_walls_of_any_name_are_one_kind(study):
    one = study()
    specs = [
        case_spec(one, Place("coarse", wall, "heap"), middle(one), 1) for wall in ("steel", "brass")
    ]
    assert specs[0] == specs[1]


def test_a_glued_wall_needs_no_values_of_the_wall():
    study = load_study(bundled_study())
    place = Place("Carbo HSP13", "glued", "heap")
    assert set(case_spec(study, place, middle(study), 1).parameters) == {
        "mu_pp", "mu_roll_pp", "e_pp",
    }  # fmt: skip


def test_the_joint_study_of_five_proppants_holds_all_tables():
    data = load_data(cases_directory() / "proppants" / "proppants.toml")
    study = data.study
    assert len(study.materials) == 5
    assert {surface.name: surface.kind for surface in study.surfaces} == {
        "steel": "flat", "alumina": "flat", "glued": "glued",
    }  # fmt: skip
    # Angles and times of five materials on three plates, six rows of four boxes.
    assert len(data.scalars) == 15 + 15 + 6 * 4
    assert data.scalars["angle_HSP16_30_alumina"].value == 40.36  # Table B.4
    # What is fixed for one material stays so in the design that all share.
    specs = first_cases(study, forms_of(data), joint_rng(study))
    fine = [one for one in specs if one.particle.name == "Carbo HSP30/60"]
    assert {one.apparatus["width_fraction"] for one in fine if one.experiment == "conveyor"} == {
        0.0621
    }
    # Fewer points of materials that cost more.
    counts = [sum(one.particle.name == name for one in specs)
              for name in ("Carbo HSP13", "Carbo HSP30/60")]  # fmt: skip
    assert counts == [5 * (24 + 3), 5 * (6 + 1)]
    assert len(study.ties("mu_pw")) == 2
    assert len(study.ties("mu_pw")[0]) == 5
    assert study.published_of("mu_pw", "HSP13/alumina") == 0.375  # Table B.7
    assert load_study(bundled_study()).ties("mu_pw") == ()


def test_what_one_material_has_of_its_own_stays_in_the_design_that_all_share(tmp_path: Path):
    """Coarse grains of the finest, in one experiment, and the restitution that they can have."""
    folder = shutil.copytree(cases_directory() / "proppants", tmp_path / "proppants")
    path = folder / "proppants.toml"
    text = path.read_text(encoding="utf-8")
    shared = '[parameter.e_pp]\nrange = [0.2, 0.9]\ntie = "material"\n'
    assert shared in text
    names = ("HSP13", "SG10H", "HSP16-30", "HSP20-40")
    others = ", ".join(f"{name} = [0.2, 0.9]" for name in names)
    own = f"[parameter.e_pp]\nrange = {{ {others}, HSP30-60 = [0.53, 0.9] }}\n"
    coarse = 'scope = "material+apparatus"\nvalue = { "HSP30-60/conveyor" = 1.37 }\n'
    path.write_text(f"{text.replace(shared, own)}\n[parameter.coarse_graining]\n{coarse}")
    data = load_data(path)
    specs = first_cases(data.study, forms_of(data), joint_rng(data.study))
    fine = [one for one in specs if one.particle.name == "Carbo HSP30/60"]
    assert {one.particle.coarse_graining for one in fine} == {1.0, 1.37}
    assert min(one.parameters["e_pp"] for one in fine) >= 0.53
    assert min(one.parameters["e_pp"] for one in specs) < 0.3
