"""The studies that a stranger tries first (`cases/hidden`): what README says of them comes out."""

from __future__ import annotations

import json

import pytest

from calibrate.challenge.folders import TRUTHS
from calibrate.study.data import load_data
from tests.paths import ROOT

HIDDEN = ROOT / "cases" / "hidden"
RUNS = ROOT / "cases" / "challenge" / "runs" / "one_material.csv.gz"
AS_TOLD = 5e-3
"""Relative error of a strength that is told with two or three digits."""
STUDIES = {
    "a": ("study_0016", {"mass_flow_factor:conveyor_flat": -0.23}, "gives 23 % less"),
    "b": ("study_0046", {"cohesion_J_m3": 32500.0}, "32 500 J/m3"),
    "c": ("study_0002", {}, "nothing"),
}
"""Study: that of the seventh suite, what it hides, and the words for it."""


def _truth(name: str) -> dict[str, float]:
    kept = json.loads((ROOT / "cases" / "challenge" / "suite_7" / TRUTHS).read_text())
    return {one["name"]: one["strength"] for one in kept[STUDIES[name][0]]["hidden"]}


@pytest.mark.parametrize("name", STUDIES)
def test_the_answers_are_those_of_the_suite(name):
    _, hidden, words = STUDIES[name]
    lines = (HIDDEN / "README.md").read_text(encoding="utf-8").splitlines()
    (row,) = [line for line in lines if line.startswith(f"| {name} |")]
    assert words in row
    assert _truth(name) == pytest.approx(hidden, rel=AS_TOLD)
    assert load_data(HIDDEN / f"{name}.toml").study.name == f"hidden_{name}"


@pytest.mark.long
@pytest.mark.parametrize("name", STUDIES)
def test_what_is_hidden_is_named_and_sized(bulkcal, tmp_path, name):
    out = tmp_path / "out"
    study = str(HIDDEN / f"{name}.toml")
    code, _, err = bulkcal("diagnose", study, "--runs", str(RUNS), "--out", str(out), "-q")
    assert code == 0, err
    record = json.loads((out / "diagnosis.json").read_text())
    assert record["names"] == list(STUDIES[name][1])
    for cause, strength in _truth(name).items():
        (told,) = [one for one in record["candidates"] if one["name"] == cause]
        assert told["low_95"] <= strength <= told["high_95"]
