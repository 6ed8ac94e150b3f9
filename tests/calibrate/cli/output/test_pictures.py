"""`bulkcal render` on cases, and on output of other people's runs."""

from __future__ import annotations

import gzip
import json
from pathlib import Path

import cv2
import numpy as np
import pytest

from liggghts_io.pictures import child
from tests.liggghts_io.foreign.grains import DATA, frame_text, known, write_frames

TRIANGLE = (
    "solid plate\nfacet normal 0 0 1\nouter loop\nvertex -0.1 -0.1 0\nvertex 0.1 -0.1 0\n"
    "vertex 0.1 0.1 0\nendloop\nendfacet\nendsolid plate\n"
)


@pytest.fixture(autouse=True)
def discs(monkeypatch, tmp_path: Path):
    """Draw discs, which is quicker, in an empty directory."""
    monkeypatch.setattr(child, "_started", lambda: None)
    monkeypatch.chdir(tmp_path)


def left_in(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


def test_a_foreign_run_is_drawn_with_meshes_from_any_side(bulkcal, tmp_path: Path):
    write_frames(tmp_path / "run", (40, 40, 40))
    (tmp_path / "plate.stl").write_text(TRIANGLE)
    for view in ("side", "front", "top", "iso"):
        words = ["--view", view, "--colour", "speed", "--mesh", "plate.stl", "--out", f"{view}.png"]
        code, out, err = bulkcal("render", "run", "-q", *words)
        assert (code, out, err) == (0, f"wrote {view}.png\n", "")
        assert cv2.imread(f"{view}.png").shape[1] == 1050
    assert left_in(tmp_path) == {"run", "plate.stl", "side.png", "front.png", "top.png", "iso.png"}
    assert left_in(tmp_path / "run") == {"f_0.dump", "f_1000.dump", "f_2000.dump"}


def test_a_page_a_film_and_a_turntable_at_once(bulkcal, tmp_path: Path, monkeypatch):
    monkeypatch.setattr("liggghts_io.pictures.film._TURN_S", 0.5)
    write_frames(tmp_path / "run", (9, 9, 9))
    words = ["--html", "a.html", "--movie", "a.gif", "--turntable", "b.gif", "--json"]
    code, out, err = bulkcal("render", "run", *words)
    assert code == 0, err
    assert json.loads(out) == {"movie": "a.gif", "turntable": "b.gif", "page": "a.html"}
    assert left_in(tmp_path) == {"run", "a.html", "a.gif", "b.gif"}
    assert "Content-Security-Policy" in (tmp_path / "a.html").read_text()


def test_what_liggghts_wrote_as_vtk_and_text_is_the_same_picture(bulkcal):
    """`dump custom` has six digits, `custom/vtk` its own; grains stand in the same place."""
    drawn = []
    for number, name in enumerate(("post/f_*.dump", "post/v_*.vtp")):
        target = f"{number}.png"
        words = ["--dump", name, "--colour", "height", "--frame", "last", "--out", target]
        code, _, err = bulkcal("render", str(DATA), *words)
        assert code == 0, err
        drawn.append(cv2.imread(target).astype(int)[100:])  # below the title with the name
    assert np.abs(drawn[0] - drawn[1]).mean() < 1.0


def test_a_dump_without_velocities_is_coloured_by_height(bulkcal, tmp_path: Path):
    bare = {name: values for name, values in known(20).items() if name in ("id", "x", "y", "z")}
    (tmp_path / "run.dump").write_text(frame_text(0, bare))
    code, _, err = bulkcal("render", "run.dump")
    assert code == 2
    assert "give the grains' diameter with --diameter M" in err
    assert bulkcal("render", "run.dump", "--diameter", "0.004")[0] == 0
    code, _, err = bulkcal("render", "run.dump", "--diameter", "0.004", "--colour", "speed")
    assert code == 2
    assert "the dump has no column vx; choose height or size" in err


def test_a_last_frame_that_was_cut_is_left_out_and_said(bulkcal, tmp_path: Path):
    text = "".join(frame_text(1000 * k, known(5, k)) for k in range(3))
    (tmp_path / "run.dump.gz").write_bytes(gzip.compress(text[:-40].encode()))
    code, out, err = bulkcal("render", "run.dump.gz")
    assert code == 0
    assert out.startswith("wrote scene.png\nnext: bulkcal render run.dump.gz --html scene.html")
    assert "this frame is left out" in err


def test_only_pictures_of_ours_are_drawn_anew(bulkcal, tmp_path: Path):
    write_frames(tmp_path / "run")
    mine = tmp_path / "scene.png"
    mine.write_bytes(b"\x89PNG mine")
    code, out, err = bulkcal("render", "run")
    assert (code, out) == (2, "")
    assert "scene.png: exists already and was not drawn by bulkcal; name another file" in err
    assert mine.read_bytes() == b"\x89PNG mine"
    mine.unlink()
    for _ in range(2):
        assert bulkcal("render", "run")[0] == 0


MISTAKES = {
    "colour": (["--colour", "sped"], "did you mean 'speed'"),
    "view": (["--view", "tpo"], "did you mean 'top'"),
    "frame": (["--frame", "7"], "the run wrote frames 0 to 2"),
    "no number": (["--frame", "lst"], "write best, first, middle, last or a number from 0 to 2"),
    "mesh": (["--mesh", "none.stl"], "none.stl"),
    "no mesh": (["--mesh", "run/f_0.dump"], "f_0.dump"),
    "picture": (["--out", "a.jpg"], "--out a.jpg: name a file that ends in .png"),
    "folder": (["--out", "no/a.png"], "there is no directory no"),
    "film": (["--movie", "a.avi"], "--movie a.avi: name a file that ends in .mp4 or .gif"),
    "page": (["--html", "a.png"], "--html a.png: name a file that ends in .html"),
    "dump": (["--dump", "f_*.dmp"], "did you mean 'f_*.dump'"),
    "units": (["--units", "mm"], "units 'mm'"),
}


@pytest.mark.parametrize("name", MISTAKES)
def test_a_mistake_is_one_line_and_nothing_is_written(name: str, bulkcal, tmp_path: Path):
    write_frames(tmp_path / "run")
    words, expected = MISTAKES[name]
    code, out, err = bulkcal("render", "run", "-q", *words)
    assert (code, out) == (2, "")
    assert err.startswith("bulkcal: ")
    assert err.count("\n") == 1, err
    assert expected in err
    assert left_in(tmp_path) == {"run"}
    assert len(left_in(tmp_path / "run")) == 3


@pytest.mark.parametrize("words", [[], ["--movie", "a.gif"], ["--html", "a.html"]])
def test_an_empty_folder_and_a_damaged_dump_are_told_and_nothing_is_written(
    words: list[str], bulkcal, tmp_path: Path
):
    (tmp_path / "empty").mkdir()
    code, _, err = bulkcal("render", "empty", "-q", *words)
    assert (code, err.count("\n")) == (2, 1), err
    assert "empty: no dump of grains" in err
    paths = write_frames(tmp_path / "run")
    paths[2].write_text(paths[2].read_text().replace("0.003", "word", 1))
    code, _, err = bulkcal("render", "run", "-q", *words)
    assert (code, err.count("\n")) == (2, 1), err
    assert f"{Path('run') / 'f_2000.dump'}:10" in err
    assert left_in(tmp_path) == {"empty", "run"}
