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


GROUPS = """dump a all mesh/vtk 300 a*.vtk id wear stress
dump b all custom 300 b*.dump id x y z fx fy fz
dump_modify b sort id format "%d %.12g %.12g %.12g %.12g %.12g %.12g"
run 100
set atom 3 type 2
run 200
"""


def with_groups(wall: str, meshes: str) -> str:
    """Return a script with groups for the wall and the meshes, behind its particles."""
    lines = scenes.scene(GROUPS).splitlines()
    walls = [line for line in lines if " mesh" in line or "wall/" in line or "/mesh " in line]
    walls = [line for line in walls if line.startswith("fix")]
    lines = [line for line in lines if line not in walls]
    for one in ("cm", "cn"):
        walls = [line.replace(f"fix {one} all", f"fix {one} {meshes}") for line in walls]
    walls = [line.replace("fix w all", f"fix w {wall}") for line in walls]
    at = lines.index("fix integr all nve/sphere")
    lines[at:at] = ["group none id 99", "group odd type 1", *walls]
    return "\n".join(lines) + "\n"


def test_meshes_act_on_their_group_only(tmp_path):
    found = scenes.run_minidem(tmp_path, with_groups("all", "odd"))
    for name in ("a300.vtk", "b300.dump"):
        stored = (scenes.STORED / f"groups_{name}").read_text()
        assert scenes.alike(found[name], stored), name


@pytest.mark.liggghts
@pytest.mark.parametrize(
    ("wall", "meshes"),
    [("all", "odd"), ("odd", "all"), ("none", "all"), ("odd", "none")],
)
def test_groups_of_meshes_and_walls_are_those_of_liggghts(tmp_path, wall, meshes):
    script = with_groups(wall, meshes)
    mine = scenes.run_minidem(tmp_path / "mine", script)
    assert not scenes.different(mine, scenes.run_liggghts(tmp_path / "theirs", script))


@pytest.mark.parametrize("wall", ["none", "odd"])
def test_a_mesh_that_others_touch_does_not_count_forces(tmp_path, wall):
    script = scenes.write(tmp_path, with_groups(wall, "odd"))
    with pytest.raises(ScriptError, match="give the wall group all"):
        run_script(script, root=tmp_path)


def test_a_servo_has_the_velocity_that_it_has_in_liggghts(tmp_path):
    # LIGGGHTS 3.8.0 writes these lines for this script: 0 before the first step, then vel_max
    servo = scenes.HEAD.replace("grav all gravity 9.81", "grav all gravity 0.0")
    servo = servo[: servo.index("fix cm")] + (
        "fix lid all mesh/surface/stress/servo file m.stl type 1 move 0 0 0.05 com 0 0 0.05 "
        "ctrlPV force axis 0 0 -1 target_val 1 vel_max 0.1 kp 1\n"
        "fix w all wall/gran model hertz tangential history mesh n_meshes 1 meshes lid\n"
        "create_atoms 1 single 0 0 -0.05 units box\nset group all diameter 0.008 density 2500\n"
        "fix integr all nve/sphere\ndump m all mesh/vtk 20 m*.vtk vel id lid\nrun 20\n"
    )
    files = scenes.run_minidem(tmp_path, servo)
    for step, row in ((0, "0 0 0 0 0 0"), (20, "0 0 -0.1 0 0 -0.1")):
        wanted = f"FIELD FieldData 2\nmeshid 1 2 int\n0 1 \nv 3 2 double\n{row} \n"
        assert wanted in files[f"m{step}.vtk"]


STL_WORDS = """dump a all mesh/stl 1 a*.stl all
dump b all mesh/stl 1 b*.stl local cn cm cp
dump c all mesh/stl 1 c*.stl
dump d all mesh/stl 1 d*.stl region half cn cp
dump e all mesh/stl 1 e*.stl region half binary cn all
run 1
"""


def with_half(lines: str) -> str:
    return scenes.scene("region half block INF 0 INF INF INF INF units box\n" + lines)


def test_words_of_stl_dumps_are_those_of_liggghts(tmp_path):
    # LIGGGHTS 3.8.0 wrote the stored files; without periodic faces meshes have no images
    script = scenes.write(tmp_path, with_half(STL_WORDS))
    run_script(script, root=tmp_path)
    for name in "de":
        stored = (scenes.STORED / f"words_{name}1.stl").read_bytes()
        assert (tmp_path / f"{name}1.stl").read_bytes() == stored
    mine = {name: (tmp_path / f"{name}1.stl").read_text() for name in "abc"}
    assert mine["a"] == mine["c"] != mine["b"]
    assert sorted(mine["a"].splitlines()) == sorted(mine["b"].splitlines())


@pytest.mark.parametrize(
    ("line", "boundary"), [("ghost", "boundary f f m"), ("cm all", "boundary p f m")]
)
def test_images_of_meshes_are_refused(tmp_path, line, boundary):
    text = with_half(f"dump a all mesh/stl 1 a*.stl {line}\nrun 0\n")
    script = scenes.write(tmp_path, text.replace("boundary f f m", boundary))
    with pytest.raises(ScriptError, match="images of meshes beyond periodic faces"):
        run_script(script, root=tmp_path)
