"""The `bulkcal` command, called in this process: every verb, and every kind of wrong input."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from calibrate.cli import diagnose_study, running, studies
from calibrate.cli.pairs import numbers_of
from calibrate.errors import CalibrationError
from calibrate.study.resources import bundled_study
from tests.calibrate.cli.words import PAIRS

VERBS = [
    "generate", "run", "post", "render", "apparatus", "calibrate", "demo", "diagnose", "retry",
    "runs",
]  # fmt: skip


@pytest.mark.parametrize("verb", VERBS)
def test_help_shows_an_example(verb: str, bulkcal):
    code, out, _ = bulkcal(verb, "--help")
    assert code == 0
    assert f"Example: bulkcal {verb}" in " ".join(out.split())


def test_help_lists_every_verb_and_where_to_start(bulkcal):
    code, out, _ = bulkcal("--help")
    assert code == 0
    for verb in VERBS:
        assert verb in out
    assert "Start with: bulkcal demo" in out


def test_generate_writes_a_case_and_says_what_comes_next(bulkcal, tmp_path: Path):
    case = tmp_path / "case"
    code, out, _ = bulkcal("generate", "heap", "--surface", "steel", *PAIRS, "--out", str(case))
    assert code == 0
    assert (case / "in.script").is_file()
    assert f"next: bulkcal run {case}" in out
    spec = json.loads((case / "case.json").read_text())["inputs"]["spec"]
    assert spec["parameters"]["mu_pp"] == 0.69
    assert spec["scale"] == "quick"


GENERATE = ["generate", "heap", "--out", "CASE"]
WRONG = {
    "verb": (["generat"], ["No such command 'generat'", "generate"]),
    "option": ([*GENERATE, "--surfce", "steel"], ["--surfce", "--surface"]),
    "missing out": (["generate", "heap"], ["--out"]),
    "experiment": (
        ["generate", "heep", *PAIRS, "--out", "CASE"],
        ["'heep'", "did you mean 'heap'?"],
    ),
    "surface": ([*GENERATE, *PAIRS, "--surface", "steal"], ["steal", "steel"]),
    "scale": ([*GENERATE, *PAIRS, "--scale", "quik"], ["'quik'", "did you mean 'quick'?"]),
    "particle": ([*GENERATE, *PAIRS, "--particle", "Carbo HSP31"], ["Carbo HSP13"]),
    "parameter": ([*GENERATE, "-p", "mu_qp=0.1"], ["unknown name 'mu_qp'", "did you mean 'mu_p"]),
    "no equals": ([*GENERATE, "-p", "mu_pp"], ["-p mu_pp", "name=value"]),
    "no number": ([*GENERATE, "-p", "mu_pp=high"], ["'high' is not a number"]),
    "nan": ([*GENERATE, "-p", "mu_pp=nan"], ["'nan' is not a number"]),
    "twice": ([*GENERATE, "-p", "mu_pp=1", "-p", "mu_pp=2"], ["'mu_pp' is given twice"]),
    "missing value": ([*GENERATE, *PAIRS[:-2]], ["e_pw"]),
    "out of range": ([*GENERATE, *PAIRS[:-2], "-p", "e_pw=1.7"], ["e_pw = 1.7"]),
    "apparatus": ([*GENERATE, *PAIRS, "-a", "pour_mas=1"], ["pour_mas", "did you mean"]),
    "effect": ([*GENERATE, *PAIRS, "-e", "cohesionn=1"], ["cohesionn"]),
    "run nowhere": (["run", "nowhere"], ["nowhere", "bulkcal generate"]),
    "run no case": (["run", "."], ["case.json", "missing"]),
    "post nowhere": (["post", "nowhere"], ["nowhere"]),
    "render nowhere": (["render", "nowhere"], ["nowhere"]),
    "engine": (["run", "OLD", "--engine", "minidemm"], ["'minidemm'", "did you mean 'minidem'?"]),
    "study": (["calibrate", "none.toml"], ["none.toml", "cannot be read"]),
    "study is a directory": (["calibrate", "."], ["cannot be read"]),
    "out is a file": (["demo", "--out", "FILE"], ["is a file"]),
}


@pytest.mark.parametrize("name", WRONG)
def test_mistake_ends_with_one_line_and_code_2(name: str, bulkcal, tmp_path: Path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "FILE").write_text("")
    words, expected = WRONG[name]
    if "OLD" in words:
        bulkcal("generate", "heap", *PAIRS, "--out", "OLD")
    code, out, err = bulkcal(*words)
    assert code == 2
    assert out == ""
    assert err.startswith("bulkcal: ")
    assert err.count("\n") == 1, err
    assert "Traceback" not in err
    for word in expected:
        assert word in err, err
    assert not (tmp_path / "CASE" / "in.script").exists()


def test_pairs_are_read():
    assert numbers_of("-p", ["a=1", "b=-2.5e-3"]) == {"a": 1.0, "b": -0.0025}
    with pytest.raises(CalibrationError, match="known names: mu_pp"):
        numbers_of("-p", ["zzz=1"], ["mu_pp"])


def test_calibrate_prints_the_tables_and_writes_report_record_and_runs(
    bulkcal, small_study: Path, tmp_path: Path, on_stand_in
):
    out = tmp_path / "result"
    words = ["calibrate", str(small_study), "--mode", "staged", "--out", str(out)]
    code, shown, err = bulkcal(*words)
    assert code == 0
    assert len(on_stand_in) == 28  # (10 + 2) points and 2 seeds, times 2 experiments
    for words in ("mu_pp", "90 % interval", "published", "angle of repose", "deviation", "0.694"):
        assert words in shown
    assert f"report: {out}/report.html" in shown
    assert f"next: open {out}/report.html" in shown
    assert "28 runs at scale 'quick'" in err
    assert (out / "report.html").is_file()
    assert len((out / "runs.csv").read_text().splitlines()) == 29
    assert "\x1b[" not in shown + err, "NO_COLOR was set"


def test_calibrate_json_is_the_record(bulkcal, small_study: Path, tmp_path: Path, on_stand_in):
    out = tmp_path / "result"
    code, shown, _ = bulkcal("calibrate", str(small_study), "--out", str(out), "--json")
    assert code == 0
    assert json.loads(shown) == json.loads((out / "calibration.json").read_text())


def test_interrupted_study_says_how_to_continue(
    bulkcal, small_study: Path, tmp_path: Path, on_stand_in, monkeypatch
):
    def interrupted(self, specs, label):
        raise KeyboardInterrupt

    monkeypatch.setattr(running.Campaign, "__call__", interrupted)
    out = tmp_path / "result"
    code, _, err = bulkcal("calibrate", str(small_study), "--out", str(out))
    assert code == 130
    assert f"Continue with: bulkcal calibrate {small_study} --out {out}" in " ".join(err.split())


def test_demo_is_the_bundled_study(bulkcal, tmp_path: Path, monkeypatch):
    seen = []

    def finish(study, out, command, mode, how, screen, as_json):
        seen.append((study, out, command, mode, how.workers, as_json))

    monkeypatch.setattr(studies, "_finish", finish)
    code, _, _ = bulkcal("demo", "--workers", "2")
    assert code == 0
    assert seen == [(bundled_study(), "demo", "bulkcal demo --out demo --workers 2", "", 2, False)]


def test_diagnose_is_handed_on(bulkcal, small_study: Path, tmp_path: Path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    seen = []

    def handed(data, out, command, how, *, twins, more, further, console):
        seen.append((data.study.name, out, command, how.workers, twins, more, further))
        (out / "diagnosis.json").write_text('{"verdict": "none"}\n')

    monkeypatch.setattr(diagnose_study, "diagnose_study", handed)
    code, shown, _ = bulkcal(
        "diagnose", str(small_study), "--out", "there", "--further", "0", "--json"
    )
    assert code == 0
    command = f"bulkcal diagnose {small_study} --out there --further 0"
    assert seen == [("hsp13_steel", Path("there"), command, 0, None, None, 0)]
    assert json.loads(shown) == {"verdict": "none"}
