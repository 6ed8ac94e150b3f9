"""Damaged output is told with file and line, or used up to the damage; nothing else happens."""

from __future__ import annotations

import gzip
import shutil
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from liggghts_io.errors import CaseError
from liggghts_io.foreign import facts_of, read_output
from tests.liggghts_io.foreign.grains import DATA, frame_text, known, write_frames

THREE = "".join(frame_text(1000 * k, known(5, k)) for k in range(3))
LINES = 9 + 5  # of a frame


def write(folder: Path, content: str | bytes, name: str = "run.dump") -> Path:
    path = folder / name
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


def steps_of(place: Path) -> list[int]:
    return [frame.step for frame in read_output(place).frames()]


@pytest.mark.parametrize(
    ("bytes_kept", "line"),
    [
        (THREE.rindex("ITEM: TIMESTEP") + 8, 2 * LINES + 1),  # in the head
        (THREE.rindex("ITEM: ATOMS") + 4, 2 * LINES + 9),
        (len(THREE) - 100, 2 * LINES + 9 + 4),  # in a row
        (len(THREE) - 1, 2 * LINES + 9 + 5),
        (THREE.rindex("ITEM: ATOMS") - 30, None),
    ],
)
def test_a_frame_cut_at_the_end_is_left_out_and_said(
    tmp_path: Path, bytes_kept: int, line: int | None
):
    path = write(tmp_path, THREE[:bytes_kept])
    assert steps_of(path) == [0, 1000]
    (note,) = read_output(path).notes
    assert note.startswith(f"{path}:{line or ''}")
    assert note.endswith("this frame is left out")


@pytest.mark.parametrize("empty", [[0], [0, 1000], [2000], [0, 1000, 2000]])
def test_frames_without_grains_are_frames_in_the_legacy_format_too(tmp_path: Path, empty):
    """LIGGGHTS writes the number 0 of them and nothing else: no columns, no cells."""
    for step in (0, 1000, 2000):
        shutil.copy(DATA / "post" / "v_1000.vtk", tmp_path / f"v_{step}.vtk")
    head = (DATA / "post" / "v_1000.vtk").read_text().partition("POINTS")[0]
    for step in empty:
        (tmp_path / f"v_{step}.vtk").write_text(f"{head}POINTS 0 float\n")
    frames = list(read_output(tmp_path).frames())
    grains = {frame.step: len(frame.grains) for frame in frames}
    assert grains == {step: 0 if step in empty else 12 for step in (0, 1000, 2000)}
    assert len({tuple(sorted(frame.grains)) for frame in frames}) == 1


def test_a_gzip_cut_in_the_middle_is_used_up_to_there(tmp_path: Path):
    packed = gzip.compress("".join(frame_text(k, known(500, k)) for k in range(9)).encode())
    path = write(tmp_path, packed[: len(packed) // 2], "run.dump.gz")
    assert 0 < len(steps_of(path)) < 9
    (note,) = read_output(path).notes
    assert "the compressed file cannot be read further" in note


def test_an_empty_last_file_and_a_directory_among_the_frames_are_said(tmp_path: Path):
    paths = write_frames(tmp_path)
    paths[-1].write_bytes(b"")
    (tmp_path / "f_9000.dump").mkdir()
    assert steps_of(tmp_path) == [0, 1000]
    notes = " ".join(read_output(tmp_path).notes)
    assert f"{tmp_path / 'f_9000.dump'}: a directory, not a dump" in notes
    assert f"{paths[-1]}:1: expected 'ITEM: TIMESTEP'" in notes


def changed(old: str, new: str) -> str:
    """Return the frames with a change in the second one."""
    start = THREE.index("1000\n")
    assert old in THREE[start:]
    return THREE[:start] + THREE[start:].replace(old, new, 1)


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        (changed("\n5\n", "\n6\n"), LINES + 15, "announces 6 grains, 5 whole rows"),
        (changed("\n5\n", "\n4\n"), LINES + 14, "announces 4 grains, 5 whole rows"),
        (changed("\n5\n", "\nfive\n"), LINES + 4, "expected a whole number"),
        (changed("\n5\n", f"\n{'9' * 40}\n"), LINES + 4, "expected a whole number"),
        (changed("0.003 ", "abc "), LINES + 10, "column radius: 'abc' is not a number"),
        (changed("0.003 ", "nan "), LINES + 10, "column radius: 'nan' is not a number"),
        (changed("0.003 ", ""), LINES + 10, "expected the 9 columns of the head, got 8"),
        (changed("0.003 ", "0.003 7 "), LINES + 10, "expected the 9 columns of the head, got 10"),
        (changed("-0.1 0.1", "-0.1"), LINES + 6, "expected two bounds"),
        (changed("ITEM: ATOMS id", "ITEM: ATOMS"), LINES + 1, "two dumps of different columns"),
        (changed("ITEM: ATOMS id", "ITEM: ATOMS x"), LINES + 9, "names a column twice"),
        (changed("ITEM: ATOMS", "ITEM: ENTRIES"), LINES + 9, "expected 'ITEM: ATOMS'"),
        (changed("0.003 ", "0.003\0 "), LINES + 10, "is not a number"),
    ],
)
def test_damage_within_is_told_with_its_line(tmp_path: Path, text: str, line: int, message: str):
    path = write(tmp_path, text)
    with pytest.raises(CaseError) as told:
        steps_of(path)
    assert str(told.value).startswith(f"{path}:{line}: ")
    assert message in str(told.value)


def test_steps_that_go_back_are_said(tmp_path: Path):
    write(tmp_path, THREE, "run1.dump")
    write(tmp_path, THREE, "run2.dump")
    (note,) = read_output(tmp_path).notes
    assert "steps go back from 2000 to 0" in note
    assert steps_of(tmp_path / "run2.dump") == [0, 1000, 2000]
    assert [frame.step for frame in read_output(tmp_path, "run2.dump").frames()] == [0, 1000, 2000]


def test_a_vtk_file_of_other_columns_or_numbers_is_told(tmp_path: Path):
    for step in (1000, 2000):
        shutil.copyfile(DATA / "post" / f"v_{step}.vtk", tmp_path / f"v_{step}.vtk")
        shutil.copyfile(DATA / "post" / f"v_{step}.vtk", tmp_path / f"v_{step + 2000}.vtk")
    last = tmp_path / "v_4000.vtk"
    last.write_bytes(last.read_bytes()[:600])
    assert steps_of(tmp_path) == [1000, 2000, 3000]
    (note,) = read_output(tmp_path).notes
    assert note.startswith(f"{last}: cannot be read (its last line has no end")
    middle = tmp_path / "v_2000.vtk"
    middle.write_text(middle.read_text().replace("radius", "size"))
    with pytest.raises(CaseError, match=r"v_2000.vtk: radius, size only here or only in .*v_1000"):
        steps_of(tmp_path)
    middle.write_bytes(middle.read_bytes()[:600])
    with pytest.raises(CaseError, match=r"v_2000.vtk: cannot be read .*take it out"):
        steps_of(tmp_path)


damages = st.lists(
    st.tuples(
        st.sampled_from(["cut", "byte", "drop", "add"]),
        st.floats(0.0, 1.0, exclude_max=True),
        st.sampled_from([b"9" * 30, b"-", b"abc ", b"\0", b"nan ", b"\n", b" ", b"\xff", b"ITEM:"]),
    ),
    min_size=1,
    max_size=3,
)


def damaged(content: bytes, how: list[tuple[str, float, bytes]]) -> bytes:
    for kind, where, word in how:
        at = int(where * len(content))
        if kind == "cut":
            content = content[:at]
        elif kind == "byte":
            content = content[:at] + word[:1] + content[at + 1 :]
        elif kind == "drop":
            content = content[:at] + content[at + 7 :]
        else:
            content = content[:at] + word + content[at:]
    return content


def read_all(name: str, content: bytes) -> None:
    """Read a file: what comes out is an error that names it, or whole frames."""
    with TemporaryDirectory() as folder:
        write(Path(folder), content, name)
        try:
            output = read_output(Path(folder))
            facts = facts_of(output.first(), "si")
        except CaseError as err:
            told = str(err)
        else:
            told = folder
            assert len(list(output.frames())) == facts.frames >= 1
        assert folder in told


@settings(max_examples=150, deadline=None)
@given(how=damages)
def test_any_damage_to_a_text(how):
    read_all("run.dump", damaged(THREE.encode(), how))


@settings(max_examples=60, deadline=None)
@given(how=damages)
def test_any_damage_to_a_gzip(how):
    read_all("run.dump", damaged(gzip.compress(THREE.encode()), how))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["v_1000.vtk", "v_1000.vtp", "bin_1000.vtk", "av_1000.vtk"])
@settings(max_examples=3, deadline=None)
@given(how=damages)
def test_any_damage_to_a_vtk_file(name: str, how):
    """VTK's readers end the process at some of these; ours goes on."""
    read_all(name, damaged((DATA / "post" / name).read_bytes(), how))
