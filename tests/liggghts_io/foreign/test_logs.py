"""Thermo tables of logs, and the tables that fixes print: every row, or a word on it."""

from __future__ import annotations

from pathlib import Path

import pytest

from liggghts_io.errors import CaseError
from liggghts_io.foreign import read_output
from liggghts_io.foreign.log import Log
from liggghts_io.measure.series import THERMO, read_series
from tests.liggghts_io.foreign.grains import frame_text, known

HEAD = "LIGGGHTS (Version LIGGGHTS-PUBLIC 3.8.0)\n"
TABLE = "Step Atoms KinEng\n 0 5 0.5\n 100 5 0.25\n"
LOOP = "Loop time of 1 on 1 procs\n"


def log_of(folder: Path, text: str) -> Log:
    (folder / "run.dump").write_text(frame_text(0, known(3)))
    (folder / "log.run").write_text(HEAD + text)
    found = read_output(folder).log
    assert found is not None
    return found


def test_messages_between_the_rows_are_passed_over(tmp_path: Path):
    warned = "WARNING: Less insertions than requested (../fix.cpp:683)\nINFO: step 100 done\n"
    log = log_of(tmp_path, TABLE + warned + " 200 5 1e-5\n" + LOOP + TABLE + LOOP)
    assert log.thermo["Step"].tolist() == [0, 100, 200, 0, 100]
    assert log.notes == ()


@pytest.mark.parametrize(
    "strange",
    ["200 5", "0.001 0.5 7", "0.001 0.5", "200 5 1.0D-3", "200 5-1.0e-3", "200 5 1_0", "50 5 0.1"],
)
def test_a_damaged_or_printed_row_is_left_out_and_said(tmp_path: Path, strange: str):
    """Also one with as many numbers: a step is whole and above the last one."""
    log = log_of(tmp_path, f"{TABLE}{strange}\n 300 5 0.1\n{LOOP}")
    assert log.thermo["Step"].tolist() == [0, 100, 300]
    (note,) = log.notes
    assert note.startswith(f"log.run:5: {strange!r} is no row of the thermo table; left out")


def test_a_table_need_not_begin_with_the_step(tmp_path: Path):
    log = log_of(tmp_path, "Time Step Atoms\n 0.0 0 5\n 0.1 100 5\n" + LOOP)
    assert log.thermo.to_dict("list") == {"Time": [0, 0.1], "Step": [0, 100], "Atoms": [5, 5]}
    above = "Memory usage per processor = 5.2 Mbytes\n"
    log = log_of(tmp_path, above + "Time Atoms\n 0.0 5\n 0.1 6\n" + LOOP)
    assert log.thermo.to_dict("list") == {"Time": [0, 0.1], "Atoms": [5, 6]}


def test_thermo_output_as_yaml_is_read(tmp_path: Path):
    rows = (
        "---\nkeywords: ['Step', 'Temp', 'c_1[1]', ]\ndata:\n  - [0, 1.5, 2, ]\n  - [5, nan, 3, ]\n"
    )
    log = log_of(tmp_path, rows + "...\n" + LOOP)
    assert log.thermo[["Step", "c_1[1]"]].to_dict("list") == {"Step": [0, 5], "c_1[1]": [2, 3]}
    assert log.thermo["Temp"].isna().tolist() == [False, True]


def test_style_multi_has_names_with_brackets_and_no_warnings(tmp_path: Path):
    block = "------------ Step {0:14d} ----- CPU =            0 (sec) -------------\n"
    rows = "TotEng = -4.5 c_1[1] =  {1}\nWARNING: too small dt = 5 (a.cpp:3)\n"
    log = log_of(tmp_path, (block + rows).format(0, 2) + (block + rows).format(5, 3) + LOOP)
    wanted = {"Step": [0, 5], "TotEng": [-4.5, -4.5], "c_1[1]": [2, 3]}
    assert log.thermo.to_dict("list") == wanted


@pytest.mark.parametrize(
    "words", ["units cgs # cm\ntimestep 1e-5 # s", "  units\tcgs\n\ttimestep 1e-5"]
)
def test_units_and_time_step_have_comments_and_blanks(tmp_path: Path, words: str):
    log = log_of(tmp_path, f"{words}\n{TABLE}")
    assert (log.units, log.dt) == ("cgs", 1e-5)


def test_two_time_steps_are_said(tmp_path: Path):
    log = log_of(tmp_path, f"timestep 1e-5\n{TABLE}{LOOP}timestep 2e-5\n{TABLE}")
    assert log.dt is None
    assert log.notes == ("log.run: 2 time steps; times are not known without --timestep S",)


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("# time mass\n0.1 2\n0.2 1.0D-3\n0.3 4\n", 3, "'0.2 1.0D-3' is no row of numbers"),
        ("# time mass\n0.1 2\n0,2 3,0\n", 3, "'0,2 3,0' is no row of numbers"),
        ("0.1 2\n0.2 abc\n", 2, "'0.2 abc' is no row of numbers"),
        ("# time mass\n0.1 1\n0.2\n0.3 4\n", 3, "1 numbers, where the first row has 2"),
        ("# time mass\n0.1 1_0\n", None, "holds no row of numbers"),
        ("# TimeStep Number-of-rows\n# Row c_1\n0 2\n1 5\n2 6\n", None, "use 'mode scalar'"),
    ],
)
def test_a_row_of_a_printed_table_is_never_its_title(tmp_path: Path, text, line, message):
    path = tmp_path / "table.txt"
    path.write_text(text)
    with pytest.raises(CaseError) as told:
        read_series(path, 2500.0)
    assert str(told.value).startswith(f"{path}:{line}: " if line else f"{path}: ")
    assert message in str(told.value)


def test_titles_may_be_repeated_and_have_any_letters(tmp_path: Path):
    path = tmp_path / "table.txt"
    title = "# Zeit Größe\n"
    path.write_text(f"\ufeff{title}0.1 2\n{title}0.2 3\n", encoding="utf-8")
    series = read_series(path, 2500.0)
    assert {name: one.tolist() for name, one in series.items()} == {
        "1": [0.1, 0.2], "2": [2, 3], "Zeit": [0.1, 0.2], "Größe": [2, 3],
    }  # fmt: skip
    path.write_text("# a a\n0.1 2\n")  # which of the two is meant nobody knows
    assert list(read_series(path, 2500.0)) == ["1", "2"]


def test_a_log_of_a_case_loses_no_row_silently(tmp_path: Path):
    path = tmp_path / THERMO
    path.write_text(TABLE + "WARNING: lost grains\n 200 5 0.1\n" + LOOP)
    assert read_series(path, 2500.0)["Step"].tolist() == [0, 100, 200]
    path.write_text(TABLE + "200\n 300 5 0.1\n" + LOOP)
    with pytest.raises(CaseError, match=r"log.liggghts:4: '200' is no row of the thermo table"):
        read_series(path, 2500.0)


def test_a_directory_is_no_table(tmp_path: Path):
    with pytest.raises(CaseError, match=r"Is a directory.*name a file that the engine wrote"):
        read_series(tmp_path, 2500.0)
