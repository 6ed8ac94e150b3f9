"""`bulkcal diagnose`: what it asks for, what it writes, how it ends early and goes on."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from calibrate.cli import diagnose_study
from calibrate.questions.core.runs import with_curves
from calibrate.report.record_file import read_record
from calibrate.runs.campaign import run_table
from calibrate.runs.table import TableRow, write_rows
from calibrate.study.data import StudyData
from calibrate.study.load import load_study
from liggghts_io import CaseResult, CaseSpec, load_spec
from tests.calibrate import stand_in
from tests.calibrate.causes import studies

TILT = "plate_tilt_deg"


@pytest.fixture
def quick(on_stand_in, monkeypatch):
    """Let effects act on the stand-in, and imagine few studies; returns the cases asked for."""

    def stored(data, forms, root, named):
        specs = {stand_in.case_id(spec): spec for spec in on_stand_in}
        names = sorted(name for name in named if (root / name / "result.json").exists())
        results = [stand_in.execute(specs[name], root) for name in names]
        kept = [specs[name] for name in names]
        return with_curves(kept, run_table(kept, results), forms) if kept else None

    monkeypatch.setattr(stand_in, "simulate", studies.observed)
    monkeypatch.setattr(diagnose_study, "stored_runs", stored)
    for one in (diagnose_study.diagnose_study, diagnose_study.diagnose_tables):
        monkeypatch.setitem(one.__kwdefaults__, "options", studies.FEW)
    return on_stand_in


def test_a_hidden_tilt_from_nothing_to_an_extended_study(bulkcal, quick, tmp_path: Path) -> None:
    # A wrong flow and a wrong period look much the same, and what is in no library does where
    # friction is open.
    known = "[known.mass_flow_factor]\nse = 0.01\n[known.plate_period]\nse = 0.002\n"
    data = studies.study(tmp_path, {TILT: 5.0}, 5, known + studies.SHEAR)
    out = tmp_path / "out"
    words = ("diagnose", str(data.path), "--out", str(out), "--more", "16")
    plan = bulkcal(*words, "--dry-run")[1]
    assert "the joint calibration is made, there is none that fits" in plan
    assert not out.exists()
    code, said, err = bulkcal(*words)
    assert code == 0, err
    assert "holds no joint calibration; it is made first" in err
    record = read_record(out / "diagnosis.json")
    assert f"Named cause: Tilted conveyor plate ({TILT} = " in said
    assert (record["verdict"], record["names"]) == ("named", [TILT])
    assert record["added"] > 0
    assert record["sentences"][0] in said
    before, after = (
        sum(row["z"] ** 2 for row in record[what]) for what in ("engine_before", "engine_after")
    )
    assert after < before
    page = (out / "report.html").read_text(encoding="utf-8")
    assert page.count('<section id="what-the-simulation-gets-wrong">') == 1
    assert page.index('id="all-targets-at-once"') < page.index('id="what-the-simulation')
    _extended(out, record, said)
    assert f"diagnosed: {record['headline']}" in bulkcal("status", str(out))[1]
    # Started again: the same decisions, no case that was not there.
    count = len(quick)
    plan = json.loads(bulkcal(*words, "--dry-run", "--json")[1])["diagnosis"]
    base = len(record["runs"]) - record["twins"] - record["added"]
    assert plan[0] == f"{base} runs of the joint calibration are used"
    first = plan[1].split()
    assert first[6] == first[8]  # of as many runs as many are stored
    code, again, err = bulkcal(*words)
    assert "runs of the joint calibration in" in err
    assert len(quick) == count
    assert read_record(out / "diagnosis.json") == record
    assert again == said
    _from_a_table(bulkcal, quick, tmp_path, data, record)


def _from_a_table(bulkcal, quick, tmp_path: Path, data: StudyData, record: dict) -> None:
    """Check that the runs as a table say the same to somebody who has nothing else."""
    count = len(quick)
    table = _table(quick, record["runs"], tmp_path / "runs.csv.gz")
    fit = ("calibrate", str(data.path), "--runs", str(table), "--out", str(tmp_path / "fitted"))
    assert f"of {table} that are of this study; nothing is run" in bulkcal(*fit, "--dry-run")[1]
    words = ("diagnose", str(data.path), "--runs", str(table), "--out", str(tmp_path / "told"))
    assert f"the {len(record['runs'])} runs of {table}" in bulkcal(*words, "--dry-run")[1]
    code, said, err = bulkcal(*words)
    assert code == 0, err
    assert len(quick) == count
    told = read_record(tmp_path / "told" / "diagnosis.json")
    assert (told["verdict"], told["names"]) == ("named", [TILT])
    assert set(told["runs"]) == set(record["runs"])
    assert told["twins"] >= record["twins"]  # some that were added later are twins, too
    assert told["headline"] in said
    assert f"report: {tmp_path / 'told' / 'diagnosis.html'}" in said
    assert "Engine" not in said
    # Asked for, the engine runs at the best values, without and with the cause, and nowhere else.
    assert "the engine at the best values: up to" in bulkcal(*words, "--check", "--dry-run")[1]
    code, said, err = bulkcal(*words, "--check")
    assert code == 0, err
    assert "Engine" in said
    assert count < len(quick) <= count + 2 * len(data.study.places) * data.study.design.check_seeds
    checked = read_record(tmp_path / "told" / "diagnosis.json")
    assert [row["name"] for row in checked["engine_after"]] == [
        row["name"] for row in record["engine_after"]
    ]
    assert (checked["headline"], checked["runs"]) == (told["headline"], told["runs"])
    assert "--check" in checked["provenance"]["command"]


def _table(specs: list[CaseSpec], names: list[str], path: Path) -> Path:
    """Write finished runs as a table."""
    known = {stand_in.case_id(spec): spec for spec in specs}
    facts = {"engine_code": "formulas", "observables_code": "", "script": "", "digest": "",
             "steps": 1, "grains": 1}  # fmt: skip
    rows = [TableRow(known[name], _result(known[name], name), facts) for name in names]
    write_rows(path, rows, "of this test")
    return path


def _result(spec: CaseSpec, name: str) -> CaseResult:
    return CaseResult(name, Path(), "ok", "", stand_in.simulate(spec), 0.1)


def test_a_table_leaves_nothing_to_run(bulkcal, quick, tmp_path: Path) -> None:
    data = studies.study(tmp_path, {}, 5)
    words = ("diagnose", str(data.path), "--runs", str(tmp_path / "none.csv"))
    code, _, err = bulkcal(*words, "--more", "16")
    assert code == 2
    assert "--runs runs nothing" in err
    code, _, err = bulkcal(*words)
    assert code == 2
    assert "none.csv" in err
    code, _, err = bulkcal(*words[:2], "--check")
    assert code == 2
    assert "--check goes with --runs" in err
    assert not quick


def _extended(out: Path, record: dict, said: str) -> None:
    """Check the extended study: it loads, frees the cause, and its cases differ by it alone."""
    file, *cases = map(Path, record["extended"])
    study = load_study(file)
    strength = study.parameters[TILT].value[""]
    assert study.range_of(TILT, "") is not None
    row = next(one for one in record["candidates"] if one["name"] == TILT)
    assert row["low_95"] <= strength <= row["high_95"]
    assert f"next: bulkcal calibrate {file} --mode joint" in said
    on = {case.name: load_spec(case) for case in cases}
    assert set(on) == {
        "conveyor_steel", "conveyor_steel_without", "conveyor_glued", "conveyor_glued_without",
    }  # fmt: skip
    for name in ("conveyor_steel", "conveyor_glued"):
        assert on[name].effects == {TILT: strength}
        assert on[f"{name}_without"].effects == {}
        assert on[name].parameters == on[f"{name}_without"].parameters
    assert out in file.parents


@pytest.mark.long
def test_interrupted_it_goes_on_beside_the_stages(
    bulkcal, quick, small_study: Path, tmp_path: Path, monkeypatch
) -> None:
    out = tmp_path / "out"
    assert bulkcal("calibrate", str(small_study), "--out", str(out))[0] == 0
    words = ("diagnose", str(small_study), "--out", str(out))
    count, real = len(quick), stand_in.execute

    def stopped(spec, root):
        if len(quick) > count + 5:
            raise KeyboardInterrupt
        return real(spec, root)

    monkeypatch.setattr(stand_in, "execute", stopped)
    code, _, err = bulkcal(*words)
    assert code == 130
    assert f"Continue with: bulkcal {' '.join(words)}" in err
    assert "diagnosis: has begun and not ended" in bulkcal("status", str(out))[1]
    monkeypatch.setattr(stand_in, "execute", real)
    code, said, err = bulkcal(*words)
    assert code == 0, err
    assert "diagnosis: has begun" not in bulkcal("status", str(out))[1]
    record = read_record(out / "diagnosis.json")
    assert record["headline"] in said
    # The report has the stages, the joint calibration and the diagnosis, also when made anew.
    for _ in range(2):
        page = (out / "report.html").read_text(encoding="utf-8")
        for name in ("stages", "all-targets-at-once", "what-the-simulation-gets-wrong"):
            assert page.count(f'id="{name}"') == 1
        assert bulkcal("calibrate", str(small_study), "--out", str(out), "-q")[0] == 0


def test_a_damaged_record_is_refused_by_name(bulkcal, small_study: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    out.mkdir()
    (out / "calibration.json").write_text('{"joint": {}}', encoding="utf-8")
    for more in ((), ("--dry-run",)):
        code, _, err = bulkcal("diagnose", str(small_study), "--out", str(out), *more)
        assert code == 2
        assert "calibration.json: holds no calibration" in err
        assert "run 'bulkcal calibrate' again" in err


def test_a_directory_is_no_study(bulkcal, tmp_path: Path) -> None:
    code, _, err = bulkcal("diagnose", str(tmp_path / "nowhere"))
    assert code == 2
    assert "nowhere" in err
    assert "Traceback" not in err
