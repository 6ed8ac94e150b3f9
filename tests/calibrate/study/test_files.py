"""Files that are no study and no table are refused with place and reason."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest

from calibrate.errors import CalibrationError
from calibrate.study.data import load_data
from tests.calibrate.study.conftest import GOOD
from tests.calibrate.study.rigs import CURVE, write_rig


@pytest.mark.parametrize(
    ("raw", "expected"),
    [
        (b"a = " + b"[" * 100_000, "nested too deeply"),
        (b"a = " + b"9" * 5000, "not valid TOML"),
        (b'title = "M\xfcll"\n', r"study.toml:1: byte 0xfc is not UTF-8"),
        (b"#" * 1_000_001, "larger than 1 MB"),
        (b"", "is missing"),
    ],
)
def test_a_file_that_is_no_study_is_refused(folder: Path, raw: bytes, expected: str):
    path = folder / "study.toml"
    path.write_bytes(raw)
    with pytest.raises(CalibrationError, match=expected):
        load_data(path)


@pytest.mark.parametrize("name", ["", ".", "nul\0.toml", "a" * 5000, "loop", "pipe"])
def test_a_path_that_is_no_file_is_refused(folder: Path, name: str):
    (folder / "loop").symlink_to("loop")
    os.mkfifo(folder / "pipe")
    with pytest.raises(CalibrationError, match="cannot be read"):
        load_data(folder / name)


def test_a_loop_of_links_among_the_data_is_refused(told, folder: Path):
    (folder / "conveyor.csv").unlink()
    (folder / "conveyor.csv").symlink_to("conveyor.csv")
    (mistake,) = told()
    assert "'conveyor.csv'" in mistake


@pytest.mark.parametrize(
    ("raw", "expected"),
    [
        (b"a,b\n\x81,1\n", "conveyor.csv:2: byte 0x81 is neither UTF-8 nor CP1252; save"),
        ("particle,surface\n".encode("utf-16-le"), "conveyor.csv:1: holds the character 0x00, as"),
        (b"", "conveyor.csv: holds no table"),
        (b"# only a comment\n", "conveyor.csv: holds no table"),
        (b"particle,surface\nCarbo HSP13\n", "conveyor.csv:2: 1 cells under 2 column names"),
        (b"particle,surface\na,b\na,b,,\n", "conveyor.csv:3: 4 cells under 2 column names"),
        (b"particle,particle\n", "conveyor.csv:1: column 'particle' appears twice"),
        (b"particle,surface,t100_s,sem_s\n", "conveyor.csv: 0 rows for particle 'Carbo HSP13'"),
        (b"x" * 10_000_001, "conveyor.csv: larger than 10 MB"),
        (b'"' + b"x" * 200_000, "conveyor.csv:1: cannot be read as CSV"),
    ],
)
def test_a_wrong_table_of_data_is_told_with_its_line(told, folder: Path, raw, expected: str):
    (folder / "conveyor.csv").write_bytes(raw)
    (mistake,) = told()
    assert re.match(r":\d+: ", mistake)
    assert expected in mistake


def test_nan_is_told_as_it_was_written(told, folder: Path):
    table = folder / "conveyor.csv"
    table.write_text(table.read_text().replace("17.90", ""))
    (mistake,) = told()
    assert "conveyor.csv:6: t100_s = '' is empty, which is not a number" in mistake
    assert "float64" not in mistake


def test_a_mark_at_the_begin_of_a_study_is_passed_over(folder: Path):
    study = folder / "study.toml"
    study.write_bytes(b"\xef\xbb\xbf" + study.read_bytes())
    assert load_data(study).study.targets


def test_the_digest_covers_every_file_that_is_read(folder: Path) -> None:
    path = folder / "study.toml"
    path.write_text(GOOD, encoding="utf-8")
    data = load_data(path)
    assert set(data.files) == {path.name, "angle_of_repose.csv", "conveyor.csv", "particles.csv"}
    (folder / "notes.csv").write_text("nobody reads this\n")
    assert load_data(path).sha256 == data.sha256
    for name in data.files:
        file = folder / name
        before = file.read_bytes()
        file.write_bytes(before + b"# one more line\n")
        assert load_data(path).sha256 != data.sha256, name
        file.write_bytes(before)
        assert load_data(path).sha256 == data.sha256


ROWS = "time_s,height_mm,sem_mm\n0.005,19.9,0.1\n0.015,18.9,0.1\n0.03,15.6,0.1\n"


def test_a_link_to_a_study_finds_everything_beside_the_file_itself(tmp_path: Path) -> None:
    home = tmp_path / "home"
    home.mkdir()
    path = write_rig(home, more=CURVE)
    (home / "path.csv").write_text(ROWS)
    (tmp_path / "link.toml").symlink_to(path)
    found = load_data(tmp_path / "link.toml")
    assert set(found.files) == {"link.toml", "path.csv", "rig"}
