"""Words of a mesh: where LIGGGHTS 3.8.0 takes them, and what they leave of the file."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from minidem import ScriptError, check_script, run_script
from minidem.words import Words
from minidem.world.mesh.source import MeshFile
from tests.minidem.script.test_acceptance import after

FLAT = ((0, 0, 0.045), (0.1, 0, 0.045), (0, 0.1, 0.045))
OTHER = ((0.1, 0, 0.045), (0.1, 0.1, 0.045), (0, 0.1, 0.045))
THIN = ((0, 0, 0.01), (0.1, 0, 0.01), (0.05, 1e-5, 0.01))
"""Its smallest angle is 0.011 degrees."""
LINES = 7
"""Of a triangle in the file; the first begins in line 2."""
WALL = "fix v all wall/gran model hertz tangential history mesh n_meshes 1 meshes c"
TAKEN = {
    "heal before type": "heal auto_remove_duplicates type 1",
    "heal behind type": "type 1 heal no",
    "all of them": "verbose no precision 1e-7 type 1 heal no scale 1.0 move 0 0 0 curvature 1",
    "a region": "region left type 1",
    "partly outside": "type 1 move 0.03 0.02 0.055",
    "a list to write": "element_exclusion_list write x.txt type 1",
}
REFUSED = {
    "type 0": ("type 0", "type 0 is not above 0"),
    "no type": ("heal no", "expected 'type'"),
    "heal too late": ("type 1 scale 1 heal no", "'heal' has to stand beside 'type'"),
    "scale too late": ("type 1 curvature 1 scale 1", "'scale' has to stand right behind 'type'"),
    "coarse precision": ("precision 0.01 type 1", "not between 0 and 0.001"),
    "centres outside": ("type 1 move 0.07 0 0", "triangles lie outside of the box"),
    "above the box": ("type 1 move 0 0 0.0551", "triangles lie outside of the box"),
    "a duplicate": ("type 1", "use 'heal auto_remove_duplicates'"),
    "a sliver": (
        "type 1 curvature_tolerant yes",
        "1 elements, number 1 first, have an angle below",
    ),
}


def stl(*triangles: tuple[tuple[float, float, float], ...]) -> str:
    """Return the text of a mesh."""
    lines = ["solid s"]
    for one in triangles:
        corners = [f"vertex {x} {y} {z}" for x, y, z in one]
        lines += ["facet normal 0 0 1", "outer loop", *corners, "endloop", "endfacet"]
    return "\n".join([*lines, "endsolid s"]) + "\n"


def script(folder: Path, words: str, *triangles: tuple[tuple[float, float, float], ...]) -> Path:
    """Write a mesh and a script with it."""
    (folder / "s.stl").write_text(stl(*triangles))
    region = "region left block -1 1 -1 1 -1 1 units box"
    path = folder / "in.s"
    path.write_text(after(f"{region}\nfix c all mesh/surface file s.stl {words}\n{WALL}"))
    return path


def refused(folder: Path, name: str) -> Path:
    more = {"a duplicate": (FLAT,), "a sliver": (THIN,)}
    return script(folder, REFUSED[name][0], FLAT, *more.get(name, ()))


def of_file(
    folder: Path, words: str, *triangles: tuple[tuple[float, float, float], ...]
) -> MeshFile:
    (folder / "s.stl").write_text(stl(*triangles))
    return MeshFile.read(folder, {}, Words(f"file s.stl {words}".split(), "fix"))


@pytest.mark.parametrize("name", TAKEN)
def test_what_liggghts_takes_runs(tmp_path, name):
    run_script(script(tmp_path, TAKEN[name], FLAT, OTHER), root=tmp_path)


@pytest.mark.parametrize("name", REFUSED)
def test_what_liggghts_refuses_is_refused_with_the_reason(tmp_path, name):
    with pytest.raises(ScriptError) as caught:
        run_script(refused(tmp_path, name), root=tmp_path)
    assert REFUSED[name][1] in str(caught.value)


@pytest.mark.liggghts
@pytest.mark.parametrize("name", [*TAKEN, *REFUSED])
def test_liggghts_says_the_same(tmp_path, name):
    if name in TAKEN:
        script(tmp_path, TAKEN[name], FLAT, OTHER)
    else:
        refused(tmp_path, name)
    assert (liggghts(tmp_path) == 0) == (name in TAKEN)


@pytest.mark.liggghts
def test_faces_that_follow_are_no_limit_to_a_mesh(tmp_path):
    path = script(tmp_path, REFUSED["centres outside"][0], FLAT, OTHER)
    path.write_text(path.read_text().replace("boundary f f f", "boundary m m f"))
    assert liggghts(tmp_path) == 0
    run_script(path, root=tmp_path)


def liggghts(folder: Path) -> int:
    program = shutil.which("liggghts")
    assert program
    done = subprocess.run([program, "-in", "in.s"], cwd=folder, capture_output=True, check=False)
    return done.returncode


def facets(path: Path) -> int:
    """Return how many triangles of a script's mesh both programs keep."""
    path.write_text(path.read_text().replace("run 3", "dump d all mesh/stl 3 m*.stl\nrun 3"))
    found = path.with_name("m3.stl")
    assert liggghts(path.parent) == 0
    theirs = found.read_text().split().count("endfacet")
    found.unlink()
    run_script(path, root=path.parent)
    assert found.read_text().split().count("endfacet") == theirs
    return theirs


def test_precision_says_which_nodes_are_one(tmp_path):
    near = tuple((x, y, z + 1e-6) for x, y, z in FLAT)
    assert len(of_file(tmp_path, "heal auto_remove_duplicates type 1", FLAT, near).nodes) == 2
    healed = of_file(tmp_path, "type 1 heal auto_remove_duplicates precision 1e-5", FLAT, near)
    np.testing.assert_array_equal(healed.nodes, [FLAT])


@pytest.mark.liggghts
def test_region_leaves_what_liggghts_leaves(tmp_path):
    """Of the second triangle one node lies outside."""
    path = script(tmp_path, "region left type 1", FLAT, OTHER)
    text = path.read_text().replace("block -1 1 -1 1 -1 1", "sphere 0 0 0.045 0.105")
    path.write_text(text)
    assert facets(path) == 1


@pytest.mark.liggghts
def test_what_is_no_triangle_in_the_file_is_none_when_it_is_scaled(tmp_path):
    """In kilometres two nodes are one, to 1e-8; in metres they are 5e-6 apart."""
    km = tuple((x / 1000.0, y / 1000.0, z / 1000.0) for x, y, z in FLAT)
    path = script(
        tmp_path, "type 1 scale 1000", km, ((0, 0, 1e-5), (5e-9, 0, 1e-5), (0, 1e-4, 1e-5))
    )
    assert facets(path) == 1


def test_a_mesh_that_is_scaled_to_nothing_is_refused(tmp_path):
    with pytest.raises(ScriptError, match="after 'scale' no triangle of mesh c is larger than"):
        run_script(script(tmp_path, "type 1 scale 1e-12", FLAT), root=tmp_path)


def test_region_without_a_triangle_is_refused(tmp_path):
    path = script(tmp_path, "region left type 1", FLAT)
    path.write_text(path.read_text().replace("block -1 1 -1 1 -1 1", "sphere 1 0 0 0.1"))
    with pytest.raises(ScriptError, match="no triangle of the file is left"):
        run_script(path, root=tmp_path)


@pytest.mark.liggghts
def test_list_of_slivers_is_that_of_liggghts_and_leads_to_a_mesh_without_them(tmp_path):
    path = script(tmp_path, "element_exclusion_list write x.txt type 1", FLAT, THIN, OTHER)
    text = path.read_text()
    assert liggghts(tmp_path) != 0
    theirs = {int(line) for line in (tmp_path / "x.txt").read_text().split()}
    assert theirs == {2 + LINES}
    (tmp_path / "x.txt").unlink()

    assert not check_script(path, root=tmp_path)
    assert not (tmp_path / "x.txt").exists()
    with pytest.raises(ScriptError, match=r"x\.txt is written: 1 triangles"):
        run_script(path, root=tmp_path)
    assert (tmp_path / "x.txt").read_text() == f"{2 + LINES}\n"
    path.write_text(text.replace("list write", "list read"))
    run_script(path, root=tmp_path)
