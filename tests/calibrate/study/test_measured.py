"""Targets given in the study, in a table, as repeats, and as curves."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

from calibrate.errors import CalibrationError
from calibrate.study.checks.measured import curves_of_many_places
from calibrate.study.data import StudyData, load_data
from calibrate.study.resources import bundled_study
from tests.paths import ROOT

GOOD = (Path(__file__).parents[1] / "studies" / "good.toml").read_text(encoding="utf-8")
TIME = 'file = "conveyor.csv"\ncolumn = "t100_s"\nse_column = "sem_s"\n'
CURVE = """
[[target]]
name = "curve"
experiment = "conveyor"
observable = "mass_time"
file = "curve.csv"
x_column = "time_s"
column = "mass_g"
se_column = "sem_g"
"""


@pytest.fixture
def loaded(tmp_path: Path):
    """Return a function that loads the good study with words replaced and files beside it."""
    for csv in bundled_study().parent.glob("*.csv"):
        shutil.copy(csv, tmp_path)

    def load(old: str = "", new: str = "", more: str = "", **files: str) -> StudyData:
        assert old in GOOD
        for name, text in files.items():
            (tmp_path / f"{name}.csv").write_text(text, encoding="utf-8")
        path = tmp_path / "study.toml"
        path.write_text(GOOD.replace(old, new, 1) + more, encoding="utf-8")
        return load_data(path)

    return load


def test_a_value_may_stand_in_the_study(loaded):
    given = loaded('unit = "s"\n' + TIME, 'unit = "min"\nvalue = 0.3\nse = 0.001\nrepeats = 5\n')
    one = given.scalars["t100_glued"]
    assert (one.value, one.se, one.repeats) == pytest.approx((18.0, 0.06, 5))
    assert one.source == "study.toml"


@pytest.mark.parametrize(
    ("value", "se", "expected"),
    [
        ("-17.9", "0.1", "study.toml:33: value = -17.9 s is not a positive number"),
        ("1e9", "0.1", "is not a possible value of t100_s, 0 to 100000 s"),
        ("17.9", "99.0", "se = 99 is a standard error of 5.5 times the value"),
    ],
)
def test_a_value_in_the_study_is_one_that_can_be_measured(loaded, value, se, expected):
    with pytest.raises(CalibrationError, match=expected):
        loaded(TIME, f"value = {value}\nse = {se}\n")


def test_a_wrong_value_is_told_beside_a_wrong_error(loaded):
    with pytest.raises(CalibrationError) as caught:
        loaded(TIME, "value = -1.0\nse = 0.0\n")
    assert "value = -1 s is not a positive number, as t100_s has to be; se = 0 is not a" in str(
        caught.value
    )


def test_rows_without_errors_are_repeats(loaded):
    rows = [17.5, 18.0, 18.4, 17.7]
    text = "surface,run,t100\n" + "".join(f"glued,{k},{x}\n" for k, x in enumerate(rows))
    old, new = TIME, 'file = "times.csv"\ncolumn = "t100"\n'
    one = loaded(old, new, times=text + "steel,9,11.0\n").scalars["t100_glued"]
    assert one.value == pytest.approx(np.mean(rows))
    assert one.se == pytest.approx(np.std(rows, ddof=1) / np.sqrt(4))
    assert one.repeats == 4


@pytest.mark.parametrize(
    ("rows", "expected"),
    [
        ("glued,1,17.5\n", "1 rows for Carbo HSP13 on glued; without se_column the rows are rep"),
        ("glued,1,17.5\nglued,1,17.5\n", r"times.csv:3: is the same as .*times.csv:2; a repeat"),
        ("glued,1,17.5\nglued,2,17.5\n", "the 2 repeats .* give se = 0, which is not a positive"),
        ("glued,1,17.5\nglued,2,\n", "times.csv:3: t100 = '' is empty"),
        ("glued,1,17.5\nglued,2,-17\n", "times.csv:3: t100 = '-17' s is not a positive number"),
    ],
)
def test_repeats_that_tell_no_error_are_refused(loaded, rows: str, expected: str):
    with pytest.raises(CalibrationError, match=expected):
        loaded(TIME, 'file = "times.csv"\ncolumn = "t100"\n', times="surface,run,t100\n" + rows)


def test_two_rows_of_a_mean_are_told_with_their_lines(loaded):
    text = "particle,surface,t100_s,sem_s\n" + "Carbo HSP13,glued,17.9,0.02\n" * 2
    with pytest.raises(CalibrationError, match=r"2 rows for particle .* \(lines 2, 3\); one is"):
        loaded(conveyor=text)


def test_a_curve_is_read_at_its_levels(loaded):
    rows = "time_s,mass_g,sem_g\n1,0,1\n2,20,1\n4,60,1\n5,80,2\n"
    curve = loaded(more=CURVE + "levels = [20.0, 40.0, 80.0, 90.0]\n", curve=rows).curves["curve"]
    assert list(curve.levels) == [20.0, 40.0, 80.0]  # it ends at 80 g
    assert list(curve.values) == pytest.approx([2.0, 3.0, 5.0])
    assert list(curve.se) == pytest.approx([0.05, 0.05, 0.1])  # 20 g/s everywhere


def test_a_curve_may_give_times_at_masses(loaded):
    rows = "time_s,mass_g,sem_ms\n1,0,50\n2,20,50\n4,60,50\n5,80,100\n"
    other = (
        CURVE.replace('"time_s"', '"x"').replace('"mass_g"', '"time_s"').replace('"x"', '"mass_g"')
    )
    other = other.replace("sem_g", "sem_ms") + "levels = [20.0, 40.0, 80.0]\n"
    curve = loaded(more=other, curve=rows).curves["curve"]
    assert list(curve.values) == pytest.approx([2.0, 3.0, 5.0])
    assert list(curve.se) == pytest.approx([0.05, 0.05, 0.1])


def test_columns_of_a_curve_are_repeats(loaded):
    rows = "time_s,a_g,b_g,c_g\n0,0,0,0\n1,20,25,16\n2,40,50,32\n3,60,75,48\n"
    columns = 'columns = ["a_g", "b_g", "c_g"]\nlevels = [40.0]\n'
    more = CURVE.replace('column = "mass_g"\nse_column = "sem_g"\n', columns)
    curve = loaded(more=more, curve=rows).curves["curve"]
    times = [2.0, 1.6, 2.5]
    assert curve.values[0] == pytest.approx(np.mean(times))
    assert curve.se[0] == pytest.approx(np.std(times, ddof=1) / np.sqrt(3))
    assert curve.repeats == 3


@pytest.mark.parametrize(
    ("rows", "expected"),
    [
        ("1,50,1\n", "rows of a curve: 1; at least three"),
        ("1,10,1\n3,50,1\n2,90,1\n", "curve.csv:4: time_s = '2' is not above the row before: the "),
        ("1,10,1\n2,50,1\n2,60,1\n", "the curve stands still; it must rise"),
        ("1,10,1\n2,,1\n3,60,1\n", "curve.csv:3: mass_g = '' is empty, which is not a number"),
        ("1,10,1\n2,50,1\n3,40,1\n", "curve.csv:4: mass_g = '40' is less than above"),
        ("1,10,1\n2,50,-1\n3,60,1\n", "sem_g = '-1' is negative"),
        ("1,10,0\n2,50,0\n3,60,0\n", "no error at the level 10, 20, 30, 40, 50, 60 g"),
        (
            "1,1,1\n2,2,1\n3,3,1\n",
            "reaches none of the levels 10, 20, 30, ",
        ),
        (
            "1,10,1\n2,20,1\n3,30,1\n4,40,1\n99,60,1\n",
            "curve.csv:6: time_s = '99' comes after a gap",
        ),
    ],
)
def test_a_curve_that_is_none_is_told(loaded, rows: str, expected: str):
    with pytest.raises(CalibrationError, match=expected):
        loaded(more=CURVE, curve="time_s,mass_g,sem_g\n" + rows)


def test_a_curve_whose_columns_say_no_unit_is_refused(loaded):
    more = CURVE.replace("time_s", "x").replace("mass_g", "y").replace("sem_g", "e")
    with pytest.raises(CalibrationError, match="'x' and 'y' do not say their units; write them"):
        loaded(more=more, curve="x,y,e\n1,10,1\n2,50,1\n3,90,1\n")


def test_a_curve_that_stands_for_many_walls_is_told() -> None:
    cases = ROOT / "cases" / "challenge"
    lines = curves_of_many_places(load_data(cases / "two_materials.toml").study)
    assert len(lines) == 2
    assert "worn_curve_steel, worn_curve_alumina take time_s of curve_steel.csv" in lines[0]
    assert not curves_of_many_places(load_data(cases / "one_material.toml").study)
