"""`bulkcal check`: what a pilot would cost, and what it says."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from calibrate.cli import running
from calibrate.runs import cost
from calibrate.runs.campaign import Campaign
from tests.calibrate import stand_in
from tests.calibrate.questions.planted import Measurement, planted_study


@pytest.fixture
def on_formulas(monkeypatch):
    """Let probes and pilots run on formulas; returns the executors that were opened."""
    opened = []

    class Inline(Campaign):
        """Asks the formulas."""

        def _results(self, specs, todo):
            opened.append(self.workers)
            for index in todo:
                yield index, stand_in.execute(specs[index], self.root)

    monkeypatch.setattr(running, "Campaign", Inline)
    monkeypatch.setattr(running, "stored_case", stand_in.stored)
    monkeypatch.setattr(cost.cost_of, "__defaults__", (stand_in.execute, lambda _line: None))
    return opened


def test_without_a_pilot_it_says_what_one_would_give(
    bulkcal, small_study: Path, tmp_path: Path, on_formulas
) -> None:
    code, out, err = bulkcal("check", str(small_study), "--out", str(tmp_path / "out"))
    assert code == 0, err
    line = next(one for one in out.splitlines() if one.startswith("A pilot of"))
    assert int(line.split()[3]) > 10
    assert "--pilot" in line
    assert on_formulas == []
    assert not (tmp_path / "out").exists()


def test_a_pilot_says_what_the_data_determine(
    bulkcal, small_study: Path, tmp_path: Path, on_formulas
) -> None:
    words = ["check", str(small_study), "--pilot", "--out", str(tmp_path / "out")]
    code, out, err = bulkcal(*words)
    assert code == 0, err
    assert "pilot: " in err  # its cost, before it runs
    assert "What these data can determine" in out
    assert "e_pp: nothing in these data determines it" in out
    assert list((tmp_path / "out" / "runs").iterdir())  # kept for the calibration
    plain = json.loads(bulkcal(*words, "--json")[1])
    widths = {row["name"]: row["width"] for row in plain["pilot"]["unknowns"]}
    assert widths["e_pp"] > 0.9 > widths["mu_pp"]


def test_data_that_nothing_can_reach_are_named(
    bulkcal, small_study: Path, tmp_path: Path, on_formulas
) -> None:
    table = small_study.with_name("angle_of_repose.csv")
    text = table.read_text(encoding="utf-8")
    assert "38.28" in text
    table.write_text(text.replace("38.28", "78.28"), encoding="utf-8")
    out = bulkcal("check", str(small_study), "--pilot", "--out", str(tmp_path / "out"))[1]
    assert "measured 78.28 deg, and the nearest that any parameters" in out


def test_the_study_says_how_many_processes(
    bulkcal, small_study: Path, tmp_path: Path, on_formulas
) -> None:
    text = small_study.read_text(encoding="utf-8")
    small_study.write_text(text.replace("[run]", "[run]\nworkers = 3", 1), encoding="utf-8")
    out = bulkcal("check", str(small_study), "--pilot", "--out", str(tmp_path / "out"))[1]
    assert "on 3 processes" in out
    assert on_formulas == [3]


def test_the_cost_of_a_pilot_counts_what_each_material_takes(
    bulkcal, tmp_path: Path, rng, on_formulas
) -> None:
    """Small grains take longer; the pilot of both takes what each of its runs takes."""
    heaps = [Measurement(name, "glued", "heap", "angle_deg") for name in ("A", "B")]
    study = planted_study(tmp_path, heaps, rng).path
    found = json.loads(bulkcal("check", str(study), "--json", "--workers", "1")[1])
    seconds = [place["run_s"] for place in found["places"]]
    assert seconds[0] > 1.2 * seconds[1]
    each = found["pilot_runs"] / len(seconds)
    assert found["pilot_s"] == pytest.approx(each * sum(seconds), rel=0.1)


@pytest.mark.parametrize("words", [["check"], ["calibrate"], ["calibrate", "--dry-run"]])
def test_too_small_a_start_is_told_before_anything_runs(
    bulkcal, tmp_path: Path, rng, on_formulas, words
) -> None:
    places = [Measurement("A", "glued", "heap", "angle_deg")]
    free = ("mu_pp", "mu_roll_pp")
    data = planted_study(tmp_path, places, rng, free=free, design="start = 4")
    out = tmp_path / "out"
    code, _, err = bulkcal(words[0], str(data.path), "--out", str(out), *words[1:])
    assert code == 2
    assert "[design] start: gives 4 points of heap on a glued surface" in err
    assert not on_formulas
    assert not out.exists()
