"""Stages of studies with several materials and walls, and what cannot be asked yet."""

from __future__ import annotations

from pathlib import Path

import pytest

from calibrate.errors import CalibrationError
from calibrate.staged.calibration import calibrate
from calibrate.study.cases import planned
from calibrate.study.data import load_data
from calibrate.study.load import load_study
from calibrate.study.model import Study
from calibrate.study.places import Place
from calibrate.study.resources import cases_directory
from calibrate.study.write import study_text
from tests.calibrate.study.two import FREE, TARGETS, TWO

STAGES = "".join(
    f"""
[[stage]]
name = "pp_{material}"
material = "{material}"
free = ["mu_pp", "mu_roll_pp"]
range = {{ mu_pp = [0.2, 0.6] }}
targets = ["heap_{material}_steel", "conveyor_{material}_steel"]
points = 8
repeats = 2
"""
    for material in ("coarse", "fine")
)
VALUES = [(f"[parameter.{name}]\n", f"[parameter.{name}]\nvalue = 0.5\n")
          for name in ("mu_pw", "mu_roll_pw", "e_pp", "e_pw")]  # fmt: skip


def staged(tmp_path: Path) -> Path:
    text = TWO + TARGETS + FREE + STAGES
    for old, new in VALUES:
        text = text.replace(old, new)
    path = tmp_path / "staged.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_stages_of_several_materials_free_each_its_own(tmp_path: Path, runner):
    data = load_data(staged(tmp_path))
    study = data.study
    assert [study.freed(stage)["mu_pp"] for stage in study.stages] == ["coarse", "fine"]
    assert study.range_of("mu_pp", "fine", study.stages[1]) == (0.2, 0.6)
    runs = planned(study)
    assert runs[Place("fine", "steel", "heap")] == 8 + 2 + 3
    assert runs[Place("coarse", "brass", "heap")] == 3
    result = calibrate(data, runner)
    assert 0.2 <= result.parameters["mu_pp coarse"] <= 0.6
    assert result.parameters["mu_pp coarse"] == result.stages[0].found["mu_pp"]
    assert result.parameters["mu_pp fine"] == result.stages[1].found["mu_pp"]
    assert result.parameters["e_pw coarse/brass"] == 0.5
    assert set(result.runs["material"]) == {"coarse", "fine"}
    brass = result.check_runs[result.check_runs["surface"] == "brass"]
    assert len(brass) == 2 * 3  # told apart from steel, though the cases are the same
    load_study(_again(study, tmp_path))


def _again(study: Study, tmp_path: Path) -> Path:
    path = tmp_path / "again.toml"
    path.write_text(study_text(study), encoding="utf-8")
    assert load_study(path) == study
    return path


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('material = "fine"\nfree', "free", "stage 'pp_fine': key 'material' is missing; the"),
        ('material = "fine"\nfree', 'material = "coarse"\nfree', "stage 'pp_fine' is for coarse"),
        ('"heap_fine_steel", ', "", "has 1 measured number for 2 free parameters; give it 2"),
        ('["heap_fine_steel", "conveyor_fine_steel"]', '["heap_fine_steel", "heap_fine_wood"]',
         "targets: unknown name 'heap_fine_wood'; did you mean"),
        ('"mu_roll_pp"]', '"mu_roll_pp", "e_pp"]', "has 2 measured numbers for 3 free parameters"),
        ('["mu_pp", "mu_roll_pp"]', '["mu_pp", "mu_rol_pp"]', "free: unknown name 'mu_rol_pp'"),
        ("range = { mu_pp = [0.2", "range = { mu_pp = [0.9", "is no range; give"),
        ("value = 0.5\nrange = [0.1, 0.8]\n\n[parameter.mu_roll_pw", "range = [0.1, 0.8]\n\n"
         "[parameter.mu_roll_pw", "'mu_pw' of coarse/steel has no value in stage 'pp_coarse'"),
    ],
)  # fmt: skip
def test_stages_that_cannot_be_are_told(tmp_path: Path, runner, old, new, expected: str):
    path = staged(tmp_path)
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new) if "mu_rol" in new or "e_pp" in new
                    else text.replace(old, new, 1))  # fmt: skip
    with pytest.raises(CalibrationError) as caught:
        calibrate(load_data(path), runner)
    assert expected in str(caught.value)


def test_a_wall_of_two_values_is_freed_in_two_stages(tmp_path: Path):
    text = (
        staged(tmp_path).read_text()
        + """
[[stage]]
name = "wall"
material = "coarse"
free = ["mu_pw", "mu_roll_pw"]
targets = ["heap_coarse_steel", "heap_coarse_brass"]
points = 8
"""
    )
    path = tmp_path / "wall.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(CalibrationError, match=r"'mu_pw' has 2 values in this stage, coarse/brass"):
        load_study(path)


def test_a_study_without_stages_is_told_so(runner):
    data = load_data(cases_directory() / "proppants" / "proppants.toml")
    with pytest.raises(CalibrationError, match=r"has no \[\[stage\]\]; a calibration by stages"):
        calibrate(data, runner)
