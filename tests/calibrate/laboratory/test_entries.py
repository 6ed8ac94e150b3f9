"""Tables of measured numbers: extended byte for byte, never half, and read back by a study."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from calibrate.errors import CalibrationError
from calibrate.laboratory.entries import Entry, extended
from calibrate.laboratory.replicates import numbers_in_table, numbers_in_words, replicates
from calibrate.laboratory.targets import Place, check_value, value_lines
from calibrate.study.measured.scalars import measured_value
from calibrate.study.measured.tables import read_table
from calibrate.study.schema.materials import Material
from calibrate.study.schema.targets import Target
from liggghts_io.experiments import EXPERIMENTS

T100 = Entry("t100_steel", "Sand", "steel", 10.13, 0.06, "s", 5, "run1.csv, run2.csv; 100 g")
PLACE = Place(EXPERIMENTS["conveyor"], "t100_s")
HEAD = "target,material,surface,value,se,unit,repeats,from"
SAND = Material(name="Sand", d32_um=1000.0, density_kg_m3=2500.0)


def target(**changes) -> Target:
    words = {
        "name": "t100_steel", "material": "Sand", "surface": "steel", "experiment": "conveyor",
        "observable": "t100_s", "unit": "s", "file": "m.csv", "column": "value", "se_column": "se",
    }  # fmt: skip
    return Target.model_validate(words | changes)


def add(path: Path, *entries: Entry) -> Path:
    for entry in entries:
        path.write_bytes(extended(path, entry))
    return path


def test_what_is_written_is_read_by_a_study(tmp_path):
    """Three targets of one material and surface in one table, one of another surface."""
    path = add(
        tmp_path / "m.csv", T100, replace(T100, target="t50", value=6.5),
        replace(T100, target="glued", surface="glued", value=17.9, repeats=0),
    )  # fmt: skip
    table = read_table(path)
    found = measured_value(target(), SAND, table)
    assert (found.value, found.se, found.repeats) == (10.13, 0.06, 5)
    assert measured_value(target(name="t50"), SAND, table).value == 6.5
    assert measured_value(target(name="glued", surface="glued"), SAND, table).repeats == 0
    with pytest.raises(
        CalibrationError, match=r"0 rows for target 't10_steel'.*did you mean 't100"
    ):
        measured_value(target(name="t10_steel"), SAND, table)
    with pytest.raises(CalibrationError, match="0 rows for target 'glued' of 'Sand' on 'steel'"):
        measured_value(target(name="glued"), SAND, table)


def test_without_material_and_surface_a_row_is_for_any(tmp_path):
    path = add(tmp_path / "m.csv", replace(T100, material="", surface=""))
    assert measured_value(target(), SAND, read_table(path)).value == 10.13


def test_a_row_in_another_unit_than_the_study_is_refused(tmp_path):
    path = add(tmp_path / "m.csv", T100)
    with pytest.raises(
        CalibrationError, match=r"m.csv:3: unit = 's' but the study says unit = 'ms'"
    ):
        measured_value(target(unit="ms"), SAND, read_table(path))


def test_the_lines_of_the_study_are_those_of_a_target():
    import tomllib

    lines = tomllib.loads(value_lines(T100, PLACE, "m.csv"))
    assert Target.model_validate(lines["target"][0]) == target()


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
@pytest.mark.parametrize("separator", [",", ";", "\t"])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("mark", [".", ","])
def test_a_table_that_a_spreadsheet_saved_is_extended_in_its_own_dress(
    tmp_path, encoding, separator, end, mark
):
    path = tmp_path / "m.csv"
    number = f"1{mark}5" if (separator, mark) != (",", ",") else '"1,5"'
    row = ["Öl", "Sand", "steel", number, number, "s", "2", "x"]
    text = end.join(["# Müller, 2026", HEAD.replace(",", separator), separator.join(row)])
    path.write_bytes(text.encode(encoding))
    before = path.read_bytes()
    add(path, T100)
    assert path.read_bytes().startswith(before)
    table = read_table(path)
    assert [cells.cells["target"] for cells in table.rows] == ["Öl", "t100_steel"]
    assert [cells.number("value") for cells in table.rows] == [1.5, 10.13]
    assert [cells.number("se") for cells in table.rows] == [1.5, 0.06]
    assert table.source == "Müller, 2026"


def test_columns_of_ones_own_stay_and_are_left_empty(tmp_path):
    path = tmp_path / "m.csv"
    path.write_text("who,target,se,value,unit\nme,a,0.1,1.0,s\n")
    add(path, T100)
    assert path.read_text().splitlines()[-1] == ",t100_steel,0.06,10.13,s"


WRONG = {
    "there already": (
        f"{HEAD}\nt100_steel,,,1.0,0.1,s,,\n",
        r"m.csv:2: has 't100_steel' already \(1",
    ),
    "another table": ("particle,surface,t100_s\n", "has no column 'target'.* name another --out"),
    "binary": (b"\0\1", "holds the character"),
    "broken": (f"{HEAD}\na,b\n", "2 cells under 8 column names"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_table_that_cannot_take_it_stays_as_it_is(tmp_path, name):
    content, words = WRONG[name]
    path = tmp_path / "m.csv"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    before = path.read_bytes()
    with pytest.raises(CalibrationError, match=words):
        extended(path, T100)
    assert path.read_bytes() == before


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"target": "t 100"}, "--name t 100: "),
        ({"target": ""}, "--name : "),
        ({"surface": "a/b"}, "--surface a/b: "),
        ({"unit": "g"}, "'g' is a unit of mass, but the simulated value is in s"),
        ({"value": -1.0}, "not a positive number, as t100_s has to be"),
        ({"value": 1e9}, "not a possible value of t100_s"),
        ({"se": 1e3}, "is a standard error of"),
    ],
)
def test_what_a_study_would_refuse_is_not_written(changes, words):
    with pytest.raises(CalibrationError) as caught:
        check_value(replace(T100, **changes), PLACE)
    assert words in str(caught.value)


def test_an_unknown_observable_names_the_nearest():
    with pytest.raises(CalibrationError, match=r"--observable t10_s: .*did you mean 't100_s'"):
        check_value(T100, replace(PLACE, observable="t10_s"))


@given(st.lists(st.floats(-1e6, 1e6), min_size=2, max_size=9, unique=True), st.randoms())
def test_replicates_do_not_depend_on_their_order(values, random):
    found = replicates(values, "here")
    random.shuffle(values)
    assert replicates(values, "here").mean == pytest.approx(found.mean, abs=1e-6)
    assert replicates(values, "here").se == pytest.approx(found.se, rel=1e-6)


def test_replicates_of_a_table(tmp_path):
    path = tmp_path / "angles.csv"
    path.write_text("surface;run;Winkel [deg]\nsteel;1;34,0\nsteel;2;34,4\nglued;1;38,0\n")
    found = numbers_in_table(path, "Winkel", {"surface": "steel"})
    assert (found.numbers, found.unit) == ((34.0, 34.4), "deg")
    assert replicates(found.numbers, "here").se == pytest.approx(0.2)
    with pytest.raises(CalibrationError, match=r"--where surface=stell: .*did you mean 'steel'"):
        numbers_in_table(path, "Winkel", {"surface": "stell"})
    path.write_text("run;a\n1;34,0\n1;34,0\n")
    with pytest.raises(CalibrationError, match="a repeat counts once"):
        numbers_in_table(path, "a", {})


def test_what_tells_no_error_is_refused():
    with pytest.raises(CalibrationError, match="1 number; two repeats are the fewest"):
        replicates([1.0], "here")
    with pytest.raises(CalibrationError, match="all 2 repeats are 1"):
        replicates([1.0, 1.0], "here")
    with pytest.raises(CalibrationError, match=r"'1,234' may be 1\.234 or 1234"):
        numbers_in_words(["1,234"])
