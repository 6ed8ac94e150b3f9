"""Text dumps as LAMMPS and others write them, and what editors and restarts make of them."""

from __future__ import annotations

import gzip
from pathlib import Path

import numpy as np
import pytest

from liggghts_io.errors import CaseError
from liggghts_io.foreign import Grains, measure_frames, read_output
from liggghts_io.measure.extract import EXTRACTORS
from tests.liggghts_io.foreign.grains import frame_text, known

HEAD = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{count}\nITEM: BOX BOUNDS {box}\n{bounds}\n"
CUBE = "-1 1\n-1 1\n-1 1"
LOG = "LIGGGHTS (Version 3.8.0)\nunits cgs\ntimestep 1e-5\nStep Atoms\n 0 4\nLoop\n"


def with_rows(names: str, *rows: str, box: str = "ff ff ff", bounds: str = CUBE) -> str:
    head = HEAD.format(count=len(rows), box=box, bounds=bounds)
    return head + f"ITEM: ATOMS {names} \n" + "".join(f"{row}\n" for row in rows)


def write(folder: Path, text: str, name: str = "run.dump") -> Path:
    path = folder / name
    path.write_text(text)
    return path


def refusal(path: Path) -> str:
    with pytest.raises(CaseError) as told:
        list(read_output(path).frames())
    return str(told.value)


def timed(steps: list[int]) -> list[str]:
    """Return frames with what `dump_modify time yes units yes` adds: the units once, each time."""
    texts = [f"ITEM: TIME\n{step / 8}\n" + frame_text(step, known(3, step)) for step in steps]
    return ["ITEM: UNITS\ncgs\n" + texts[0], *texts[1:]]


def test_time_and_units_above_a_frame_are_those_of_the_frame(tmp_path: Path):
    output = read_output(write(tmp_path, "".join(timed([0, 4, 8]))))
    assert output.units == "cgs"
    frames = list(output.frames())
    assert [(one.step, one.time_s, len(one.grains)) for one in frames] == [
        (0, 0.0, 3), (4, 0.5, 3), (8, 1.0, 3),
    ]  # fmt: skip
    assert frames[2].grains["x"].tolist() == pytest.approx((known(3, 8)["x"] / 100).tolist())
    count = {"grains": EXTRACTORS["count"]()}
    table = measure_frames(output, count, (0.0, 1.0), Grains()).table
    assert table["time_s"].tolist() == [0.0, 0.5, 1.0]


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_a_file_with_times_is_used_up_to_any_cut(tmp_path: Path, end: str):
    texts = [text.replace("\n", end) for text in timed([0, 4])]
    whole, path = "".join(texts), tmp_path / "run.dump"
    for kept in range(len(texts[0]) + 1, len(whole)):
        path.write_bytes(whole[:kept].encode())
        output = read_output(path)
        assert [frame.step for frame in output.frames()] == [0]
        assert len(output.notes) == 1
    for kept in range(1, len(texts[0])):
        path.write_bytes(whole[:kept].encode())
        assert str(path) in refusal(path)


def test_scaled_coordinates_follow_the_edges_of_any_box(tmp_path: Path):
    """`triclinic/general yes`: each line has an edge and a coordinate of the corner."""
    rows = ["1 0 0 0 0.1", "2 1 0 0 0.1", "3 0 1 0 0.1", "4 0 0 1 0.1"]
    bounds = "2 1 0 -1\n0 3 0.5 -2\n1 0 4 -3"
    text = with_rows("id xs ys zs radius", *rows, box="abc origin pp pp pp", bounds=bounds)
    (frame,) = read_output(write(tmp_path, text)).frames()
    wanted = [[-1, -2, -3], [1, -1, -3], [-1, 1, -2.5], [0, -2, 1]]
    np.testing.assert_allclose(frame.grains[["x", "y", "z"]], wanted, rtol=1e-12)
    cut = write(tmp_path, text.replace("0 3 0.5 -2", "0 3 0.5"))
    assert "run.dump:7: expected an edge of the box" in refusal(cut)


@pytest.mark.parametrize(
    "second", [" 9 1 0 0 0 0.01 ", "9\t1 0 0 0 0.01", "9 1  -0 0 0 0.01 ", "9 1 0 0 0 0.01"]
)
def test_blanks_may_differ_from_row_to_row(tmp_path: Path, second: str):
    text = with_rows("id type x y z radius", "10 1 0 0 0 0.01 ", second)
    (frame,) = read_output(write(tmp_path, text)).frames()
    assert frame.grains["id"].tolist() == [10, 9]
    assert frame.grains["radius"].tolist() == [0.01, 0.01]


@pytest.mark.parametrize(
    ("word", "why"),
    [
        ("True", "'True' is not a number; numbers are written as"),  # 1.0 to a reader of tables
        ("FALSE", "'FALSE' is not a number"),
        ("1.0D-3", "'1.0D-3' is not a number; numbers are written as 0.0015 or 1.5e-3"),
        ("0,5", "'0,5' is not a number"),
        ("1_0", "'1_0' is not a number"),
        ("-inf", "'-inf' is not a number that can be measured; take this frame out"),
    ],
)
def test_a_word_that_is_no_number_is_told_with_the_remedy(tmp_path: Path, word: str, why: str):
    path = write(tmp_path, with_rows("id x y z", f"1 0 {word} 0 ", f"2 0 {word} 0 "))
    assert f"{path}:10: column y: {why}" in refusal(path)


def test_ids_are_kept_or_refused_never_rounded(tmp_path: Path):
    (frame,) = read_output(write(tmp_path, with_rows("id x", f"{2**53 - 1} 0", "3 0"))).frames()
    assert frame.grains["id"].tolist() == [2**53 - 1, 3]
    path = write(tmp_path, with_rows("id x", "1 0", f"{2**53 + 1} 0"))
    assert f"{path}:11: column id: '{2**53 + 1}' is too large" in refusal(path)


def test_a_grain_that_stands_there_twice_is_refused(tmp_path: Path):
    path = write(tmp_path, with_rows("id x", "7 0", "3 0", "7 1"))
    assert f"{path}:1: step 0: the id 7 stands there twice" in refusal(path)
    write(tmp_path, with_rows("id x", "0 0", "0 1"))  # `atom_modify id no`: 0 is none
    (frame,) = read_output(path).frames()
    assert len(frame.grains) == 2


def test_columns_of_words_are_left_out(tmp_path: Path):
    text = with_rows("id typelabel element x", "1 glass Si 0.5", "2 false NA 0.25")
    (frame,) = read_output(write(tmp_path, text)).frames()
    assert frame.grains.to_dict("list") == {"id": [1, 2], "x": [0.5, 0.25]}


def test_a_dump_that_names_no_column_says_what_it_must_name(tmp_path: Path):
    path = write(tmp_path, with_rows("", "1 1 0.5 0.5 0.5"))
    assert f"{path}:9: names no column; expected 'ITEM: ATOMS id type x y z" in refusal(path)


def test_a_step_that_stands_there_twice_is_said(tmp_path: Path):
    frames = [frame_text(step, known(3)) for step in (0, 5, 5, 10)]
    output = read_output(write(tmp_path, "".join(frames)))
    (note,) = output.notes
    assert "run.dump: step 5 stands there twice, as in a run that was continued" in note
    assert [frame.step for frame in output.frames()] == [0, 5, 5, 10]


def test_small_compressed_files_are_used_up_to_their_damage(tmp_path: Path):
    packed = gzip.compress((frame_text(0, known(3)) + frame_text(5, known(3))).encode())
    path = tmp_path / "run.dump.gz"
    path.write_bytes(packed[:-12])
    assert [frame.step for frame in read_output(path).frames()] == [0]
    path.write_bytes(packed + b"garbage")
    output = read_output(path)
    assert [frame.step for frame in output.frames()] == [0, 5]
    (note,) = output.notes
    assert "cannot be read further" in note


@pytest.mark.parametrize(
    ("content", "why"),
    [
        (b"", "it is empty"),
        ("\ufeffITEM: TIMESTEP\n".encode(), "a byte order mark, as editors write; save it as"),
        ("ITEM: TIMESTEP\n".encode("utf-16"), "a byte order mark"),
        (b"3\nAtoms. Timestep: 0\n1 0 0 0\n", "it begins with '3'"),
    ],
)
def test_a_file_that_is_no_dump_is_told_by_its_begin(tmp_path: Path, content: bytes, why: str):
    path = tmp_path / "run.xyz"
    path.write_bytes(content)
    with pytest.raises(CaseError, match=f"no dump of grains.*{why}"):
        read_output(path).first()


@pytest.mark.parametrize("place", ["run", "run/post", "run/post/a.dump", "run/b.dump"])
def test_units_are_those_of_the_run_whichever_part_of_it_is_named(tmp_path: Path, place: str):
    (tmp_path / "run" / "post").mkdir(parents=True)
    for name in ("run/post/a.dump", "run/b.dump"):
        write(tmp_path, frame_text(7, known(4)), name)
    write(tmp_path, LOG, "run/log.liggghts")
    output = read_output(tmp_path / place)
    assert (output.units, output.time_of(7)) == ("cgs", pytest.approx(7e-5))
    said = [one for one in output.remarks if "time step and units are taken from there" in one]
    assert len(said) == (place != "run")  # a log that was not named is said


def test_dumps_that_may_be_parts_of_one_are_said(tmp_path: Path):
    for name in ("d.0.0", "d.0.100", "d.1.0", "d.1.100", "other.0", "other.100"):
        write(tmp_path, frame_text(0, known(3)), name)
    (remark,) = read_output(tmp_path).remarks
    assert remark.startswith("d.0.*, d.1.*: 2 dumps of the same steps, one is measured; if each")
    write(tmp_path, frame_text(0, known(3)), "d.1.200")
    assert read_output(tmp_path).remarks == ()


def test_units_that_cannot_be_converted_are_told_with_who_says_so(tmp_path: Path):
    remedy = r"cannot be converted \(known: .*\); --units NAME says which they are"
    write(tmp_path, "ITEM: UNITS\nmetal\nITEM: TIME\n0\n" + frame_text(0, known(3)))
    with pytest.raises(CaseError, match=f"^run.dump: units 'metal': {remedy}"):
        read_output(tmp_path)
    write(tmp_path, frame_text(0, known(3)))
    write(tmp_path, LOG.replace("cgs", "real"), "log.lammps")
    with pytest.raises(CaseError, match=f"^log.lammps: units 'real': {remedy}"):
        read_output(tmp_path)
    assert read_output(tmp_path, units="si").units == "si"


def test_units_of_the_dump_go_before_those_of_the_log(tmp_path: Path):
    write(tmp_path, "ITEM: UNITS\nsi\nITEM: TIME\n0\n" + frame_text(0, known(3)))
    write(tmp_path, LOG, "log.liggghts")
    output = read_output(tmp_path)
    assert output.units == "si"
    assert "run.dump: units si, not cgs as in the log" in output.remarks
