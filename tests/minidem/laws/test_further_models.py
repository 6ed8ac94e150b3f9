"""Contact models that few scripts have: what they refuse, and what their contacts keep.

Their trajectories are compared with those of LIGGGHTS in ``tests/minidem/engine/test_cases.py``.
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from minidem import ScriptError, run_script
from tests.minidem.engine import cases
from tests.minidem.laws.model_list import MODEL_CASES, PAIRS, SCALARS

PACKING = MODEL_CASES["luding, packing"]


def refusal(folder: Path, text: str) -> str:
    """Return why a script is refused."""
    for name, triangles in PACKING.meshes.items():
        (folder / name).write_text(cases.stl_text(triangles))
    (folder / "in.script").write_text(text)
    with pytest.raises(ScriptError) as caught:
        run_script(folder / "in.script", root=folder)
    return str(caught.value).replace(f"{folder}/", "")


# -- values and words ------------------------------------------------------------------------------

TAKEN = {
    "hooke/stiffness": {"kn", "kt", "gamman", "gammat"},
    "hooke/stiffness, absolute damping": {"kn", "kt", "gamman_abs", "gammat_abs"},
    "hertz/stiffness": {"kn", "kt", "gamman", "gammat"},
    "epsd3": {"rollingStiffness"},
    "viscous hooke": {
        "FluidViscosity", "CriticalStokes", "MaximumRestitution", "characteristicVelocity",
    },
    "hooke/hysteresis": {
        "coefficientMaxElasticStiffness", "coefficientAdhesionStiffness",
        "coefficientPlasticityDepth", "characteristicVelocity",
    },
    "luding, all of it": {
        "LoadingStiffness", "UnloadingStiffness", "coefficientAdhesionStiffness",
        "coefficientPlasticityDepth", "pullOffForce", "FluidViscosity", "FrictionViscosity",
        "coeffFrictionStiffness", "coeffRollingStiffness",
    },
    "edinburgh": {
        "UnloadingStiffness", "coefficientAdhesionStiffness", "overlapExponent",
        "adhesionExponent", "pullOffForce", "surfaceEnergy",
    },
    "edinburgh/stiffness": {
        "LoadingStiffness", "UnloadingStiffness", "coefficientAdhesionStiffness",
        "overlapExponent", "adhesionExponent", "pullOffForce", "surfaceEnergy",
    },
}  # fmt: skip
"""Values that LIGGGHTS 3.8.0 asks for, beside moduli, restitution and friction."""


@pytest.mark.parametrize("name", TAKEN)
def test_a_missing_value_is_named_with_the_line_to_add(tmp_path, name):
    text = replace(MODEL_CASES[name], runs="run 0").script()
    for value in {*PAIRS, *SCALARS}:
        without = re.sub(rf"fix \S+ all property/global {value} .*\n", "", text)
        if value not in TAKEN[name]:
            text = without
            continue
        line = without[: without.index("\nrun 0")].count("\n") + 2
        form = "scalar VALUE" if value in SCALARS else "peratomtypepair 2 VALUE VALUE VALUE VALUE"
        found = refusal(tmp_path, without)
        assert found.startswith(f"in.script:{line}: Could not locate a fix/property storing")
        assert found.endswith(f"Add 'fix ID all property/global {value} {form}'")
    (tmp_path / "in.script").write_text(text)
    run_script(tmp_path / "in.script", root=tmp_path)


def test_models_of_given_stiffness_need_no_moduli(tmp_path):
    text = replace(MODEL_CASES["hooke/stiffness"], runs="run 0").script()
    for value in ("youngsModulus", "poissonsRatio", "coefficientRestitution"):
        text = re.sub(rf"fix \S+ all property/global {value} .*\n", "", text)
    (tmp_path / "m.stl").write_text(cases.stl_text(PACKING.meshes["m.stl"]))
    (tmp_path / "in.script").write_text(text)
    run_script(tmp_path / "in.script", root=tmp_path)


@pytest.mark.parametrize(
    ("words", "why"),
    [
        ("hertz tangential tan_luding", "'tangential tan_luding' needs the adhesion of 'model lud"),
        ("hooke tangential history rolling_friction luding", "needs the adhesion of"),
        ("thornton_ning rolling_friction epsd", "epsd' needs the normal stiffness of 'model hertz"),
        ("hertz cohesion easo/capillary/viscous modifyLbVolume on", "a setting of 'cohesion washi"),
        ("hertz surface superquadric", "'surface superquadric' is not in minidem: grains are sph"),
        ("hertz tangential history surface multicontact", "contacts do not feel each other"),
        ("hook/stiffness", "did you mean 'hooke/stiffness'"),
        ("hertz tangential history heating_tracking on", "heat is not computed; without it the"),
        ("hertz tangential history computeElasticPotential on", "energies of contacts are not"),
        ("hertz tangential history viscous on", "a setting of 'model hooke or hooke/hysteresis'"),
        ("hertz/stiffness absolute_damping on", "a setting of 'model hooke/stiffness'"),
        ("luding fixKc on", "a setting of 'model edinburgh or edinburgh/stiffness'"),
        ("luding velocityRestitution on", "a setting of 'model hertz or hooke'"),
        ("hooke viscous on restitutionScatter on", "both set the restitution"),
    ],
)
def test_what_does_not_go_together_is_refused(tmp_path, words, why):
    text = PACKING.script()
    line = next(k for k, row in enumerate(text.splitlines(), 1) if row.startswith("pair_style"))
    found = refusal(tmp_path, re.sub(r"pair_style gran .*", f"pair_style gran model {words}", text))
    assert found.startswith(f"in.script:{line}: ")
    assert why in found


@pytest.mark.parametrize(
    ("name", "value", "words", "why"),
    [
        ("edinburgh", "UnloadingStiffness", "peratomtypepair 2 2 .5 .5 2", "is 0.5; it must be at"),
        ("edinburgh", "overlapExponent", "scalar 0", "overlapExponent is 0; it must be above zero"),
        ("epsd3", "rollingStiffness", "scalar .5", "rollingStiffness >= 1 required for SI units"),
        ("viscous hooke", "MaximumRestitution", "peratomtypepair 2 1 1 1 1.1", "<= 1 required"),
        ("luding, all of it", "FluidViscosity", "peratomtypepair 2 1 0 0 1", "above zero"),
    ],
)
def test_values_out_of_their_limits_are_refused(tmp_path, name, value, words, why):
    text = re.sub(rf"(property/global {value}) .*", rf"\1 {words}", MODEL_CASES[name].script())
    assert why in refusal(tmp_path, text)


def test_settings_that_are_off_are_taken(tmp_path):
    words = "heating_normal_hertz off computeDissipatedEnergy off disableNormalWhenBonded off"
    case = MODEL_CASES["epsd3"]
    replace(case, model=f"{case.model} {words}", runs="run 1").write(tmp_path)
    run_script(tmp_path / "in.script", root=tmp_path)


# -- what a contact keeps --------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["luding, packing", "edinburgh, packing"])
def test_a_restarted_run_goes_on_bit_for_bit(tmp_path, name):
    runs = "run 900\nwrite_restart half.restart\nrun 600"
    case = replace(MODEL_CASES[name], steps=300, runs=runs)
    whole = case.write(tmp_path)
    run_script(whole, root=tmp_path)
    found = cases.read(tmp_path)
    text = re.sub(r"region reg .*\ncreate_box .*\n", "read_restart half.restart\n", case.script())
    assert "read_restart" in text
    text = text.replace(runs, "run 600")
    (tmp_path / "in.script").write_text(text)
    run_script(whole, root=tmp_path)
    again = cases.read(tmp_path)
    for step in (1200, 1500):
        np.testing.assert_array_equal(found.frames[step], again.frames[step])


def test_two_threads_change_nothing_but_rounding(tmp_path):
    case = replace(PACKING, steps=1500)
    frames = []
    for threads in (1, 2):
        run_script(case.write(tmp_path), root=tmp_path, threads=threads)
        frames.append(cases.read(tmp_path).frames[1500])
    # positions to what rounding, 1e-17 m, grows to in the contacts of 1500 steps
    np.testing.assert_allclose(frames[0][:, 2:5], frames[1][:, 2:5], rtol=0, atol=1e-12)


def test_contacts_tell_how_far_they_were_loaded(tmp_path):
    lines = (
        "compute c all pair/gran/local history delta\n"
        "dump local all local 20 local.dump c_c[1] c_c[8]\nrun 300"
    )
    case = replace(MODEL_CASES["hooke/hysteresis"], runs=lines)
    run_script(case.write(tmp_path), root=tmp_path)
    rows = re.findall(r"^(\d\S*) (\d\S*) $", (tmp_path / "local.dump").read_text(), re.M)
    largest, now = np.array(rows, float).T
    assert (largest >= now).all()
    assert (largest > now).any()
