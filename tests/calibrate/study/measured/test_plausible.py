"""Measured values against what was poured: impossible ones are refused, odd ones told."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from calibrate.errors import CalibrationError
from calibrate.runs import cost
from calibrate.study.checks.plausible import guessed_walls
from calibrate.study.data import StudyData, load_data
from calibrate.study.load import load_study
from calibrate.study.write import study_text
from tests.calibrate import stand_in

HEAD = """
name = "amounts"

[[material]]
name = "Sand"
d32_um = 1500.0
density_kg_m3 = 2500.0
flow_flat_g_s = 20.0
flow_glued_g_s = 20.0
impact_mass_g = 30.0

[[surface]]
name = "steel"
"""
GLUED = "".join(
    f"\n[parameter.{name}]\nrange = [0.1, 0.8]\n" for name in ("mu_pp", "mu_roll_pp", "e_pp")
)
FREE = GLUED + "".join(
    f"\n[parameter.{name}]\nrange = [0.1, 0.8]\n" for name in ("mu_pw", "mu_roll_pw", "e_pw")
)
UNITS = {"heap": "deg", "conveyor": "s", "plate_impact": "g"}


def target(experiment: str, observable: str, value: float, se: float = 0.1, unit: str = "") -> str:
    return f"""
[[target]]
name = "{observable}"
experiment = "{experiment}"
observable = "{observable}"
unit = "{unit or UNITS[experiment]}"
value = {value}
se = {se}
"""


@pytest.fixture
def loaded(tmp_path: Path):
    """Return a function that loads a study with targets."""

    def load(*targets: str, head: str = HEAD, free: str = FREE) -> StudyData:
        path = tmp_path / "study.toml"
        path.write_text(head + "".join(targets) + free, encoding="utf-8")
        return load_data(path)

    return load


def boxes(*masses: float) -> list[str]:
    names = ("m1_g", "m2_g", "m3_g", "m4_g", "beside_g")
    return [target("plate_impact", *one) for one in zip(names, masses, strict=False)]


@pytest.mark.parametrize(
    ("targets", "words"),
    [
        (boxes(3000.0), "target 'm1_g': 3000 g, but 30 g were poured (impact_mass_g)"),
        (boxes(29.0, 20.0), "m1_g, m2_g are 49 g together, but 30 g were poured"),
        ([target("conveyor", "t100_s", 9807.0)], "300 g leave the funnel within 15 s"),
        ([target("conveyor", "t100_s", 163.0, 1.0, "min")], "and a run lasts"),
    ],
)
def test_what_cannot_have_been_measured_is_a_mistake(loaded, targets, words):
    with pytest.raises(CalibrationError) as caught:
        loaded(*targets)
    assert words in str(caught.value)
    assert "study.toml:" in str(caught.value)


@pytest.mark.parametrize(
    ("targets", "words"),
    [
        # A twentieth more than was poured is a scale that is off, not a slip.
        (boxes(20.0, 11.5), "31.5 g together, but 30 g were poured"),
        (boxes(5.0, 5.0, 5.0, 1.0, 1.0), "where is the rest?"),
        # 100 g of 20 g/s take 5 s to be poured.
        ([target("conveyor", "t100_s", 3.0)], "the funnel pours them in 5 s"),
        ([target("conveyor", "t100_s", 60.0)], "no run lasts longer than"),
        ([target("heap", "angle_deg", 0.6, 0.01)], "dry grains have 5 to 60 deg; check the unit"),
    ],
)
def test_what_is_odd_is_told(loaded, targets, words):
    found = loaded(*targets).doubts
    assert len(found) == 1
    assert words in found[0]


@pytest.mark.parametrize(
    "targets",
    [
        boxes(29.9),
        boxes(20.0, 10.4),  # within three standard errors and two scales
        boxes(10.0, 8.0, 6.0, 4.0, 2.0),
        [target("conveyor", "t100_s", 10.0)],
        [target("heap", "angle_deg", 34.0)],
    ],
)
def test_what_fits_is_taken_without_a_word(loaded, targets):
    assert not loaded(*targets).doubts


def test_a_free_mass_may_be_the_largest_of_its_range(loaded):
    """What was poured is asked for, so that only more than the range allows is impossible."""
    free = "\n[parameter.impact_mass_g]\nrange = [25.0, 60.0]\n"
    assert not loaded(*boxes(29.0, 20.0), free).doubts
    with pytest.raises(CalibrationError, match="but 60 g were poured"):
        loaded(*boxes(60.0, 40.0), free)


def test_ends_of_a_range_of_grains_have_to_be_possible(loaded):
    """Found before the first run, not by the run that draws one."""
    sized = HEAD.replace("d32_um", "d10_um = 1300.0\nd50_um = 1500.0\nd90_um = 1700.0\nd32_um")
    free = "\n[parameter.d32_um]\nrange = [{}, 1600.0]\n"
    heap = target("heap", "angle_deg", 34.0)
    assert loaded(heap, free.format(1400.0), head=sized)
    with pytest.raises(CalibrationError, match="d32_um = 1200 does not belong to quantiles"):
        loaded(heap, free.format(1200.0), head=sized)


def test_masses_of_a_curve_are_looked_at_too(loaded, tmp_path):
    text = target("conveyor", "mass_time", 1.0)
    text = text[: text.index("value")].replace('unit = "s"\n', "")
    text += 'file = "curve.csv"\nx_column = "mass_g"\ncolumn = "time_s"\nse_column = "se_s"\n'
    rows = [f"{mass},{{}},0.05" for mass in (10, 50, 100)]
    table = "\n".join(["mass_g,time_s,se_s", *rows])
    (tmp_path / "curve.csv").write_text(table.format(5.0, 7.0, 9.5))
    assert not loaded(text).doubts
    (tmp_path / "curve.csv").write_text(table.format(0.1, 0.2, 0.3))
    assert "the funnel pours them in" in loaded(text).doubts[0]
    (tmp_path / "curve.csv").write_text(table.format(5e3, 7e3, 9e3))
    with pytest.raises(CalibrationError, match="check the unit"):
        loaded(text)


def test_a_wall_is_glued_whatever_the_capitals_of_that_word(loaded):
    found = loaded(
        target("heap", "angle_deg", 34.0), head=HEAD.replace("steel", "Glued"), free=GLUED
    )
    assert found.study.surfaces[0].kind == "glued"
    assert not guessed_walls(found.study)


def test_a_new_study_takes_that_wall_for_glued_too(bulkcal, tmp_path):
    path = tmp_path / "new.toml"
    words = ("--material", "Sand", "--surface", "Glued", "--experiment", "heap")
    assert bulkcal("init", *words, "--out", str(path))[0] == 0
    text = path.read_text()
    assert "plate laminated with grains" in text
    assert "mu_pw" not in text


def test_a_wall_of_another_name_is_said_to_be_taken_for_flat(loaded):
    lamina = HEAD.replace("steel", "laminated")
    heap = target("heap", "angle_deg", 34.0)
    assert "'laminated': taken for flat" in guessed_walls(loaded(heap, head=lamina).study)[0]
    for kind in ("flat", "glued"):
        said = lamina + f'kind = "{kind}"\n'
        study = loaded(heap, head=said, free=GLUED if kind == "glued" else FREE).study
        assert study.surfaces[0].kind == kind
        assert not guessed_walls(study)
    assert not guessed_walls(loaded(heap).study)


def test_a_flat_wall_that_is_called_glued_stays_flat_when_it_is_written(loaded, tmp_path):
    said = HEAD.replace('"steel"', '"glued"\nkind = "flat"')
    study = loaded(target("heap", "angle_deg", 34.0), head=said).study
    path = tmp_path / "again.toml"
    path.write_text(study_text(study))
    assert load_study(path).surfaces[0].kind == "flat"


def test_check_says_what_is_odd(bulkcal, loaded, tmp_path, monkeypatch):
    """Probes run on formulas; calibrate says the same of values, on stderr."""
    monkeypatch.setattr(cost.cost_of, "__defaults__", (stand_in.execute, lambda _line: None))
    loaded(target("heap", "angle_deg", 0.6, 0.01), head=HEAD.replace("steel", "brass"))
    path = str(tmp_path / "study.toml")
    code, out, err = bulkcal("check", path)
    assert code == 0, err
    assert "'brass': taken for flat" in out
    assert "dry grains have 5 to 60 deg" in out
    assert len(json.loads(bulkcal("check", path, "--json")[1])["doubts"]) == 2
    code, _, err = bulkcal("calibrate", path, "--dry-run", "--out", str(tmp_path / "out"))
    assert code == 0
    assert "dry grains have 5 to 60 deg" in " ".join(err.split())
