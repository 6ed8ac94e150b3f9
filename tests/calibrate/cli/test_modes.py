"""`bulkcal calibrate --mode`: by stages, all targets at once, or both into one directory."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pandas as pd

from calibrate.cli.kept import replaced_in
from calibrate.inference.store import load_posterior
from calibrate.report.record_file import hashed_record, read_record
from calibrate.runs.stored import RECORD
from liggghts_io.files import canonical_json, sha256_file, write_text


def test_both_modes_share_a_directory(both, bulkcal, small_study: Path) -> None:
    out, said, err, asked = both
    record = read_record(out / "calibration.json")
    assert {"stages", "covariance", "joint"} <= record.keys()
    joint = record["joint"]
    # What is not determined has a sentence and no number, on the screen and in the record.
    unknowns = {row["name"]: row for row in joint["unknowns"]}
    assert unknowns["e_pp"]["best"] is None
    assert "e_pp: nothing in these data determines it" in said
    assert [line for line in said.splitlines() if "e_pp" in line and "not determined" in line]
    assert unknowns["mu_pp"]["low_90"] < unknowns["mu_pp"]["best"] < unknowns["mu_pp"]["high_90"]
    assert "Stopped after" in err or "The budget of" in err
    samples = out / joint["samples"]["file"]
    assert sha256_file(samples) == joint["samples"]["sha256"]
    assert load_posterior(samples).names == tuple(unknowns)
    assert joint["provenance"]["study_sha256"] == record["study_sha256"]
    table = pd.read_csv(out / "runs.csv")
    assert set(joint["runs"]) <= set(table["case_id"])
    assert not table["case_id"].duplicated().any()
    page = (out / "report.html").read_text(encoding="utf-8")
    assert page.index('id="stages"') < page.index('id="all-targets-at-once"')
    assert "not determined by these data" in page
    assert "<th>by stages</th>" in page
    assert f"<td>{record['parameters']['mu_pp']:.3g}</td>" in page
    # Started again: the same answer, and no case that was not there.
    count = len(asked)
    assert bulkcal("calibrate", str(small_study), "--out", str(out), "-q")[0] == 0
    assert len(asked) == count
    again = read_record(out / "calibration.json")["joint"]
    assert again["unknowns"] == joint["unknowns"]


def test_either_mode_again_leaves_what_the_other_found(both, bulkcal, small_study: Path) -> None:
    out = both[0]
    record, table = read_record(out / "calibration.json"), pd.read_csv(out / "runs.csv")
    for mode in ("staged", "joint"):
        words = ["calibrate", str(small_study), "--mode", mode, "--out", str(out), "-q"]
        assert bulkcal(*words)[0] == 0
        page = (out / "report.html").read_text(encoding="utf-8")
        assert page.count('<section id="all-targets-at-once">') == 1
        assert page.count('<section id="stages">') == 1
        assert page.count('href="#all-targets-at-once"') == 1
        again = read_record(out / "calibration.json")
        assert again["joint"]["unknowns"] == record["joint"]["unknowns"]
        assert again["stages"] == record["stages"]
        now = pd.read_csv(out / "runs.csv")
        assert sorted(now["case_id"]) == sorted(table["case_id"])
        assert set(now["stage"]) == set(table["stage"])


def test_what_another_study_left_is_not_kept(both, bulkcal, small_study: Path) -> None:
    out = both[0]
    text = small_study.read_text(encoding="utf-8")
    small_study.write_text(text + "# changed\n", encoding="utf-8")
    words = ["calibrate", str(small_study), "--mode", "staged", "--out", str(out), "-q"]
    assert bulkcal(*words)[0] == 0
    assert 'id="all-targets-at-once"' not in (out / "report.html").read_text(encoding="utf-8")
    assert "joint" not in read_record(out / "calibration.json")


def test_joint_alone_writes_a_whole_report(
    bulkcal, small_study: Path, tmp_path: Path, on_stand_in
) -> None:
    out = tmp_path / "out"
    code, said, _ = bulkcal("calibrate", str(small_study), "--mode", "joint", "--out", str(out))
    assert code == 0
    record = read_record(out / "calibration.json")
    assert "stages" not in record
    assert record["parameters"].keys() == {"mu_pp", "mu_roll_pp", "e_pp"}
    assert "68 % interval" in said
    assert "next: open" in said
    page = (out / "report.html").read_text(encoding="utf-8")
    assert page.count("<figure>") >= 3
    assert 'id="stages"' not in page
    assert "by stages" not in page


def test_the_plan_is_honest(bulkcal, small_study: Path, tmp_path: Path, on_stand_in) -> None:
    words = ["calibrate", str(small_study), "--out", str(tmp_path / "out")]
    plan = json.loads(bulkcal(*words, "--dry-run", "--json")[1])
    assert plan["joint runs at most"] == 40
    assert "0 of them stored" in plan["joint calibration"][0]
    assert "posterior.npz" in plan["would write"]
    assert not (tmp_path / "out").exists()
    staged = json.loads(bulkcal(*words, "--mode", "staged", "--dry-run", "--json")[1])
    assert "joint calibration" not in staged
    bulkcal(*words)
    plan = json.loads(bulkcal(*words, "--dry-run", "--json")[1])
    first = plan["joint calibration"][0].split()
    assert first[2] == first[4]  # of as many runs as many are stored


def test_stages_that_are_not_there_are_refused(bulkcal, tmp_path: Path, small_study: Path) -> None:
    text = small_study.read_text(encoding="utf-8")
    path = small_study.with_name("none.toml")
    path.write_text(text[: text.index("[[stage]]")], encoding="utf-8")
    code, _, err = bulkcal("calibrate", str(path), "--mode", "both", "--out", str(tmp_path / "o"))
    assert code == 2
    assert "has no [[stage]]; use --mode joint" in err
    code, _, err = bulkcal("calibrate", str(path), "--mode", "bth", "--out", str(tmp_path / "o"))
    assert code == 2
    assert "both" in err


def test_a_changed_record_is_written_anew(both, bulkcal, small_study: Path) -> None:
    out = both[0]
    record = out / "calibration.json"
    record.write_text(record.read_text(encoding="utf-8").replace('"runs"', '"rums"', 1))
    assert bulkcal("calibrate", str(small_study), "--out", str(out), "-q")[0] == 0
    found = read_record(record)
    assert np.isfinite(found["joint"]["log_evidence"])


def test_status_knows_both_results(both, bulkcal, small_study: Path) -> None:
    out = both[0]
    said = bulkcal("status", str(out))[1]
    assert "calibrated by stages: 28 runs" in said
    assert "calibrated jointly: " in said
    assert "2 unknowns determined, 1 not" in said
    assert "has not ended" not in said
    record = out / "calibration.json"
    record.unlink()
    assert "has not ended; the same command goes on" in bulkcal("status", str(out))[1]
    record.write_text("{}", encoding="utf-8")
    assert "holds no calibration" in bulkcal("status", str(out))[1]


def test_results_of_another_study_are_told_before_they_are_replaced(tmp_path):
    assert replaced_in(tmp_path, "one") == ""
    write_text(tmp_path / RECORD, canonical_json(hashed_record({"study": "one"})))
    assert replaced_in(tmp_path, "one") == ""
    assert replaced_in(tmp_path, "two") == "one"


def test_results_of_older_data_are_told_and_never_mixed(both, bulkcal, small_study: Path) -> None:
    out = both[0]
    assert "changed since" not in bulkcal("export", str(out))[2]
    table = small_study.with_name("angle_of_repose.csv")
    table.write_text(table.read_text(encoding="utf-8").replace("36", "34"), encoding="utf-8")
    # The old result is handed out with a word of warning, and the command that makes a new one.
    code, lines, err = bulkcal("export", str(out))
    assert (code, "property/global" in lines) == (0, True)
    again = f"bulkcal calibrate {small_study} --out {out}"
    assert "(angle_of_repose.csv changed since); make it anew with: " + again in err
    assert "angle_of_repose.csv changed since" in bulkcal("status", str(out))[1]
    # A joint result of the old number does not stand beside stages of the new one.
    words = ["calibrate", str(small_study), "--out", str(out), "--mode", "staged"]
    code, _, err = bulkcal(*words)
    assert code == 0
    assert "results of other data (angle_of_repose.csv changed since)" in err
    assert "joint" not in read_record(out / "calibration.json")
    code, _, err = bulkcal("export", str(out), "--mode", "joint")
    assert (code, "run 'bulkcal calibrate STUDY --mode joint'" in err) == (2, True)
    assert "changed since" not in bulkcal("export", str(out))[2]


def test_a_record_that_names_no_data_says_so(both, bulkcal, small_study: Path) -> None:
    path = both[0] / "calibration.json"
    old = {name: one for name, one in read_record(path).items() if name != "study_files"}
    write_text(path, canonical_json(hashed_record(old)))
    code, lines, err = bulkcal("export", str(both[0]))
    assert (code, "property/global" in lines) == (0, True)
    assert "earlier version, which did not note its data" in err
