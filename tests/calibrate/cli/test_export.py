"""`bulkcal export`: lines for LIGGGHTS, JSON and CSV from the record alone."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

import pytest

from calibrate.report.record_file import hashed_record, read_record


@pytest.fixture
def calibrated(both, small_study: Path) -> Path:
    """Return the directory of a study calibrated both ways, of which the study file is gone."""
    small_study.unlink()
    return both[0]


def test_every_form_of_both_results(calibrated: Path, bulkcal, tmp_path: Path) -> None:
    code, lines, _ = bulkcal("export", str(calibrated))
    assert code == 0
    assert "fix sliding all property/global coefficientFriction peratomtypepair 1 0." in lines
    assert "# e_pp: NOT DETERMINED" in lines
    staged = bulkcal("export", str(calibrated), "--mode", "staged")[1]
    assert "# e_pp: given by the study" in staged
    assert "# mu_pp: 0." in staged
    plain = json.loads(bulkcal("export", str(calibrated), "--format", "json")[1])
    assert {"stages", "joint"} <= plain.keys()
    table = bulkcal("export", str(calibrated), "--format", "csv")[1]
    rows = list(csv.DictReader(io.StringIO(table)))
    assert [row["name"] for row in rows] == ["mu_pp", "mu_roll_pp", "e_pp"]
    assert rows[2]["best"] == ""
    file = tmp_path / "contact.in"
    assert bulkcal("export", str(calibrated), "--out", str(file))[0] == 0
    assert file.read_text(encoding="utf-8").rstrip() == lines.rstrip()
    code, _, err = bulkcal("export", str(calibrated), "--out", str(file), "--format", "csv")
    assert (code, "nothing is written over" in err) == (2, True)
    assert file.read_text(encoding="utf-8").rstrip() == lines.rstrip()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--format", "xml"], "--format"),
        (["--mode", "stagd"], "staged"),
        (["--material", "Sand"], "--material Sand"),
    ],
)
def test_wrong_words_are_refused(calibrated: Path, bulkcal, words: list[str], said: str) -> None:
    code, _, err = bulkcal("export", str(calibrated), *words)
    assert code == 2
    assert said in err


def test_a_directory_without_a_result_is_refused(bulkcal, tmp_path: Path) -> None:
    code, _, err = bulkcal("export", str(tmp_path))
    assert code == 2
    assert "name the --out of a finished 'bulkcal calibrate'" in err


def test_a_file_may_have_a_name_as_long_as_names_can_be(
    calibrated: Path, bulkcal, tmp_path: Path
) -> None:
    file = tmp_path / f"{'c' * 252}.in"  # 255 letters, the most that file systems take
    code, out, err = bulkcal("export", str(calibrated), "--out", str(file))
    assert code == 0, err
    assert f"next: put 'include {file.name}' into your script" in out
    assert "property/global" in file.read_text(encoding="utf-8")


def test_status_says_what_follows(calibrated: Path, bulkcal) -> None:
    assert f"next: bulkcal export {calibrated}\n" in bulkcal("status", str(calibrated))[1]


def test_a_record_of_another_version_is_told_as_one(calibrated: Path, bulkcal) -> None:
    """Its digest is right, and an entry of today is not there or is something else."""
    path = calibrated / "calibration.json"
    record = read_record(path)
    joint = record["joint"]
    for other in (
        record | {"joint": {key: one for key, one in joint.items() if key != "unknowns"}},
        record | {"joint": joint | {"unknowns": None}},
        record | {"joint": "a word"},
    ):
        path.write_text(json.dumps(hashed_record(other)), encoding="utf-8")
        code, _, err = bulkcal("export", str(calibrated), "--format", "csv")
        assert (code, "was written by another version of bulkcal" in err) == (2, True)
        code, said, hint = bulkcal("status", str(calibrated))
        assert (code, "was written by another version of bulkcal" in said) == (0, True)
        assert "bulkcal export" not in hint  # which would refuse it
