"""`bulkcal retry`: stored failures run again, and what is known of them stays."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from calibrate.runs.retry import set_aside
from liggghts_io import CaseResult, case_id, load_result, stored_result, write_case
from liggghts_io.case.lock import locked
from liggghts_io.case.results import store_result
from tests.calibrate.runs.test_campaign import specs


def store(root: Path, seed: int, failure: str) -> Path:
    """Store a case of which only the result is of interest."""
    (spec,) = specs(seed)
    identity = case_id(spec)
    path = write_case(spec, root / identity)
    status = "failed" if failure else "ok"
    numbers = {} if failure else {"angle_deg": 30.0}
    reason = f"because of {failure}" if failure else ""
    store_result(CaseResult(identity, path, status, reason, numbers, 1.0, failure, "last words"))
    (path / "output").mkdir()
    (path / "output" / "log.liggghts").write_text(f"log of {seed}")
    return path


@pytest.fixture
def runs(tmp_path: Path) -> dict[str, Path]:
    """Store a good run and one failure of each of two classes."""
    root = tmp_path / "cal" / "runs"
    return {name: store(root, i, name) for i, name in enumerate(["", "physics", "killed"], 1)}


def test_failures_of_a_class_run_again_and_nothing_is_lost(runs, bulkcal, tmp_path: Path):
    record = {"provenance": {"command": "bulkcal calibrate s.toml --out cal"}}
    (tmp_path / "cal" / "calibration.json").write_text(json.dumps(record))
    code, out, _ = bulkcal("retry", str(tmp_path / "cal"), "--class", "physics")
    assert code == 0
    assert "1 failed run of class physics will run again" in out
    # With the directory as it is called now: it may have been moved, and the work with it.
    assert f"next: bulkcal calibrate s.toml --out {tmp_path / 'cal'}\n" in out
    failed = runs["physics"]
    assert stored_result(failed.parent, failed.name) is None
    aside = json.loads((failed / "failed-1" / "result.json").read_text())["result"]
    assert (aside["reason"], aside["log_tail"]) == ("because of physics", "last words")
    assert (failed / "failed-1" / "output" / "log.liggghts").read_text() == "log of 2"
    assert load_result(runs["killed"]).failure == "killed"
    assert load_result(runs[""]).status == "ok"


def test_the_next_command_finds_the_study_that_was_moved_along(runs, bulkcal, tmp_path: Path):
    command = "bulkcal calibrate old/s.toml --out old/cal --workers 2"
    record = {"joint": {"provenance": {"command": command}}, "study_from_here": "../s.toml"}
    (tmp_path / "cal" / "calibration.json").write_text(json.dumps(record))
    (tmp_path / "s.toml").write_text("")
    out = bulkcal("retry", str(tmp_path / "cal"))[1]
    assert f"calibrate {tmp_path / 's.toml'} --out {tmp_path / 'cal'} --workers 2\n" in out


def test_without_a_class_all_failures_and_twice_none(runs, bulkcal, tmp_path: Path):
    code, out, _ = bulkcal("retry", str(tmp_path / "cal"), "--json")
    assert code == 0
    names = {str(path) for name, path in runs.items() if name}
    assert set(json.loads(out)["runs"]) == names
    assert bulkcal("retry", str(tmp_path / "cal"))[1] == "0 failed runs will run again\n"


def test_a_single_case_is_named_in_the_next_command(runs, bulkcal):
    _, out, _ = bulkcal("retry", str(runs["killed"]))
    assert f"next: bulkcal run {runs['killed']}" in out


def test_a_second_failure_is_set_aside_beside_the_first(runs):
    failed = runs["physics"]
    set_aside(failed)
    store_result(CaseResult(failed.name, failed, "failed", "again", {}, 1.0, "physics"))
    set_aside(failed)
    assert (failed / "failed-1" / "result.json").exists()
    assert json.loads((failed / "failed-2" / "result.json").read_text())["result"]["reason"] == (
        "again"
    )


def test_a_case_that_is_being_run_is_left_alone(runs):
    with locked(runs["physics"]):
        assert set_aside(runs["physics"].parent) == [runs["killed"]]


def test_unknown_class_and_missing_directory_are_refused(bulkcal, tmp_path: Path):
    code, _, err = bulkcal("retry", str(tmp_path), "--class", "kiled")
    assert code == 2
    assert "did you mean 'killed'?" in err
    code, _, err = bulkcal("retry", str(tmp_path / "nowhere"))
    assert code == 2
    assert "no such directory" in err
