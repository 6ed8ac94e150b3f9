"""Runs as a table: what was asked and seen comes back, and a study learns from it."""

from __future__ import annotations

import dataclasses
import gzip
from pathlib import Path

import numpy as np
import pytest

from calibrate.errors import CalibrationError
from calibrate.questions.core.design import first_cases, joint_rng
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.stored import question, stored_runs, tabled_runs
from calibrate.questions.joint.calibration import calibrate_jointly
from calibrate.questions.joint.knowledge import fit_jointly
from calibrate.report.joint.tables import check_words
from calibrate.runs.table import TableRow, digest_of, finished_rows, read_rows, write_rows
from calibrate.study.data import load_data
from calibrate.study.resources import cases_directory
from liggghts_io import CaseResult, CaseSpec, case_id, execute, read_experiment
from tests.calibrate.questions import planted
from tests.calibrate.questions.planted import TRUTH, bench, planted_study
from tests.liggghts_io.conftest import ONE_DIAMETER
from tests.liggghts_io.own.folders import make_folder

FACTS = {"engine_code": "", "observables_code": "", "script": "", "digest": "", "steps": 1,
         "grains": 1}  # fmt: skip


def rows_of(runs) -> list[TableRow]:
    return [
        TableRow(spec, CaseResult(one["case_id"], Path(), "ok", "", planted.observed(spec), 0.01),
                 FACTS)
        for spec, one in zip(runs.specs, runs.table.to_dict("records"), strict=True)
    ]  # fmt: skip


@pytest.fixture
def calibrated(tmp_path):
    data = planted_study(
        tmp_path, bench("A", "glued"), np.random.default_rng(5), design="runs = 60"
    )
    return data, calibrate_jointly(data, planted.run)


@pytest.mark.parametrize("name", ["runs.csv", "runs.csv.gz"])
def test_a_table_gives_back_every_input_and_number(tmp_path, name) -> None:
    spec = CaseSpec(
        "conveyor", ONE_DIAMETER, "flat", "quick", {n: 0.1 + 1 / 3 for n in TRUTH},
        {"plate_width_m": 0.1 / 3}, {"plate_tilt_deg": 1.5}, 7,
    )  # fmt: skip
    good = CaseResult("a", Path(), "ok", "", {"t100_s": 10.0 / 3.0}, 1.25)
    bad = CaseResult("b", Path(), "failed", 'no heap, #3 "odd"', {}, 2.0, "physics")
    other = dataclasses.replace(spec, experiment="heap", apparatus={}, effects={})
    curves = {"mass_time@0": 1.0 / 3.0, "mass_time@12": 2.5}
    rows = [TableRow(spec, good, FACTS, curves), TableRow(other, bad, FACTS)]
    path = tmp_path / name
    assert write_rows(path, rows, "ours") == 2
    assert read_rows(path) == rows
    once = path.read_bytes()
    write_rows(path, rows, "ours")
    assert path.read_bytes() == once


def test_a_fit_to_a_table_is_the_one_to_the_runs_themselves(calibrated, tmp_path) -> None:
    data, result = calibrated
    path = tmp_path / "runs.csv.gz"
    write_rows(path, rows_of(result.runs), "planted")
    runs = tabled_runs(data, forms_of(data), path)
    assert len(runs) == len(result.runs)
    there, again = fit_jointly(data, result.runs), fit_jointly(data, runs)
    np.testing.assert_array_equal(there.posterior.samples, again.posterior.samples)
    for name in ("mu_pp", "mu_roll_pp"):
        span = again.posterior.interval(name, 0.99)
        assert span.low <= TRUTH[name] <= span.high
    assert "no engine has checked" in again.sentences[-1]
    assert {row.simulated for row in check_words(again)} == {"not run"}
    assert again.checked is False
    assert result.checked is True


def test_runs_of_other_grains_are_left_out(calibrated, tmp_path) -> None:
    _, result = calibrated
    other = planted_study(
        tmp_path, bench("B", "glued"), np.random.default_rng(5), design="runs = 60",
        more="[effects]\ncohesion_J_m3 = 100.0",
    )  # fmt: skip
    path = tmp_path / "runs.csv"
    write_rows(path, rows_of(result.runs), "planted")
    with pytest.raises(CalibrationError, match=r"none of the \d+ runs is one of study.toml"):
        tabled_runs(other, forms_of(other), path)


def test_a_study_finds_its_own_runs_again_in_case_directories_and_in_a_table(tmp_path) -> None:
    # Its grains have measured sizes because it says nothing; a record says that they have.
    data = load_data(cases_directory() / "proppants" / "hsp13.toml")
    forms = forms_of(data)
    first = first_cases(data.study, forms, joint_rng(data.study))
    spec = next(one for one in first if one.experiment == "conveyor")
    result = execute(spec, tmp_path / "runs")
    write_rows(tmp_path / "runs.csv", finished_rows(tmp_path / "runs"), "one")
    for runs in (
        stored_runs(data, forms, tmp_path / "runs"),
        tabled_runs(data, forms, tmp_path / "runs.csv"),
    ):
        assert runs is not None
        assert list(runs.table["case_id"]) == [result.case_id]
        # Who asks for what is missing leaves the sizes open.
        assert question(runs.specs[0]) == question(spec)


# Without the time of day, which would give the test another name in every process.
PACKED = gzip.compress(b"x", mtime=0)


@pytest.mark.parametrize("content", [b"", b"# one\na,b\n1,2\n", b"\xff\x00", PACKED])
def test_what_is_no_table_is_refused_with_the_command_that_makes_one(tmp_path, content) -> None:
    path = tmp_path / "odd.csv"
    path.write_bytes(content)
    with pytest.raises(CalibrationError, match=r"bulkcal runs DIR odd\.csv"):
        read_rows(path)


def test_a_table_that_was_cut_or_changed_is_refused(tmp_path) -> None:
    spec = CaseSpec("heap", ONE_DIAMETER, "glued", "quick", TRUTH, seed=3)
    one = CaseResult("a", Path(), "ok", "", {"angle_deg": 30.25}, 1.25)
    path = tmp_path / "runs.csv"
    write_rows(path, [TableRow(spec, one, FACTS)] * 3, "ours")
    text = path.read_text(encoding="utf-8")
    head, body = text.split("\n", 1)
    plain = head.partition(";")[0]  # as earlier versions wrote it
    # Every shorter file is refused: one cut in a number would else be a table with another one.
    last = len(body) - len(body.splitlines()[-1]) - 1
    wrong = [f"{head}\n{body[:k]}" for k in range(last, len(body))]
    wrong += [f"{plain}\n{body[:k]}" for k in range(last + 1, len(body))]
    wrong.append(text.replace("30.25", "30.35", 1))
    for one_text in wrong:
        path.write_text(one_text, encoding="utf-8")
        with pytest.raises(CalibrationError, match=r"'bulkcal runs DIR runs\.csv' writes one"):
            read_rows(path)
    for whole in (f"{plain}\n{body}", text.replace("\n", "\r\n")):
        path.write_bytes(whole.encode())
        assert len(read_rows(path)) == 3


def test_finished_runs_of_a_directory_become_rows_that_run_again_alike(tmp_path) -> None:
    spec = CaseSpec(
        "plate_impact", ONE_DIAMETER, "flat", "quick", TRUTH, {"mass_fraction": 0.01}, seed=3
    )
    result = execute(spec, tmp_path / "runs")
    (tmp_path / "runs" / "no_case").mkdir()
    (row,) = finished_rows(tmp_path / "runs")
    write_rows(tmp_path / "runs.csv.gz", [row], "one")
    (kept,) = read_rows(tmp_path / "runs.csv.gz")
    assert case_id(kept.spec) == result.case_id == kept.result.case_id
    again = execute(kept.spec, tmp_path / "again")
    assert digest_of(again) == kept.facts["digest"]
    assert kept.facts["steps"] > 0
    assert kept.facts["grains"] > 0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("runs", "nowhere", "t.csv"), "no such directory"),
        (("runs", ".", "t.txt"), "ends in .csv or .csv.gz"),
        (("runs", ".", "t.csv"), "holds no finished run"),
    ],
)
def test_runs_refuses_what_it_cannot_keep(bulkcal, tmp_path, monkeypatch, words, said) -> None:
    monkeypatch.chdir(tmp_path)
    code, _, err = bulkcal(*words)
    assert code == 2
    assert said in " ".join(err.split())
    assert not list(tmp_path.iterdir())


def test_stages_do_not_fit_to_a_table(bulkcal, tmp_path) -> None:
    study = cases_directory() / "proppants" / "hsp13_steel.toml"
    words = ("--runs", "t.csv", "--mode", "staged", "--out", str(tmp_path / "out"))
    code, _, err = bulkcal("calibrate", str(study), *words)
    assert code == 2
    assert "with --runs use --mode joint" in " ".join(err.split())
    assert not (tmp_path / "out").exists()


def test_runs_writes_over_a_table_of_runs_and_over_nothing_else(bulkcal, tmp_path) -> None:
    spec = CaseSpec(
        "plate_impact", ONE_DIAMETER, "flat", "quick", TRUTH, {"mass_fraction": 0.01}, seed=3
    )
    execute(spec, tmp_path / "runs")
    for name in ("mine.csv", "mine.csv.gz"):
        path = tmp_path / name
        path.write_text("target,value\nangle,36\n", encoding="utf-8")
        code, _, err = bulkcal("runs", str(tmp_path), str(path))
        assert (code, "is not written over; name another file" in err) == (2, True)
        assert path.read_text(encoding="utf-8") == "target,value\nangle,36\n"
        path.unlink()
        for _ in range(2):
            assert bulkcal("runs", str(tmp_path), str(path))[0] == 0
        assert len(read_rows(path)) == 1


def test_runs_of_an_own_experiment_are_kept_and_count_with_the_same_folder_only(tmp_path) -> None:
    own = read_experiment(make_folder(tmp_path / "fall"))
    numbers = {"mu_pp": 0.4, "e_pp": 0.7}
    spec = CaseSpec(own.name, ONE_DIAMETER, "flat", "quick", numbers, own=own)
    result = execute(spec, tmp_path / "runs")
    made = finished_rows(tmp_path / "runs")
    assert [row.result.case_id for row in made] == [result.case_id]
    path = tmp_path / "runs.csv"
    write_rows(path, made, "one")
    (kept,) = read_rows(path, [own])
    assert kept.spec == made[0].spec
    assert kept.result.observables == result.observables
    changed = dataclasses.replace(own, script=own.script.replace("run 8000", "run 7000"))
    assert read_rows(path, [changed]) == read_rows(path) == []
