"""`--dry-run` says what would be done and writes nothing; -q and -v say less and more."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from rich.console import Console

from calibrate.cli.show.waiting import FIRST_S, Waiting
from tests.calibrate.cli.words import PAIRS, SMALL


def snapshot(root: Path) -> dict[str, bytes | None]:
    """Return every file below a directory with its content."""
    return {
        str(path.relative_to(root)): path.read_bytes() if path.is_file() else None
        for path in root.rglob("*")
    }


def test_generate_writes_nothing_and_names_what_it_would(bulkcal, tmp_path: Path):
    words = ["generate", "heap", *PAIRS, "--out", str(tmp_path / "case")]
    code, out, _ = bulkcal(*words, "--dry-run", "--json")
    assert code == 0
    plan = json.loads(out)
    assert snapshot(tmp_path) == {}
    bulkcal(*words)
    for name in plan["would write"]:
        assert (tmp_path / "case" / name).is_file()
    assert json.loads((tmp_path / "case/case.json").read_text())["case_id"] == plan["case id"]


def test_run_says_steps_and_what_is_stored(bulkcal, tmp_path: Path):
    case = str(tmp_path / "case")
    bulkcal("generate", "heap", *PAIRS, *SMALL, "--out", case)
    before = snapshot(tmp_path)
    plan = json.loads(bulkcal("run", case, "--dry-run", "--json")[1])
    assert plan["stored result"] == "none"
    assert plan["time steps"] > 0
    assert snapshot(tmp_path) == before
    assert bulkcal("run", case)[0] == 0
    assert "angle_deg = " in bulkcal("run", case, "--dry-run")[1]


@pytest.mark.parametrize("verb", ["calibrate", "diagnose"])
def test_a_study_counts_its_runs_and_what_is_stored(
    verb: str, bulkcal, small_study: Path, tmp_path: Path, on_stand_in
):
    out = tmp_path / "out"
    words = [verb, str(small_study), "--out", str(out), "--dry-run", "--json"]
    plan = json.loads(bulkcal(*words)[1])
    assert (plan["runs"], plan["stored"], plan["to run"]) == (28, 0, 28)
    assert not out.exists()
    assert on_stand_in == []
    bulkcal("calibrate", str(small_study), "--out", str(out))
    before = snapshot(out)
    plan = json.loads(bulkcal(*words)[1])
    assert (plan["runs"], plan["stored"], plan["to run"]) == (28, 28, 0)
    if verb == "diagnose":
        assert "runs, 0 of them stored" in plan["diagnosis"][0]
    assert snapshot(out) == before


def test_a_new_directory_has_the_plan_of_an_empty_one(bulkcal, small_study: Path, tmp_path: Path):
    """The plan of a new directory is counted from the study, that of an old one is asked for."""
    (tmp_path / "old" / "runs").mkdir(parents=True)
    words = ["calibrate", str(small_study), "--dry-run", "--json", "--out"]
    new, old = (json.loads(bulkcal(*words, str(tmp_path / name))[1]) for name in ("new", "old"))
    assert new.pop("directory") != old.pop("directory")
    assert new == old


def test_quiet_leaves_results_only(bulkcal, tmp_path: Path):
    case = str(tmp_path / "case")
    assert bulkcal("generate", "heap", *PAIRS, *SMALL, "--out", case, "-q")[1:] == (
        f"wrote {case}/in.script\n", "",
    )  # fmt: skip
    code, out, err = bulkcal("run", case, "-q")
    assert (code, err) == (0, "")
    assert "angle_deg" in out
    assert "next:" not in out
    assert bulkcal("-q", "post", case)[1:] == (out, "")  # people put it in front, too


def test_verbose_says_engine_and_case(bulkcal, tmp_path: Path):
    case = str(tmp_path / "case")
    err = bulkcal("generate", "heap", *PAIRS, *SMALL, "--out", case, "-v")[2]
    for word in ("case id: ", "engine: minidem", "time steps: "):
        assert word in err


def test_nothing_waits_in_silence(capsys):
    """In a file or pipe a line appears before two seconds are over."""
    with Waiting(Console(stderr=True), "thinking") as wait:
        wait._lines._ended.wait(1.5 * FIRST_S)
    assert FIRST_S < 2.0
    assert "thinking after 0:0" in capsys.readouterr().err


def test_nothing_waits_aloud_when_asked_to_be_quiet(capsys):
    with Waiting(Console(stderr=True, quiet=True), "thinking") as wait:
        assert wait._lines is None
    assert capsys.readouterr().err == ""
