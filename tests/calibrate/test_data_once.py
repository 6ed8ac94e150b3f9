"""`bulkcal diagnose` reads every file of the study once, draws once and writes its report once."""

from __future__ import annotations

import json
import sys
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from calibrate.cli import calibrate_study, diagnose_study
from calibrate.cli.joint import study as joint_study
from calibrate.report import page
from tests.calibrate.causes.studies import FEW

_watched: list[Counter[str]] = []


def _note(event: str, arguments: tuple[object, ...]) -> None:
    """Note a file that is opened; the interpreter keeps the hook to its end."""
    if event == "open" and _watched and isinstance(arguments[0], str):
        _watched[-1][arguments[0]] += 1


sys.addaudithook(_note)


@contextmanager
def opened() -> Iterator[Counter[str]]:
    """Count how often each file is opened, by whatever function."""
    _watched.append(Counter())
    yield _watched[-1]
    _watched.pop()


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """Count the calls of what draws and what writes the report."""
    found: Counter[str] = Counter()
    places = {
        calibrate_study: ["write_report", "write_calibration"],
        joint_study: ["write_joint", "add_joint_section"],
        diagnose_study: ["opaque_png", "write_diagnosis", "add_diagnosis_section"],
        page: ["stage_figure", "quality_figure", "interval_figure"],
    }
    for module, names in places.items():
        for name in names:
            monkeypatch.setattr(module, name, _counted(getattr(module, name), name, found))
    return found


def _counted(function, name: str, found: Counter[str]):
    def call(*words, **more):
        found[name] += 1
        return function(*words, **more)

    return call


def test_one_diagnosis_reads_draws_and_writes_once(
    bulkcal, small_study: Path, tmp_path: Path, on_stand_in, calls: Counter[str], monkeypatch
) -> None:
    monkeypatch.setitem(diagnose_study.diagnose_study.__kwdefaults__, "options", FEW)
    out = tmp_path / "result"
    assert bulkcal("calibrate", str(small_study), "--out", str(out), "--mode", "staged")[0] == 0
    calls.clear()
    with opened() as files:
        code, shown, err = bulkcal("diagnose", str(small_study), "--out", str(out))
    assert code == 0, err
    data = [small_study, *(tmp_path / f"{n}.csv" for n in ("angle_of_repose", "conveyor"))]
    assert {p.name: files[str(p)] for p in data} == {p.name: 1 for p in data}
    assert set(calls.values()) == {1}, calls
    assert len(calls) == 5  # the stages and their figures stand in the report already
    report = (out / "report.html").read_text(encoding="utf-8")
    assert report.count('<section id="what-the-simulation-gets-wrong">') == 1
    record = json.loads((out / "diagnosis.json").read_text(encoding="utf-8"))
    assert record["sentences"][0] in shown
    assert {p.name for p in out.iterdir()} >= {
        "runs", "runs.csv", "calibration.json", "report.html",
        "diagnosis.json", "diagnosis.png", "diagnosis.html",
    }  # fmt: skip
