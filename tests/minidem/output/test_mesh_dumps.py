"""Meshes as VTK files with forces and wear of their triangles, against those of LIGGGHTS."""

from __future__ import annotations

import shutil

import pytest

from minidem import run_script
from minidem.errors import ScriptError
from tests.minidem.output import scenes

DUMPS = """dump a all mesh/vtk 50 post/a*.vtk stress stresscomponents id wear area vel
dump b all mesh/vtk 50 post/b*.vtk stress wear index aedges acorners nneighs owner cm cp
dump c all mesh/vtk 50 post/c*.vtk output interpolate stress wear id vel
dump d all mesh/vtk 50 post/d*.vtk output original id vel cn
dump e all mesh/vtk 50 post/e*.vtk output original id vel cm
dump f all mesh/vtk 50 post/f*.vtp output original stress id wear vel
dump g all mesh/gran/VTK 50 post/g*.vtk stress cp
dump h all mesh/gran/VTK 50 post/h*.vtk stress temp f wear_step sigma_n distaa
dump i all stl 50 post/i*.stl
dump j all mesh/vtk 150 post/j.vtk id wear
run 1
run 299
"""


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Return the files that minidem writes."""
    return scenes.run_minidem(tmp_path_factory.mktemp("mine"), scenes.scene(DUMPS))


def test_forces_and_wear_are_those_of_liggghts(files):
    for name in ("a100.vtk", "c100.vtk", "f100.vtp"):
        assert scenes.alike(files[f"post/{name}"], (scenes.STORED / name).read_text()), name


@pytest.mark.liggghts
def test_all_mesh_files_are_those_of_liggghts(files, tmp_path):
    theirs = scenes.run_liggghts(tmp_path, scenes.scene(DUMPS))
    assert len(theirs) > 60
    assert scenes.different(files, theirs) == []
    exact = [name for name in files if name.endswith((".vtk", ".stl"))]
    assert [name for name in exact if files[name] != theirs[name]] == []


def test_wear_continues_after_a_restart_and_with_two_threads(tmp_path):
    dump = "dump a all mesh/vtk 100 post/a*.vtk wear\n"
    first = scenes.scene(dump + "run 100\nwrite_restart half.restart\nrun 100\n")
    whole = scenes.run_minidem(tmp_path / "whole", first)["post/a200.vtk"]
    fixes = [line for line in scenes.HEAD.splitlines() if line.startswith(("fix", "pair"))]
    second = [*scenes.HEAD.splitlines()[:6], "read_restart half.restart", *fixes[:5]]
    second += ["neighbor 0.002 bin", "neigh_modify delay 0", *fixes[5:], "timestep 1e-5"]
    script = "\n".join([*second, scenes.TAIL, dump, "run 100\n"])
    (tmp_path / "rest").mkdir()
    shutil.copy(tmp_path / "whole" / "half.restart", tmp_path / "rest")
    continued = scenes.run_minidem(tmp_path / "rest", script, threads=2)["post/a200.vtk"]
    assert scenes.alike(continued, whole)
    assert "wear 1 6 double\n0.27" in whole


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("dump a all mesh/vtk 1 f.vtk stres", "did you mean 'stress'?"),
        ("dump a all mesh/vtk 1 f.vtk cm", "no quantity is asked for"),
        ("dump a all mesh/vtk 1 f.vtu id", "must end in .vtk or .vtp"),
        ("dump a all mesh/vtk 1 f*.vtk output faces id", "did you mean 'face'?"),
    ],
)
def test_mistake_names_file_and_line(tmp_path, line, message):
    script = scenes.write(tmp_path, scenes.scene(line + "\n"))
    with pytest.raises(ScriptError) as error:
        run_script(script, root=tmp_path)
    assert message in str(error.value)


def test_wear_needs_its_coefficient(tmp_path):
    script = scenes.write(tmp_path, scenes.scene("run 1\n").replace("k_finnie", "k_finny"))
    with pytest.raises(ScriptError, match="k_finnie"):
        run_script(script, root=tmp_path)
