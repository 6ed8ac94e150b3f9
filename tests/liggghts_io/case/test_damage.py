"""Damaged files: refused by name or harmless, and mended when the case is run again."""

import shutil

import pytest

from liggghts_io import (
    CaseError,
    chart_case,
    execute,
    load_result,
    post_case,
    render_case,
    run_case,
)
from liggghts_io.case.directory import load_record
from liggghts_io.case.output import drawable_run

FILES = [
    "case.json", "in.script", "meshes/plate.stl", "meshes/scale.stl", "result.json",
    "mass_time.csv", "output/end.json", "output/in.script", "output/meshes/plate.stl",
    "output/scale.txt", "output/log.liggghts", "output/post/frame_0.dump", "output/post/LAST",
]  # fmt: skip


def flipped(part):
    """Return a function that flips one bit at a part of the length."""

    def flip(content):
        at = int(part * len(content))
        return content[:at] + bytes([content[at] ^ 4]) + content[at + 1 :]

    return flip


DAMAGES = {
    "emptied": lambda content: b"",
    "cut in half": lambda content: content[: len(content) // 2],
    "last byte lost": lambda content: content[:-1],
    "bit flipped in the head": flipped(0.02),
    "bit flipped in the middle": flipped(0.51),
    "bit flipped at the end": flipped(0.985),
    "zeros": lambda content: bytes(len(content)),
    "garbage": lambda content: bytes(range(256)),
    "nested": lambda content: b"[" * 100_000,
    "missing": None,
}


def draw(case):
    """Do what a picture does before it draws."""
    drawable_run(case, load_record(case)["case_id"])
    return load_result(case)


def outcome(read, case):
    """Return the observables that a function gives, or None and the message of its refusal."""
    try:
        return read(case).observables, ""
    except CaseError as err:
        return None, str(err)


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    return tmp_path_factory.mktemp("kept")


@pytest.fixture
def case(timed_spec, kept, tmp_path):
    """Return a copy of a case of a campaign that was run."""
    first = execute(timed_spec(), kept)
    assert first.status == "ok"
    shutil.copytree(kept, tmp_path / "runs")
    return tmp_path / "runs" / first.path.name


def damaged(case, name, damage):
    """Damage one file of a case and return its path."""
    path = case / name
    if path.name == "LAST":
        path = max(path.parent.iterdir(), key=lambda frame: int(frame.stem.split("_")[1]))
    change = DAMAGES[damage]
    if change is None:
        path.unlink()
    else:
        path.write_bytes(change(path.read_bytes()))
    return path


@pytest.mark.parametrize("damage", DAMAGES)
@pytest.mark.parametrize("name", FILES)
def test_a_damaged_file_is_named_or_harmless_and_mended(case, timed_spec, name, damage):
    truth = load_result(case).observables
    path = damaged(case, name, damage)
    for read in (load_result, draw, post_case):
        found, refusal = outcome(read, case)
        assert found == truth or path.name in refusal
    again = execute(timed_spec(), case.parent)
    assert again.observables == truth
    assert load_result(case) == again


@pytest.mark.parametrize("name", ["output/post/frame_0.dump", "output/meshes/plate.stl"])
def test_no_picture_of_a_damaged_run(case, name):
    path = damaged(case, name, "bit flipped in the middle")
    for picture in (render_case, chart_case):
        with pytest.raises(CaseError, match=rf"{path.name}: was changed or cut since the run"):
            picture(case)


def test_a_file_too_many_is_named(case):
    (case / "output" / "post" / "frame_7.dump").write_text("")
    with pytest.raises(CaseError, match=r"frame_7.dump: was not written by the run; remove it"):
        post_case(case)


def test_an_output_of_another_case_is_refused(case, timed_spec, tmp_path):
    other = execute(timed_spec(seed=2), tmp_path / "other").path
    shutil.rmtree(case / "output")
    shutil.copytree(other / "output", case / "output")
    with pytest.raises(CaseError, match=r"end.json: belongs to another case"):
        post_case(case)


def test_a_result_of_another_run_is_not_drawn(case):
    shutil.copy(case / "result.json", case.parent / "result.json")
    run_case(case, again=True)
    shutil.copy(case.parent / "result.json", case / "result.json")
    with pytest.raises(CaseError, match="the result is of another run than the output"):
        chart_case(case)
