"""The study file: good ones load, each bad one is refused with place, value and remedy."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from calibrate.errors import CalibrationError
from calibrate.study.data import load_data
from calibrate.study.load import load_study
from calibrate.study.model import Study
from calibrate.study.schema.materials import Material
from calibrate.study.write import study_text

BAD = Path(__file__).parent / "studies"

# File name -> words that the message must hold: what is wrong, and the remedy.
EXPECTED = {
    "bad_unknown_key": ["stage 'first': unknown key 'infil'", "did you mean 'infill'?", ":53:"],
    "bad_unknown_target": ["'t100_glud'", "did you mean 't100_glued'?"],
    "bad_unknown_parameter": [":41: unknown parameter 'mu_rol_pp'; did you mean 'mu_roll_pp'?"],
    "bad_missing_key": ["target 'angle_glued': key 'observable' is missing"],
    "bad_scale": ["run.scale: unknown name 'quik'", "did you mean 'quick'?"],
    "bad_range": ["parameter.mu_pp: range = [0.8, 0.1]", "[low, high]"],
    "bad_no_value": [":45: 'e_pp' has no value in stage 'first'", "[parameter.e_pp]"],
    "bad_twice": ["target 'angle_glued' appears twice"],
    "bad_outside": ["file = '../../secret.csv' lies outside"],
    "bad_absolute": ["file = '/etc/passwd' lies outside"],
    "bad_no_file": ["'angle_of_repos.csv' does not exist", "did you mean 'angle_of_repose.csv'?"],
    "bad_particle": ["particles.csv: unknown particle 'Carbo HSP14'", "did you mean 'Carbo HSP"],
    "bad_no_material": ["key 'material' is missing; add a [[material]]"],
    "bad_no_table": [":9: material 'Carbo HSP13': file = 'grains.csv' does not exist", "numbers"],
    "bad_table_outside": ["'../grains.csv' lies outside"],
    "bad_both_particles": ["'particles' and 'd32_um' both say what the grains are", "keep one"],
    "bad_bulk_key": ["material 'Carbo HSP13': unknown key 'd32_mm'", "did you mean 'd32_um'?"],
    "bad_bulk_value": ["material 'Carbo HSP13': d32_um = 1.595: must be at least 10"],
    "bad_bulk_flow": ["no flow_glued_g_s", "conveyor on glued"],
    "bad_bulk_effect": ["no size distribution", "effect size_distribution"],
    "bad_surface": [":19: target 'angle_glued': surface: unknown name 'glud'", "'glued'?; declare"],
    "bad_ambiguous": ["key 'material' is missing; the study has several", "SG10H"],
    "bad_tie": [":39: parameter.mu_pp: tie = 'material' has one member (Carbo HSP13)", "take it"],
    "bad_unused": [":44: parameter 'mu_pw' matters in no experiment of the study", "take it out"],
    "bad_known": [":56: known.mu_pp: material: unknown name 'SG10H'"],
    "bad_prior": ["parameter.mu_pp: prior lies outside range = [0.1, 0.8]"],
    "bad_shared": [":57: shared error 'clock': targets: unknown name 't99_glued'; did you mean"],
    "bad_old_form": [":4: 'particle' belongs to the first form", "bulkcal migrate", "_new.toml"],
    "bad_toml": ["not valid TOML", "line 2"],
}


@pytest.fixture
def beside_data(tmp_path: Path, study_path: Path):
    """Copy a bad study beside the bundled data, so that only its own fault counts."""

    def copy(name: str) -> Path:
        for csv in study_path.parent.glob("*.csv"):
            shutil.copy(csv, tmp_path)
        return Path(shutil.copy(BAD / f"{name}.toml", tmp_path))

    return copy


def test_every_bad_study_is_tested():
    assert {p.stem for p in BAD.glob("bad_*.toml")} == set(EXPECTED)


@pytest.mark.parametrize("name", EXPECTED)
def test_bad_study_is_refused_with_place_and_remedy(name: str, beside_data):
    path = beside_data(name)
    with pytest.raises(CalibrationError) as caught:
        load_study(path)
    message = str(caught.value)
    for line in message.removesuffix("\n").split("\n"):
        if not re.match(r"\d mistakes:$", line):
            assert re.match(re.escape(str(path)) + r"(:\d+)?: ", line)
    for words in EXPECTED[name]:
        assert words in message, message


def test_data_outside_is_refused_through_a_link_too(beside_data, tmp_path: Path):
    path = beside_data("good")
    outside = tmp_path.parent / "outside.csv"
    outside.write_text("particle,surface\n")
    (tmp_path / "conveyor.csv").unlink()
    (tmp_path / "conveyor.csv").symlink_to(outside)
    with pytest.raises(CalibrationError, match="lies outside"):
        load_study(path)


def test_good_study_loads(beside_data):
    assert load_study(beside_data("good")).stages[0].infill == 0


def test_missing_study_names_the_path(tmp_path: Path):
    with pytest.raises(CalibrationError, match=r"nowhere\.toml: cannot be read"):
        load_study(tmp_path / "nowhere.toml")


def test_bundled_study_has_the_papers_stages(study: Study, study_path: Path):
    freed = [tuple(stage.free) for stage in study.stages]
    assert freed == [("mu_pp", "mu_roll_pp"), ("mu_pw", "mu_roll_pw"), ("e_pp", "e_pw")]
    ranges = {name: study.range_of(name, "") for name in study.parameters}
    assert (ranges["mu_pp"], ranges["mu_roll_pp"]) == ((0.1, 0.8), (0.05, 0.6))
    assert ranges["e_pp"] == ranges["e_pw"] == (0.2, 0.9)
    measured = load_data(study_path).scalars
    # Tables B.4 to B.6 of the paper, Carbo HSP13.
    assert (measured["angle_glued"].value, measured["angle_glued"].se) == (38.28, 0.61)
    assert (measured["t100_steel"].value, measured["t100_steel"].se) == (10.13, 0.06)
    assert (measured["m3_steel"].value, measured["m3_steel"].se) == (2.74, 0.04)
    assert "Table B.4" in measured["angle_glued"].source


def test_written_study_reads_back_equal(study: Study, beside_data):
    extended = study.model_copy(update={"effects": {"plate_tilt_deg": 1.5}})
    text = study_text(extended, "first line\nsecond line")
    assert text.startswith("# first line\n# second line\n")
    path = beside_data("good")
    path.write_text(text, encoding="utf-8")
    assert load_study(path) == extended


def test_a_written_study_describes_its_grains_and_needs_no_table(beside_data, tmp_path: Path):
    path = beside_data("good")
    study = load_study(path)
    grains = study.materials[0]
    assert (grains.name, grains.particle.name, grains.d32_um) == (*["Carbo HSP13"] * 2, 1595.0)
    sand = Material(name="Carbo HSP13", particle='Sand "dry" 16/30', density_kg_m3=2650.0,
                    sieve=((900.0, 1.0), (1100.0, 3.0)), youngs_modulus_pa=6e6,
                    flow_flat_g_s=20.0, flow_glued_g_s=19.5)  # fmt: skip
    for material in (grains, sand):
        one = study.model_copy(update={"materials": [material]})
        path.write_text(study_text(one), encoding="utf-8")
        (tmp_path / "particles.csv").unlink(missing_ok=True)
        assert load_study(path) == one
        assert load_study(path).materials[0].particle == material.particle


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("t100_s,", "t_100_s,"), ["no column 't100_s'", "did you mean 't_100_s'?"]),
        (("Carbo HSP13,glued", "Carbo HSP14,glued"), ["0 rows", "Carbo HSP13"]),
        (("17.90", "n.a."), ["conveyor.csv:6: t100_s = 'n.a.'", "is not a number"]),
        (("17.90", "-17.90"), ["conveyor.csv:6: t100_s = '-17.90'", "not a positive number"]),
        (("17.90", "nan"), ["t100_s = 'nan'", "is not a number"]),
        (("17.90", "1e300"), ["t100_s = '1e300'", "not a possible value of t100_s"]),
        (("17.90,0.02", "17.90,0"), ["sem_s = '0'", "not a positive number"]),
        (("17.90,0.02", "17.90,99"), ["sem_s = '99'", "5.5 times the value"]),
        (("17.90,0.02,5", "17.90,0.02,few"), ["repeats = 'few'", "not a whole number"]),
    ],
)
def test_bad_data_name_file_and_value(change, words, beside_data, tmp_path: Path):
    path = beside_data("good")
    csv = tmp_path / "conveyor.csv"
    csv.chmod(0o644)
    csv.write_text(csv.read_text().replace(*change))
    with pytest.raises(CalibrationError) as caught:
        load_data(path)
    assert str(csv) in str(caught.value)
    for word in words:
        assert word in str(caught.value)
