"""Mistakes in words of motion are named with file, line, value and remedy."""

from __future__ import annotations

import pytest

from minidem import ScriptError, SimulationError, run_script
from tests.minidem.engine.cases import plate, stl_text
from tests.minidem.laws.law_scripts import Ball, Scene
from tests.minidem.motion.region_cases import vtk

BALL = (Ball((0.0, 0.0, 0.1)),)
TETS = "region r mesh/tet file m.vtk scale 0.01 move 0 0 0 rotate 0 0 0"

REGIONS = [
    ("region r cone z 0 0 1 -1 0 1", "radii 1 -1 make no cone"),
    ("region r cone z 0 0 0 0 0 1", "one must be above zero"),
    ("region r cone z 0 0 1 2 1 1", "bounds 1 1 leave it no length"),
    ("region r cone w 0 0 1 2 0 1", "unknown region axis 'w'"),
    ("region r cone z 0 0 1 2 EDGE 0.1", "takes the face of the box as upper bound"),
    ("region r cone y 0 0 1 2 0 INF", "takes the face of the box as upper bound"),
    ("region r prism 0 1 0 0 0 1 0 0 0", "y bounds 0.0 0.0 leave it no thickness"),
    ("region r prism 0 1 INF INF 0 1 0.1 0 0", "from INF to INF cannot be tilted"),
    ("region r prism 0 1 0 1 0 1 0 0", "expected a number after '0'"),
    ("region r plane 0 0 0 0 0 0", "the normal 0 0 0 has no direction"),
    ("region r plane 0 0 0 0 0 1e200", "has no direction"),
    ("region r wedge axis z center 0 0 radius 1 bounds 0 1 angle0 0 angle 4", "4 degrees"),
    ("region r wedge axis z center 0 0 radius 1 bounds 0 1 angle0 0 angle 361", "361 degrees"),
    ("region r wedge axis z centre 0 0", "expected 'center', found 'centre'"),
    ("region r mesh/tet m.vtk", "expected 'file', found 'm.vtk'"),
    ("region r mesh/tet file none.vtk scale 1 move 0 0 0 rotate 0 0 0", "none.vtk: cannot read"),
    ("region r mesh/tet file ../m.vtk scale 1 move 0 0 0 rotate 0 0 0", "leads out of the folder"),
    (TETS.replace("0.01", "0"), "expected a number above zero"),
    (TETS.replace("0.01", "1000"), "m.vtk: one or more points lie outside the simulation box"),
    (TETS + " units lattice", "use 'units box'"),
    (TETS.replace("m.vtk", "flat.vtk"), "flat.vtk: its tetrahedra have no volume"),
    (TETS.replace("m.vtk", "cut.vtk"), "cut.vtk: ends where a cell is expected"),
    (TETS.replace("m.vtk", "word.vtk"), "word.vtk:6: expected a number, found 'nan'"),
    (TETS.replace("m.vtk", "point.vtk"), "a tetrahedron has point 17, but there are 8"),
    (TETS.replace("m.vtk", "other.vtk"), "other.vtk: holds no tetrahedron"),
    ("region r sphere 0 0 0 1 move v_a NULL NULL", "there is no variable 'a'"),
    ("region r sphere 0 0 0 1 move 1 0 0", "expected a variable v_NAME, found '1'"),
    ("region r sphere 0 0 0 1 rotate v_a 0 0 0 0 0 0", "the axis 0 0 0 has no direction"),
    ("variable a atom x\nregion r sphere 0 0 0 1 move v_a NULL NULL", "must be of style equal"),
    ("region r sphere 0 0 0 v_none", "unknown variable 'none'"),
    ("region r sphere 0 0 0 -1", "expected a number above zero"),
    ("region r sphere 0 0 0 1 units metre", "unknown region units 'metre'"),
    ("region r delete", "unknown region ID 'r'"),
    (
        "variable a equal 0\nregion a sphere 0 0 0 1\nregion b sphere 0 0 0 2\n"
        "region r union 2 a b move v_a NULL NULL",
        "union or intersect cannot move",
    ),
]
FORCES = [
    ("pair_style gran/hertz/history 1 0", "write 'pair_style gran model hertz tangential history'"),
    (
        "fix w all wall/gran model hertz tangential history primitive type 1 ycylinder 1",
        "usage: primitive type T ycylinder RADIUS X Z",
    ),
    ("fix m all mesh/surface file meshes/m.stl type 1", "meshes/m.stl: cannot read STL file"),
    ("fix a all spring tether 1 0 0 0 -1", "the length at rest -1 is negative"),
    ("fix a all spring tehter 1 0 0 0 1", "did you mean 'tether'?"),
    ("fix a all spring couple all 1 0 0 0 1", "the two groups are the same"),
    ("fix a all spring couple none 1 0 0 0 1", "Could not find group 'none'"),
    ("fix a all spring/self 0", "expected a number above zero, found 0"),
    ("fix a all spring/self 1 yx", "unknown fix spring/self directions 'yx'"),
    ("fix a all spring/rg 1 NULL", "LIGGGHTS 3.8.0 breaks off as well"),
    ("fix a all drag 0 0 0 1", "fix ID GROUP drag X Y Z FMAG DELTA"),
    ("fix a all drag 0 0 v_a 1 1", "expected a number, found 'v_a'"),
    ("fix a all enforce2d", "use planeforce 0 0 1"),
    ("fix a all efield 1 0 0", "use addforce"),
    ("fix a all wall/reflect zlo EDGE", "in its manual only"),
    ("fix a all wall/region r harmonic 1 1 1", "unknown region of fix wall/region 'r'"),
    ("region r sphere 0 0 0 1\nfix a all wall/region r lj94 1 1 1", "did you mean 'lj93'?"),
    ("region r sphere 0 0 0 1\nfix a all wall/region r lj93 1 1 0", "expected a number above zero"),
]
COMMANDS = [
    ("delete_atoms overlap 0.01 all", "delete_atoms overlap CUT GROUP1 GROUP2"),
    ("delete_atoms overlap 0 all all", "expected a number above zero"),
    ("delete_atoms overlap 7 all all", "Delete_atoms cutoff > neighbor cutoff: 7 m is above"),
    ("delete_atoms overlap 0.01 all none", "Could not find group 'none'"),
    ("delete_atoms porosity r 0.5 12345787", "unknown region ID 'r'"),
    ("region r sphere 0 0 0 1\ndelete_atoms porosity r 0.5 12", "must be a prime number"),
    ("delete_atoms layer 3", "unknown delete_atoms style 'layer'"),
    ("set group all type/fraction 7 0.5 12", "type 7 must be from 1 to"),
    ("set group all type/fraction 1 1.5 12", "fraction 1.5 from 0 to 1"),
    ("set group all image 1 NULL NULL", "direction x is not periodic"),
    ("set group all image 1.5 NULL NULL", "expected a whole number, found '1.5'"),
    ("velocity all setAngular 1 0 0", "use 'set group ID omegax W'"),
    ("velocity all ramp vx 0 1 z 1 1", "both coordinates are 1"),
    ("velocity all ramp vw 0 1 z 0 1", "unknown velocity component 'vw'"),
    ("velocity all create 300 1234567", "unknown velocity style 'create'"),
]
MESH = "fix m all mesh/surface/planar file m.stl type 1\n"
SIEVES = [
    ("fix s all insert/pack seed 32452867 set_property a", "expected a number after 'a'"),
    ("fix s all insert/pack seed 32452867 insert_every_time x", "expected a number, found 'x'"),
    (MESH + "fix s all massflow/mesh/sieve mesh m vec_side 0 0 1", "'sieveSize' is not given"),
    (
        MESH + "fix s all massflow/mesh/sieve mesh m vec_side 0 0 1 sieveSize 1 sieveSpacing -1 "
        "sieveStiffness 1",
        "'sieveSpacing' is not given, or less than zero",
    ),
    (MESH + "fix s all massflow/mesh mesh m sum_property q", "no fix property/atom of kind scalar"),
    (MESH + "fix s all massflow/mesh/sieve mesh n vec_side 0 0 1", "'n'"),
    (MESH + "fix s all massflow/mesh/sieve mesh m count once sieveSize", "expected a number"),
    (MESH.strip().replace("type 1", "type 1 temperature hot"), "expected a number, found 'hot'"),
]
CARRIED = [
    ("fix a all move straight 1 0 0", "unknown fix move style 'straight'"),
    ("fix a all move linear 1 0", "fix ID GROUP move linear VX VY VZ"),
    ("fix a all move linear 1 0 0 unit box", "expected 'units', found 'unit'"),
    ("fix a all move wiggle 1 0 0 0", "the period must not be zero"),
    ("fix a all move rotate 0 0 0 0 0 0 1", "has no direction"),
    ("fix a all move variable v_a NULL NULL NULL NULL NULL", "there is no variable 'a'"),
    ("fix a all move variable 1 NULL NULL NULL NULL NULL", "expected a variable v_NAME, found '1'"),
    ("fix a all deform 0 x vel 1", "interval 0 is not positive"),
    ("fix a all deform 1 x speed 1", "unknown fix deform style 'speed'"),
    ("fix a all deform 1 xy vel 1", "a box that is tilted is not supported"),
    ("fix a all deform 1 x vel 1 remap v", "use 'remap x'"),
    ("fix a all deform 1 x wiggle 1 0", "the period 0 is not above zero"),
    ("fix a all deform 1 x volume", "another direction must change by itself"),
    ("group g foo 1", "unknown group style 'foo' (known: region, type, id, variable, union,"),
    ("fix w all wall/gran/hooke/history 1 0 0", "wall/gran model hooke tangential history prim"),
    ("fix w all wall/gran hooke/history 4000 NULL", "'model' first, e.g. 'model hertz tangential"),
    ("fix w all wall/gran hooke/history 4000 NULL", "found 'hooke/history'; coefficients stand in"),
    ("pair_style granular", "LIGGGHTS 3.8.0 does not have; write 'pair_style gran model hertz"),
    ("comm_modify vel yes", "LIGGGHTS 3.8.0 does not have; write 'communicate single vel yes'"),
    ("fix a all pour 9 1 7 region r", "fix 'pour' is one of LAMMPS that LIGGGHTS 3.8.0 does not"),
    ("communicate mode single vel yes", "does not have; write 'communicate single vel yes'"),
    ("group g dynamic all var v every 9", "does not have; make it anew between runs"),
    ("fix a all mcg", "unknown fix 'mcg'; LIGGGHTS 3.8.0 has none of that name either"),
    ("pair_style gran model jkr", "what attracts in both is cohesion sjkr or sjkr2"),
    (
        "fix t all particletemplate/sphere 15485863 radius gaussian number 1 0.1",
        "write a template for each of some values and mix them with fix particledistribution/disc",
    ),
    ("fix w all wall/gran model hertz store_force yes", "f_b[1]-f_a[1]"),
    ("fix n all nve/sphere\ndump d all custom 1 d id f_n\nrun 1", "fix n (nve/sphere) has no val"),
    ("dump d all custom 1 d id c_foo", "there is no compute 'foo'"),
    ("pair_coeff 1 9", "Numeric index is out of bounds: '9' of pair_coeff; atom types are 1 to"),
    ("change_box all", "change_box GROUP x final LO HI"),
    ("change_box none x scale 2", "Could not find group 'none'"),
    ("change_box all x final 1 0", "x from 1 to 0 m is no length"),
    ("change_box all x scale 0", "expected a number above zero"),
    ("change_box all x volume", "it must follow one change of another direction"),
    ("change_box all x scale 2 x volume", "it must follow one change of another direction"),
    ("change_box all triclinic", "a box that is tilted is not supported"),
    ("change_box all boundary p f", "usage: boundary f f f"),
    ("change_box all units box", "no operation is given"),
    ("replicate 2 2 2 offset 1 1 1", "replicate NX NY NZ offset OX OY OZ shift SX SY SZ"),
    ("replicate 0 2 2 offset 1 1 1 shift 0 0 0", "interval 0 is not positive"),
    ("replicate 2 2 2 offset 1 1 1 move 0 0 0", "expected 'shift', found 'move'"),
    ("run_time soon", "run_time: expected a number, found 'soon'"),
    ("run_time 1e308", "expected 0 to 2147483647"),
    ("replicate 99999 99999 99999 offset 1 1 1 shift 0 0 0", "replicate"),
    ("run_time -1", "expected 0 to 2147483647"),
    ("run_time 1 after", "expected 'upto', found 'after'"),
]
AT_RUN = [
    ("fix a all move linear 1 0 0\nfix b all move linear 1 0 0", "would move twice a step"),
    ("fix a all deform 1 x final 1 0", "Final box dimension due to fix deform is < 0.0: x from 1"),
    ("fix a all deform 1 x vel 1\nfix b all deform 1 y vel 1", "More than one fix deform"),
    (TETS + "\nfix a all wall/region r lj93 1 1 1", "knows no surface of a mesh/tet"),
    (
        "variable a equal 0\nregion a sphere 0 0 0 1 move v_a NULL NULL\n"
        "region b sphere 0 0 0 1\nregion r union 2 a b\nfix a all wall/region r lj93 1 1 1",
        "with parts that move is not supported",
    ),
    ("group none id 77\nfix a none spring tether 1 0 0 0 1", "has no centre of mass"),
    ("region r sphere 0 0 0.1 1\nfix a all wall/region r lj93 1 1 1\nregion r delete", "'r'"),
]
FILES = {
    "m.stl": stl_text(plate()),
    "m.vtk": vtk(),
    "flat.vtk": "# vtk\nflat\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0\n"
    "0 1 0 1 1 0\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n",
    "cut.vtk": vtk()[: vtk().index("4 1 3")],
    "word.vtk": vtk().replace("0.0 0.0 0.0", "nan 0.0 0.0", 1),
    "point.vtk": vtk().replace("4 0 1 2 4", "4 0 1 2 17"),
    "other.vtk": vtk().replace("10\n", "12\n"),
}


@pytest.mark.parametrize(("line", "message"), [*REGIONS, *FORCES, *CARRIED, *COMMANDS, *SIEVES])
def test_mistake_is_named(tmp_path, line, message):
    text = Scene(BALL, floor=False).text(1, 1)
    at = text.index("fix integr")
    for name, content in FILES.items():
        (tmp_path / name).write_text(content)
    (tmp_path / "in.script").write_text(text[:at] + line + "\n" + text[at:])
    with pytest.raises(ScriptError) as caught:
        run_script(tmp_path / "in.script", root=tmp_path)
    assert message in str(caught.value)
    assert caught.value.line == 1 + text[:at].count("\n") + line.count("\n")


@pytest.mark.parametrize(("line", "message"), AT_RUN)
def test_what_cannot_run_is_named(tmp_path, line, message):
    text = Scene(BALL, floor=False).text(1, 1)
    at = text.index("fix integr")
    (tmp_path / "m.vtk").write_text(vtk())
    (tmp_path / "in.script").write_text(text[:at] + line + "\n" + text[at:])
    with pytest.raises(ScriptError) as caught:
        run_script(tmp_path / "in.script", root=tmp_path)
    assert message in str(caught.value)


def test_a_particle_behind_a_region_that_is_a_wall_is_named(tmp_path):
    text = Scene(BALL, floor=False).text(1, 1)
    at = text.index("fix integr")
    line = "region r sphere 0 0 0.1 0.01 side out\nfix a all wall/region r harmonic 1 1 1\n"
    (tmp_path / "in.script").write_text(text[:at] + line + text[at:])
    with pytest.raises(SimulationError, match="particle 1: is on or behind the surface of region"):
        run_script(tmp_path / "in.script", root=tmp_path)


def test_temperature_of_a_mesh_is_told_to_have_no_effect(tmp_path):
    text = Scene(BALL, floor=False).text(1, 1)
    at = text.index("fix integr")
    (tmp_path / "m.stl").write_text(stl_text(plate()))
    line = MESH.replace("type 1", "type 1 temperature 300.")
    (tmp_path / "in.script").write_text(text[:at] + line + text[at:])
    run_script(tmp_path / "in.script", root=tmp_path)
    log = (tmp_path / "log.liggghts").read_text()
    assert "WARNING: mesh m: 'temperature' has no effect, as heat is not computed" in log


@pytest.mark.parametrize(("weights", "told"), [((30, 70), True), ((0.3, 0.7), False)])
def test_weights_that_are_no_shares_are_told(tmp_path, weights, told):
    text = Scene(BALL, floor=False).text(1, 1)
    at = text.index("fix integr")
    line = (
        "fix a all particletemplate/sphere 15485863 atom_type 1 density constant 2500 "
        "radius constant 0.01\nfix b all particletemplate/sphere 15485867 atom_type 1 "
        "density constant 2500 radius constant 0.02\n"
        f"fix d all particledistribution/discrete 32452843 2 a {weights[0]} b {weights[1]}\n"
    )
    (tmp_path / "in.script").write_text(text[:at] + line + text[at:])
    run_script(tmp_path / "in.script", root=tmp_path)
    log = (tmp_path / "log.liggghts").read_text()
    assert ("WARNING: fix d: the weights sum up to 100, not 1" in log) == told
