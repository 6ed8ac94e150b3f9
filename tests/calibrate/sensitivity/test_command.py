"""`bulkcal sensitivity`: what it would run, what it writes, what it uses again."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from calibrate import load
from calibrate.report.record_file import read_record

FEW = ("--levels", "2", "--seeds", "2")


def test_a_dry_run_says_runs_and_time_and_writes_nothing(
    bulkcal, small_study: Path, tmp_path: Path, on_stand_in
) -> None:
    out = tmp_path / "out"
    words = ["sensitivity", str(small_study), "--out", str(out), *FEW]
    plan = json.loads(bulkcal(*words, "--dry-run", "--json")[1])
    assert not out.exists()
    assert on_stand_in == []
    assert plan["time"].startswith("about ")
    assert "mu_pp = 0.35" in plan["baseline"]  # baseline.csv lies beside the study
    # Two places; three contact parameters and nu have two values beside the baseline, Y has one.
    assert plan["one at a time"].startswith(f"{2 * 2 * (1 + 4 * 2 + 1)} runs")
    assert bulkcal(*words, "-q")[0] == 0
    assert len(on_stand_in) == plan["to run"]
    again = json.loads(bulkcal(*words, "--dry-run", "--json")[1])
    assert (again["to run"], again["time"]) == (0, "about 0:00")


def test_it_writes_record_and_page_and_says_what_comes_next(
    bulkcal, small_study: Path, tmp_path: Path, on_stand_in
) -> None:
    out = tmp_path / "out"
    words = ["sensitivity", str(small_study), "--out", str(out), *FEW]
    code, shown, err = bulkcal(*words)
    assert code == 0, err
    assert "One parameter at a time" in shown
    assert "Sobol indices" in shown
    assert f"next: open {out / 'sensitivity.html'}, or: bulkcal calibrate" in shown
    page = (out / "sensitivity.html").read_text(encoding="utf-8")
    assert page.count("<img ") == 2 + 1  # two places, and the indices
    assert "http" not in page.partition("</style>")[2]
    record = read_record(out / "sensitivity.json")
    heap = [r for r in record["sobol"] if r["output"] == "angle_deg"]
    assert sum(row["total"] for row in heap) > 0.9
    assert {row["parameter"] for row in heap} == {"mu_pp", "mu_roll_pp", "e_pp"}
    assert json.loads(bulkcal(*words, "--json", "-q")[1])["sobol"] == record["sobol"]


def test_runs_of_a_calibration_are_used_and_its_report_gets_a_section(
    bulkcal, small_study: Path, tmp_path: Path, on_stand_in
) -> None:
    out = tmp_path / "out"
    assert bulkcal("calibrate", str(small_study), "--out", str(out), "--mode", "joint")[0] == 0
    before = len(on_stand_in)
    words = ["sensitivity", str(small_study), "--out", str(out), "--levels", "0"]
    code, shown, err = bulkcal(*words)
    assert code == 0, err
    assert len(on_stand_in) == before  # its first design is that of the calibration
    assert "One parameter at a time" not in shown
    assert "next: " in shown
    assert "bulkcal diagnose" in shown
    assert "What moves what" in (out / "report.html").read_text(encoding="utf-8")


def test_nothing_to_do_is_told(bulkcal, small_study: Path, tmp_path: Path) -> None:
    words = ["--out", str(tmp_path / "out"), "--levels", "0", "--points", "0"]
    code, _, err = bulkcal("sensitivity", str(small_study), *words)
    assert code == 2
    assert "nothing to do" in err
    assert not (tmp_path / "out").exists()


def test_too_few_points_are_told_before_the_first_run(
    bulkcal, small_study: Path, tmp_path: Path, on_stand_in
) -> None:
    words = ["--out", str(tmp_path / "out"), "--points", "5"]
    for more in ([], ["--dry-run"]):
        code, _, err = bulkcal("sensitivity", str(small_study), *words, *more)
        assert code == 2
        assert "--points 5: gives 5 points of heap" in err
        assert "give 6 or more" in err
    assert not on_stand_in
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("given", ["nowhere.csv", "angle_of_repose.csv"])
def test_a_baseline_that_is_none_is_told(bulkcal, small_study: Path, tmp_path, given: str) -> None:
    table = small_study.with_name(given)
    words = ["--out", str(tmp_path / "out"), "--baseline", str(table)]
    code, _, err = bulkcal("sensitivity", str(small_study), *words)
    assert code == 2
    assert given in err
    assert not (tmp_path / "out").exists()


def test_it_is_one_line_in_a_notebook(small_study: Path, tmp_path: Path, on_stand_in) -> None:
    found = load(small_study).sensitivity(tmp_path / "out", levels=2, seeds=2)
    assert {"direction", "change", "first", "total", "seen"} <= set(found.table())
    assert found.figure().axes
    assert found.indices_figure().axes
    assert repr(found).startswith("SensitivityResult(")
