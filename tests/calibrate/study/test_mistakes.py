"""All mistakes of a study are found before the first run, with file and line, all at once."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from calibrate.study.data import load_data
from calibrate.study.mistakes import MOST_NOTED, Lines

GOOD = (Path(__file__).parents[1] / "studies" / "good.toml").read_text(encoding="utf-8")
RIG = '[[experiment]]\nname = "heap"\napparatus = '


def line_of(words: str, text: str = GOOD) -> int:
    return text[: text.index(words)].count("\n") + 1


def test_the_good_study_is_good(folder: Path):
    assert load_data(folder / "study.toml").scalars["t100_glued"].value == 17.90


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('observable = "angle_deg"', 'observable = "height"', "heap: unknown observable 'height'"),
        ('unit = "deg"', 'unit = "s"', "'s' is a unit of time, but the simulated value is in deg"),
        ('unit = "deg"', 'unit = "degrees"', "'degrees' is not a known unit"),
        ("points = 10", "points = 7", "points = 7: must be at least 8"),
        ("points = 10", "points = 5000", "must be at most 2000"),
        ("points = 10", 'points = "ten"', "points = 'ten'"),
        ("seed = 1", "seed = -3", "run.seed = -3: must be at least 1"),
        ("seed = 1", "seed = true", "seed = True"),
        ("seed = 1", "seed = 2026-11-26", "run.seed = 2026-11-26: must be a whole number"),
        ('title = "Small"', 'title = ""', "title = '': is empty; give it a name"),
        (
            "range = [0.1, 0.8]",
            "range = [0.1, 0.5, 0.8]",
            "has 3 entries where there must be at most 2",
        ),
        (
            "seed = 1",
            "seed = 1\n[design]\ncheck_seeds = 1",
            "design.check_seeds = 1: must be at least 2",
        ),
        (
            "seed = 1",
            'seed = 1\nexecutor = "cloud"',
            "run.executor: unknown executor 'cloud'",
        ),
        ("range = [0.1, 0.8]", "range = [-0.1, 0.8]", "mu_pp = -0.1 outside 0 to 1000"),
        ("range = [0.1, 0.8]", "range = [0.1, nan]", "nan: must be a finite number"),
        ("range = [0.1, 0.8]", "range = [0.1, 1e300]", "mu_pp = 1e+300 outside 0 to 1000"),
        ("value = 0.6", "value = 0.05", "parameter.e_pp.value: e_pp = 0.05 outside 0.05 to 1"),
        ("value = 0.6", 'value = "0.6"', "parameter.e_pp.value = '0.6'"),
        (
            "value = 0.6",
            "value = { Sand = 0.6 }",
            "parameter.e_pp.value: unknown name 'Sand'; known",
        ),
        (
            "range = [0.1, 0.8]",
            "range = [0.1, 0.8]\nprior = 'normal'",
            "parameter.mu_pp.prior = 'normal'",
        ),
        (
            'free = ["mu_pp", "mu_roll_pp"]',
            'free = ["mu_pp", "mu_roll_pp", "e_pp"]',
            "'e_pp' has no range; add it under",
        ),
        ('file = "conveyor.csv"', 'file = "con\\u0000.csv"', "is no name of a file"),
        ('file = "conveyor.csv"', f'file = "{"a" * 900}"', "is no name of a file"),
        ('file = "conveyor.csv"', f'file = "{"a" * 5000}"', "at most 1000 characters"),
        ('file = "conveyor.csv"', 'file = "."', "is a directory"),
        ('file = "conveyor.csv"', 'file = "../x.csv"', "lies outside"),
    ],
)
def test_a_wrong_value_is_told_with_its_line(told, old: str, new: str, expected: str):
    (mistake,) = told((old, new))
    line, _, message = mistake.removeprefix(":").partition(": ")
    assert int(line) == line_of(old) + new.count("\n")
    assert expected in message


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("value = 0.6", "value = 0.6\ntie = 'material'", "are for a free parameter; add range"),
        ("range = [0.1, 0.8]", "range = [0.0, 0.8]\nspacing = 'log'", "has no logarithm; begin"),
        (
            "range = [0.1, 0.8]",
            "range = [0.1, 0.8]\nscope = 'apparatus'",
            "is for apparatus and eff",
        ),
        (
            "range = [0.1, 0.8]",
            "range = [0.1, 0.8]\ntie = 'surface'",
            "does not differ between surf",
        ),
        ("range = [0.1, 0.8]", "published = 0.3", "neither range nor value; give range = [low"),
        ('["mu_pp", "mu_roll_pp"]', '["mu_pp", "mu_roll_pp", "mu_pp"]', "'mu_pp' appears twice in"),
        ("[parameter.e_pp]\nvalue", "[parameter.heap]\nvalue", '[parameter."heap.timestep_frac'),
        ("[[stage]]", "[[stage]]\nrange = { e_pp = [0.1, 0.2] }", "range: unknown name 'e_pp'"),
        ('column = "t100_s"\n', "", "column is missing; name the column of the file"),
        ('file = "conveyor.csv"', "value = 17.9\nse = 0.1", "column belongs to a file, and value"),
        ('unit = "deg"\n', "", 'unit is missing; add unit = "deg"'),
        (
            'surface = "glued"\nobs',
            'surface = "glued"\nlevels = [1.0]\nobs',
            "levels is for curves",
        ),
    ],
)
def test_a_wrong_part_is_told_with_its_remedy(told, old: str, new: str, expected: str):
    assert any(expected in one for one in told((old, new)))


@pytest.mark.parametrize(
    ("more", "expected"),
    [
        (RIG + "{ frames = 0 }", "heap: apparatus frames = 0: give a whole number from 5"),
        (RIG + "{ pour_stages = 0 }", "pour_stages = 0: give a whole number from 1 to 100"),
        (RIG + "{ pour_stages = 1e5 }", "pour_stages = 100000: give a whole number"),
        (RIG + "{ slice_width_d = 0 }", "slice_width_d = 0 d: give a number from 1.5"),
        (RIG + "{ pour_grains = 0 }", "pour_grains = 0: give a whole number from 10"),
        (RIG + "{ timestep_fraction = 1e-30 }", "timestep_fraction = 1e-30: give"),
        (RIG + "{ frame = 9 }", "unknown apparatus parameter 'frame'; did you mean 'fram"),
        ("[effects]\nmass_flow_factor = 3", "effect mass_flow_factor: strength 3 - outside"),
        ("[effects]\ncohesion = 3", "effects: unknown name 'cohesion'"),
        ("[known]\nplate_tilt_deg = { value = 90.0, se = 0.1 }", "lies outside -10 to 10 deg"),
        ("[known]\nmu_pp = [{ se = 1.0 }, { se = 2.0 }]", "two measurements of Carbo HSP13; join"),
        ("[parameter.mu_pw]\nvalue = 0.3", "'mu_pw' matters in no experiment of the study"),
        ('[parameter."conveyor.period_s"]\nvalue = 99.0', "period_s = 99 s: give a number from"),
    ],
)
def test_a_wrong_table_is_told_with_its_line(told, more: str, expected: str):
    (mistake,) = told(more=f"\n{more}\n")
    line, _, message = mistake.removeprefix(":").partition(": ")
    table = more.startswith("[parameter") and "99" not in more
    assert int(line) == GOOD.count("\n") + (2 if table else 1 + len(more.splitlines()))
    assert expected in message


def test_an_effect_acts_in_at_least_one_experiment_of_the_study(told, folder: Path):
    heaps = [
        ('experiment = "conveyor"', 'experiment = "heap"'),
        ('observable = "t100_s"\nunit = "s"', 'observable = "angle_deg"\nunit = "deg"'),
        ('file = "conveyor.csv"\ncolumn = "t100_s"\nse_column = "sem_s"\nscale = "log"',
         'file = "angle_of_repose.csv"\ncolumn = "angle_deg"\nse_column = "sem_deg"'),
    ]  # fmt: skip
    (mistake,) = told(*heaps, more="\n[effects]\nplate_tilt_deg = 3\n")
    assert "plate_tilt_deg acts in conveyor only, and the study has heap; take it out" in mistake
    text = GOOD + "\n[effects]\nplate_tilt_deg = 3\n"
    (folder / "study.toml").write_text(text, encoding="utf-8")
    assert load_data(folder / "study.toml").study.effects == {"plate_tilt_deg": 3.0}


def test_apparatus_belongs_to_an_experiment_of_the_study(told):
    (mistake,) = told(more='\n[[experiment]]\nname = "plate_impact"\napparatus = { frames = 9 }\n')
    assert "no target is measured in plate_impact, the study has conveyor, heap" in mistake


def test_all_mistakes_are_told_at_once_in_the_order_of_the_file(told, folder: Path):
    table = folder / "conveyor.csv"
    table.write_text(table.read_text().replace("17.90", "-17.90"))
    found = told(
        ("seed = 1", "seed = -3"),
        ('observable = "angle_deg"', 'observable = "height"'),
        ("points = 10", "points = 2"),
        more=f"\n{RIG}{{ frames = 0, pour_stages = 0 }}\n\n[effects]\ncohesio = 1\n",
    )
    for words in ("seed", "height", "-17.90", "points", "frames", "pour_stages", "cohesio"):
        assert any(words in one for one in found), (words, found)
    assert len(found) == 7
    lines = [int(re.match(r":(\d+): ", one)[1]) for one in found]
    assert lines == sorted(lines)


def test_a_misspelt_key_is_not_told_as_a_missing_one_too(told):
    (mistake,) = told(("observable", "observabel"))
    assert "did you mean 'observable'?" in mistake


def test_lines_of_keys_are_found_where_strings_and_lists_go_over_lines():
    text = '''name = "a"
note = """
[stage]
name = 5
"""
sizes = [
  "[stage]",  # a ] in a comment
  "b = 1",
]
[fixed]
mu_pp = 1
[[stage]]
name = "one"
free = { mu_pp = [0, 1] }
[[stage]]
name = "two"
[stage.free]
"mu_pw" = [0, 1]
a.b = 1
'''
    lines = Lines(text)
    assert lines.of(("name",)) == 1
    assert lines.of(("sizes", 1)) == 6
    assert lines.of(("fixed", "mu_pp")) == 11
    assert lines.of(("stage", 0, "free", "mu_pp")) == 14
    assert lines.of(("stage", 1, "name")) == 16
    assert lines.of(("stage", 1, "free", "mu_pw", 0)) == 18
    assert lines.of(("stage", 1, "free", "a", "b")) == 19
    assert lines.of(("stage", 1, "points")) == 15
    assert lines.of(("nothing",)) is None


def test_check_lists_mistakes_and_costs(bulkcal, folder: Path):
    path = folder / "study.toml"
    path.write_text(GOOD.replace("seed = 1", "seed = 0") + f"\n{RIG}{{ frames = 0 }}\n")
    code, out, err = bulkcal("check", str(path))
    assert code == 2
    assert err.startswith("bulkcal: 2 mistakes:\n")
    assert err.count(str(path)) == 2
    code, out, _ = bulkcal("check", str(path), "--json")
    assert code == 2
    record = json.loads(out)
    assert not record["ok"]
    assert len(record["mistakes"]) == 2


@pytest.mark.slow
def test_check_says_runs_time_and_disk_and_keeps_nothing(bulkcal, folder: Path):
    path = folder / "study.toml"
    before = sorted(folder.iterdir())
    code, out, _ = bulkcal("check", str(path), "--json", "--workers", "2")
    assert code == 0
    record = json.loads(out)
    assert record["ok"]
    # By stages 10 points, 2 repeats and 3 seeds of the check for each of two experiments; jointly
    # a budget of 400, and 3 seeds and 5 draws of the check for each of them.
    assert record["runs"] == 30 + 400 + 16
    assert record["pilot_runs"] > 0
    assert record["pilot"] is None
    heap, conveyor = record["places"]
    assert (heap["experiment"], heap["surface"]) == ("heap", "glued")
    assert heap["grains"] == pytest.approx(827.0, abs=1.0)  # of three sizes, as heavy as 800 alike
    for one in (heap, conveyor):
        assert 0.05 < one["run_s"] < 600.0
        assert 0.05 < one["disk_mb"] < 50.0
    together = sum(one["runs"] * one["run_s"] for one in (heap, conveyor)) / 2
    assert record["wall_s"] == pytest.approx(together)
    assert sorted(folder.iterdir()) == before


def test_a_value_of_several_kinds_is_told_by_its_key(told):
    said = told(("seed = 1", 'seed = 1\n[design]\nstart = { heap = "x" }'))
    assert any("design.start.heap = 'x': must be a whole number" in one for one in said)
    assert not any("constrained" in one or "[" in one for one in said)


@pytest.mark.parametrize(
    "more",
    [
        "[stage.range]\n" + "".join(f"name_{k} = [0.1, 0.2]\n" for k in range(4000)),
        "".join(f"[parameter.name_{k}]\nvalue = 0.3\n" for k in range(4000)),
        "".join(f'[[target]]\nnme = "t{k}"\n' for k in range(4000)),
    ],
)
def test_thousands_of_mistakes_are_told_as_soon_as_a_few(told, more: str) -> None:
    """`told` holds the time; with a hint for each of them it was minutes."""
    assert len(told(more=more)) == MOST_NOTED


def test_thousands_of_names_that_nobody_knows_take_no_time(told) -> None:
    names = ", ".join(f'"name_{k}"' for k in range(4000))
    mistakes = told(('free = ["mu_pp", "mu_roll_pp"]', f"free = [{names}]"))
    assert len(mistakes) == MOST_NOTED
    assert all("unknown name 'name_" in one for one in mistakes[2:])
