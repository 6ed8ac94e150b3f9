"""`bulkcal diagnose --with`: what it asks for, what it writes, what it refuses."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from calibrate.cli.diagnosis import what_if
from calibrate.questions.core.runs import with_curves
from calibrate.report.record_file import read_record
from calibrate.runs.campaign import run_table
from tests.calibrate import stand_in
from tests.calibrate.causes import studies
from tests.calibrate.causes.studies import LEVEL, PERIOD, SHEAR


@pytest.fixture
def quick(on_stand_in, monkeypatch):
    """Let effects act on the stand-in, and imagine few studies; returns the cases asked for."""

    def named(names, forms, root, stored):
        specs = {stand_in.case_id(spec): spec for spec in on_stand_in}
        if any(not (root / name / "result.json").exists() for name in names):
            return None
        kept = [specs[name] for name in names]
        results = [stand_in.execute(spec, root) for spec in kept]
        return with_curves(kept, run_table(kept, results), forms)

    monkeypatch.setattr(stand_in, "simulate", studies.observed)
    monkeypatch.setattr(what_if, "runs_named", named)
    monkeypatch.setitem(what_if.what_if_study.__kwdefaults__, "options", studies.FEW)
    return on_stand_in


def _contents(out: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(out)): path.read_bytes()
        for path in sorted(out.rglob("*"))
        if path.is_file() and "what_if" not in path.parts
    }


def test_from_a_set_to_a_name_without_a_run(bulkcal, quick, tmp_path: Path) -> None:
    data, out = studies.study(tmp_path, {PERIOD: 0.15}, 5, LEVEL + SHEAR), tmp_path / "out"
    words = ("diagnose", str(data.path), "--out", str(out), "--more", "16")
    asked = (*words, "--with", "plate_period = 0.15 ± 0.002")
    place = "what_if/plate_period=0.15+-0.002"
    plan = json.loads(bulkcal(*asked, "--dry-run", "--json")[1])
    assert plan["what if"] == ["plate_period=0.15+-0.002"]
    assert f"{place}/diagnosis.json" in plan["would write"]
    assert "diagnosis.json" in plan["would write"]  # the plain one is made first
    assert not out.exists()
    code, said, err = bulkcal(*asked)
    assert code == 0, err
    assert "holds no diagnosis of this study with all its runs; it is made first" in err
    before, after = read_record(out / "diagnosis.json"), read_record(out / place / "diagnosis.json")
    assert (before["verdict"], after["verdict"]) == ("set", "named")
    assert after["names"] == [PERIOD]
    assert after["before"]["probabilities"] == before["probabilities"]
    assert after["runs"] == before["runs"]
    was, now = (record["inclusion"][PERIOD] for record in (before, after))
    (row,) = [line for line in said.splitlines() if line.startswith("│ plate_period ")]
    shown = [cell.strip() for cell in row.split("│")[2:5]]
    assert shown == [f"{was:.2f}", f"{now:.2f}", f"{now - was:+.2f}"]
    assert "What if plate_period = 0.15" in said
    assert after["headline"] in said
    for name in ("diagnosis.png", "diagnosis.html"):
        assert (out / place / name).stat().st_size > 1000
    page = (out / place / "diagnosis.html").read_text(encoding="utf-8")
    assert "had been measured</h3>" in page
    _again_and_beside(bulkcal, quick, out, words)


def _again_and_beside(bulkcal, quick, out: Path, words: tuple[str, ...]) -> None:
    """Ask more of the same directory: no run, and nothing of the diagnosis is changed."""
    kept, count = _contents(out), len(quick)
    asked = ("--with", "plate_period=0+-0.002", "--with", "plate_tilt_deg:=0+-1")
    assert bulkcal(*words, *asked)[0] == 2  # nothing behind the colon
    asked = ("--with", "plate_period=0+-0.002", "--with", "plate_tilt_deg=0+-1")
    plan = bulkcal(*words, *asked, "--dry-run")[1]
    assert "no run; the " in plan
    code, said, err = bulkcal(*words, *asked, "--json")
    assert code == 0, err
    assert "--with replaces what the study says under [known]: plate_tilt_deg = 0 ± 0.05" in err
    assert len(quick) == count
    assert _contents(out) == kept
    folder = out / "what_if" / "plate_period=0+-0.002_plate_tilt_deg=0+-1"
    assert json.loads(said) == json.loads((folder / "diagnosis.json").read_text())
    assert json.loads(said)["inclusion"][PERIOD] < 0.05
    status = bulkcal("status", str(out))[1]
    assert "what if plate_period=0.15+-0.002: Named cause" in status
    # The next measurement of the plain diagnosis is the one that was supposed.
    offers = read_record(out / "diagnosis.json")["measure_next"]["offers"]
    assert offers[0]["name"] == PERIOD
    html = (out / "diagnosis.html").read_text(encoding="utf-8")
    assert "<h3>What to measure next</h3>" in html
    assert offers[0]["words"] in html


@pytest.mark.parametrize(
    ("word", "expected"),
    [
        ("plate_perod=0+-0.005", "did you mean 'plate_period'?"),
        ("plate_period", 'write --with NAME=VALUE+-ERROR'),
        ("plate_period=0", "has no standard error"),
        ("plate_period=x+-0.1", "'x' is not a number"),
        ("plate_period=nan+-0.1", "'nan' is not a number"),
        ("plate_period=0+-", "'' is not a number"),
        ("plate_period=0+--0.1", "standard error -0.1: give a number above 0"),
        ("plate_period=0+-0", "standard error 0: give a number above 0"),
        ("plate_period=0+-1+-2", "write --with NAME=VALUE+-ERROR"),
        ("=0+-1", "write --with NAME=VALUE+-ERROR"),
        ("plate_period:conveyor=0+-1", "leave out ':conveyor'"),
        ("plate_period=9+-0.1", "lies outside -0.3 to 0.3"),
        ("mu_pw=0.5+-0.1", "mu_pw is not free in this study; free it under"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("more", [(), ("--dry-run",)])
def test_what_cannot_be_is_refused_before_any_work(
    bulkcal, on_stand_in, small_study: Path, tmp_path: Path, word: str, expected: str, more
) -> None:
    out = tmp_path / "out"
    code, said, err = bulkcal(
        "diagnose", str(small_study), "--out", str(out), "--with", word, *more
    )
    assert (code, said) == (2, "")
    assert f"--with {word.partition('=')[0]}" in " ".join(err.split())
    assert expected in " ".join(err.split())
    assert "Traceback" not in err
    assert not out.exists()
    assert on_stand_in == []


def test_one_number_is_not_given_twice(bulkcal, small_study: Path, tmp_path: Path) -> None:
    twice = ("--with", "plate_period=0+-0.1", "--with", "plate_period = 0.1 +/- 0.1")
    code, _, err = bulkcal("diagnose", str(small_study), "--out", str(tmp_path / "o"), *twice)
    assert code == 2
    assert "'plate_period' is given twice; join the measurements into one" in " ".join(err.split())
