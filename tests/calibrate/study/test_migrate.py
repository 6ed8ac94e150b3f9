"""Study files of the first form: refused with the command, and written anew with equal meaning."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from calibrate.errors import CalibrationError
from calibrate.study.data import load_data
from calibrate.study.load import load_study
from calibrate.study.resources import bundled_study
from calibrate.study.writing.migrate import migrated_text

OLD = Path(__file__).parents[1] / "studies" / "old"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder with the old studies beside the data."""
    for csv in bundled_study().parent.glob("*.csv"):
        shutil.copy(csv, tmp_path)
    for study in OLD.glob("*.toml"):
        shutil.copy(study, tmp_path)
    return tmp_path


def test_the_old_bundled_study_means_what_the_new_one_does(bulkcal, folder: Path):
    code, out, err = bulkcal("migrate", str(folder / "hsp13_steel.toml"))
    assert code == 0, err
    path = folder / "hsp13_steel_new.toml"
    assert str(path) in out
    shipped, data = load_data(bundled_study()), load_data(path)
    # The old form had no budget of a joint calibration.
    assert data.study.design.runs > shipped.study.design.runs
    assert data.study == shipped.study.model_copy(update={"design": data.study.design})
    assert data.scalars == shipped.scalars
    assert path.read_text().startswith("# Carbo HSP13 bauxite proppant on steel: the three")


def test_every_old_table_has_a_new_place(folder: Path):
    text = migrated_text(folder / "everything.toml")
    path = folder / "new.toml"
    path.write_text(text, encoding="utf-8")
    (folder / "sand.csv").write_text("particle,surface,a,t,e\nSand 16/30,steel,30,10,0.5\n")
    (folder / "curve.csv").write_text("t_s,m_g,e_g\n1,0,1\n5,50,1\n10,100,1\n")
    data = load_data(path)
    study = data.study
    assert study.materials[0].name == "Sand 16-30"
    assert study.materials[0].particle.name == "Sand 16/30"
    assert study.overrides("heap") == {"frames": 40}
    assert study.effects == {"cohesion_J_m3": 10.0}
    assert study.known["plate_period"][0].se == 0.01
    assert study.design.check_seeds == 4
    assert study.published_of("mu_pp", "") == 0.6
    assert study.target_named("angle").scale == "linear"
    assert list(data.curves) == ["flow"]


@pytest.mark.parametrize("verb", ["check", "calibrate", "diagnose"])
def test_an_old_file_is_refused_with_its_line_and_the_command(verb: str, bulkcal, folder: Path):
    path = folder / "hsp13_steel.toml"
    code, _, err = bulkcal(verb, str(path))
    assert code == 2
    words = " ".join(err.split())
    assert f"{path}:6: 'particle' belongs to the first form" in words
    assert f"bulkcal migrate {path} {folder / 'hsp13_steel_new.toml'}" in words


def test_nothing_is_written_over_and_a_new_file_stays(bulkcal, folder: Path):
    old = str(folder / "hsp13_steel.toml")
    (folder / "there.toml").write_text("mine")
    code, _, err = bulkcal("migrate", old, str(folder / "there.toml"))
    assert code == 2
    assert "exists already" in err
    assert (folder / "there.toml").read_text() == "mine"
    with pytest.raises(CalibrationError, match="is no study of the first form"):
        migrated_text(bundled_study())


def test_what_was_wrong_is_still_told(bulkcal, folder: Path):
    old = folder / "hsp13_steel.toml"
    old.write_text(old.read_text().replace('"t100_s"', '"t100"', 1))
    code, out, _ = bulkcal("migrate", str(old), str(folder / "new.toml"))
    assert code == 0
    assert "to be corrected by you" in out
    assert "unknown observable 't100'; did you mean 't100_s'?" in out
    with pytest.raises(CalibrationError):
        load_study(folder / "new.toml")
