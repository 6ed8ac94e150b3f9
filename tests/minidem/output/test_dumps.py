"""Dump commands in a running script, held against the files LIGGGHTS writes for it."""

from __future__ import annotations

import gzip
import shutil
import struct
import subprocess
from pathlib import Path

import pytest

from minidem import run_script
from minidem.errors import ScriptError

STL = """solid m
facet normal 0 0 1
outer loop
vertex -0.01 -0.01 0.05
vertex 0.01 -0.01 0.05
vertex 0.01 0.01 0.05
endloop
endfacet
endsolid m
"""
HEAD = """atom_style sphere
atom_modify map array sort 0 0
boundary f f m
newton off
communicate single vel yes
units si
region reg block -0.2 0.2 -0.2 0.2 -0.1 0.2 units box
create_box 2 reg
neighbor 0.002 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype 5e6 1e7
fix m2 all property/global poissonsRatio peratomtype 0.3 0.25
fix m3 all property/global coefficientRestitution peratomtypepair 2 .6 .6 .6 .6
fix m4 all property/global coefficientFriction peratomtypepair 2 .5 .5 .5 .5
pair_style gran model hertz tangential history
pair_coeff * *
timestep 1e-5
fix grav all gravity 9.81 vector 0 0 -1
fix w all wall/gran model hertz tangential history primitive type 2 zplane 0.0
fix cm all mesh/surface file m.stl type 1 rotate axis 1 2 0.5 angle 33 move 0.01 -0.003 0.02
fix p1 all particletemplate/sphere 15485863 atom_type 1 density constant 2500 radius constant 0.004
fix p2 all particletemplate/sphere 49979687 atom_type 2 density constant 1500 radius constant 0.003
fix d all particledistribution/discrete 15485867 2 p1 0.4 p2 0.6
region bc block -.05 .05 -.05 .05 .001 .06 units box
fix ins all insert/pack seed 32452843 distributiontemplate d maxattempt 200 insert_every once &
 overlapcheck yes all_in yes vel uniform 0 0 -0.3 .2 .2 .2 region bc particles_in_region 60
fix integr all nve/sphere
compute pk all ke/atom
variable q atom vx*2+type
thermo_style custom step atoms ke
thermo 100
thermo_modify lost ignore norm no
"""
DUMPS = """dump a all custom 100 plain.dump id type x y z ix iy iz vx fz omegay radius &
 mass density c_pk
dump b all custom 100 post/b*.dump id type x tqz v_q diameter
dump_modify b sort -3 pad 5 format "%5d %d %.17g %8.3e %g %.4f" first yes
dump c all custom/vtk 100 post/c_*.vtk id type type x y z ix iy iz vx vy vz fx fy fz &
 omegax omegay omegaz radius mass v_q
dump e all custom/vtk 100 last.vtk x y z vy radius id
dump_modify e region bc thresh radius > 0.0035 sort id
dump f all custom/vtk 300 no_points_*.vtk id vx vy vz c_pk
dump s all mesh/stl 100 post/m*.stl cm
dump s2 all mesh/stl 200 all*.stl
dump x all xyz 300 post/x*.dump
dump_modify x element Fe Ni sort -5 format "%6s %.9g %g %g"
dump n all xyz 300 post/n.dump
dump l all custom 300 post/l.dump id element xsu ysu zsu
dump_modify l element Fe Ni label grains sort -4 format "%d %-3s %.9g %g %g"
dump z all custom 150 post/z.bin id type x y z element radius
dump z2 all custom 150 post/z*.bin id x y z
dump_modify z2 sort -2
dump p all decomposition/vtk 300 post/p*.vtk
dump pp all custom/vtk 150 post/pp*.pvtp id type vx vy vz radius
dump pu all custom/vtk 300 pu*.pvtu id vx v_q
dump v all atom/vtk 300 post/v*.vtk
dump_modify v sort -3 append yes
run 1
run 299
"""


FILES = (".dump", ".vtk", ".stl", ".bin", ".pvtp", ".pvtu", ".vtp", ".vtu")


def files_of(folder: Path) -> dict[str, bytes]:
    """Return the dumped files by name."""
    found = [path for path in folder.rglob("*") if path.suffix in FILES]
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in sorted(found)}


@pytest.mark.liggghts
def test_all_files_are_those_of_liggghts(tmp_path):
    for name in ("minidem", "liggghts"):
        folder = tmp_path / name
        folder.mkdir()
        (folder / "m.stl").write_text(STL)
        (folder / "in.s").write_text(HEAD + DUMPS)
    run_script(tmp_path / "minidem" / "in.s", root=tmp_path / "minidem")
    program = shutil.which("liggghts")
    assert program
    folder = tmp_path / "liggghts"
    subprocess.run([program, "-in", "in.s"], cwd=folder, check=True, capture_output=True)
    mine, theirs = files_of(tmp_path / "minidem"), files_of(folder)
    assert list(mine) == list(theirs)
    assert len(mine) > 15
    different = [name for name in mine if mine[name] != theirs[name]]
    assert different == []


LATER = """run 3
dump a all custom 1000 a.txt id
dump b all xyz 1000 b.txt
dump c all custom 1000 c*.txt id
dump d all custom 1000 d.txt id
dump_modify d append yes
run 3
"""


def test_one_file_is_made_or_emptied_where_no_snapshot_is_due(tmp_path):
    """As LIGGGHTS does when a run begins (seen in version 3.8.0)."""
    (tmp_path / "m.stl").write_text(STL)
    for name in "abd":
        (tmp_path / f"{name}.txt").write_text("of yesterday\n")
    (tmp_path / "in.s").write_text(HEAD + LATER)
    run_script(tmp_path / "in.s", root=tmp_path)
    found = {path.name: path.read_text() for path in tmp_path.glob("*.txt")}
    assert found == {"a.txt": "", "b.txt": "", "d.txt": "of yesterday\n"}


THREE = """create_atoms 2 single 0.049 0 0
create_atoms 1 single 0.0005 0 0.0299
create_atoms 1 single -0.03 0 0.0199
set group all diameter 0.01 density 2500
dump x all xyz 1 x.txt
dump y all xyz 1 y.txt
dump_modify y element Fe Ni sort 5
dump l all custom 1 l.txt id element xsu
dump_modify l label grains sort -3
run 0
"""


def test_types_have_names_and_rows_the_order_that_is_asked_for(tmp_path):
    """Text of LIGGGHTS 3.8.0 for the same commands."""
    script = tmp_path / "in.s"
    materials, _, _ = HEAD.partition("fix p1 ")
    script.write_text(materials + THREE)
    (tmp_path / "m.stl").write_text(STL)
    run_script(script, root=tmp_path)
    head = "3\nAtoms. Timestep: 0\n"
    assert (tmp_path / "x.txt").read_text() == (
        head + "2 0.049 0 0\n1 0.0005 0 0.0299\n1 -0.03 0 0.0199\n"
    )
    assert (tmp_path / "y.txt").read_text() == (
        head + "Ni 0.049 0 0\nFe -0.03 0 0.0199\nFe 0.0005 0 0.0299\n"
    )
    text = (tmp_path / "l.txt").read_text()
    assert text.startswith("ITEM: TIMESTEP\n0\nITEM: LABEL\ngrains\nITEM: NUMBER OF ATOMS\n3\n")
    assert text.endswith("id element xsu \n1 C 0.6225 \n2 C 0.50125 \n3 C 0.425 \n")


BINARY = """create_atoms 2 single 0.049 0 0
create_atoms 1 single -0.03 0 0.0199
set group all diameter 0.01 density 2500
dump a all custom 1 a.bin id element x iz
dump b all custom 1 b.bin id
dump_modify b region bc
dump c all custom 1 c.gz id x
dump d all xyz 1 d*.xyz.gz
dump e all decomposition/vtk 1 e*.vtk
dump f all custom/vtk 1 f.*.pvtu id vx vy vz
dump g all custom/vtk 1 g*.pvtp id
dump_modify g region bc
region bc block 1 2 1 2 1 2 units box
run 1
"""


def test_further_kinds_of_files(tmp_path):
    """Numbers as LIGGGHTS 3.8.0 lays them out, names as their types; by gzip; VTK in parts."""
    materials, _, _ = HEAD.partition("fix p1 ")
    (tmp_path / "m.stl").write_text(STL)
    (tmp_path / "in.s").write_text(materials + BINARY)
    run_script(tmp_path / "in.s", root=tmp_path)
    box = struct.pack("<6d", -0.2, 0.2, -0.2, 0.2, -0.1, 0.2)
    faces = struct.pack("<7i", 0, 1, 1, 1, 1, 3, 3)
    rows = struct.pack("<3i8d", 4, 1, 8, 1.0, 2.0, 0.049, 0.0, 2.0, 1.0, -0.03, 0.0)
    first = struct.pack("<2q", 0, 2) + faces + box + rows
    content = (tmp_path / "a.bin").read_bytes()
    assert content[: len(content) // 2] == first
    none = (tmp_path / "b.bin").read_bytes()
    assert none[: len(none) // 2] == struct.pack("<2q", 0, 0) + faces + box + struct.pack(
        "<3i", 1, 1, 0
    )
    text = gzip.decompress((tmp_path / "c.gz").read_bytes()).decode()
    assert text.startswith("ITEM: TIMESTEP\n0\n")
    assert "ITEM: TIMESTEP\n1\n" in text
    assert text.endswith("ITEM: ATOMS id x \n1 0.049 \n2 -0.03 \n")
    assert gzip.decompress((tmp_path / "d1.xyz.gz").read_bytes()).endswith(b"\n1 -0.03 0 0.0199\n")
    assert (
        (tmp_path / "e0.vtk").read_text().endswith("Z_COORDINATES 2 float\n-0.100000 0.200000 \n")
    )
    parts = (tmp_path / "f.1.pvtu").read_text()
    assert '<PDataArray type="Float64" Name="v" NumberOfComponents="3"/>' in parts
    assert '<Piece Source="f.1_0.vtu"/>' in parts
    assert '<Piece NumberOfPoints="2"' in (tmp_path / "f.1_0.vtu").read_text()
    assert "<Piece" not in (tmp_path / "g0.pvtp").read_text()  # nothing is in it
    assert not (tmp_path / "g0_0.vtp").exists()


HOLE = """create_atoms 1 single 0 0 0.03
create_atoms 1 single 0 0 0.05
create_atoms 1 single 0 0 0.07
create_atoms 1 single 0 0 0.09
set group all diameter 0.01 density 2500
group gone id 1
delete_atoms group gone compress no
dump a all custom 1 a.txt id
dump b all xyz 1 b.txt
dump c all xyz 1 c.txt
dump_modify c sort off
dump d all atom/vtk 1 d*.vtk
dump e all atom/vtk 1 e*.vtk
dump_modify e sort off
run 0
"""


def test_xyz_and_atom_vtk_stand_in_the_order_of_ids_unless_told_otherwise(tmp_path):
    """The last particle has filled the hole of the first; `custom` shows that, as in LIGGGHTS."""
    materials, _, _ = HEAD.partition("fix p1 ")
    (tmp_path / "m.stl").write_text(STL)
    (tmp_path / "in.s").write_text(materials + HOLE)
    run_script(tmp_path / "in.s", root=tmp_path)
    shown = {name: (tmp_path / f"{name}.txt").read_text().splitlines() for name in "abc"}
    assert shown["a"][-3:] == ["4 ", "2 ", "3 "]
    assert shown["b"][-3:] == ["1 0 0 0.05", "1 0 0 0.07", "1 0 0 0.09"]
    assert shown["c"][-3:] == ["1 0 0 0.09", "1 0 0 0.05", "1 0 0 0.07"]
    ids = {name: (tmp_path / f"{name}0.vtk").read_text() for name in "de"}
    assert "2 3 4" in ids["d"]
    assert "4 2 3" in ids["e"]


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("dump a all custon 1 f id", "did you mean 'custom'?"),
        ("dump a all custom 0 f id", "interval 0 is not positive"),
        ("dump a all custom 1 f idd", "did you mean 'id'?"),
        ("dump a all custom/vtk 1 f.vti id", "must end in .vtk or .vtp or .vtu"),
        ("dump a all custom/vtk 1 f.%.vtk id", "'%' may not stand in the file name 'f.%.vtk'"),
        ("dump a all xyz 1 f.bin", "'.bin' may not stand in the file name 'f.bin' of a dump xyz"),
        ("dump a all mesh/stl 1 f.stl cn", "known: cm"),
        ("dump a all custom 1 f id\ndump_modify a formt x", "did you mean 'format'?"),
        ('dump a all custom 1 f id\ndump_modify a format "%s"', "one conversion"),
        ("dump a all custom 1 f id x\ndump_modify a format %d", "1 formats for 2 columns"),
        ("dump a all custom 1 f id\ndump_modify a sort 3", "there are 1 columns"),
        ("dump a all xyz 1 f\ndump_modify a sort 6", "there are 5 columns"),
        ("dump a all xyz 1 f\ndump_modify a element Fe", "dump_modify ID element E1 E2"),
        ("dump a all custom/vtk 1 f.vtk id element", "unknown dump column 'element'"),
        ("dump a all custom 1 f id\ndump_modify a thresh x ~ 3", "expected COLUMN < VALUE"),
        ("dump a all custom 1 f id\ndump_modify a every x", "expected a whole number"),
        ("dump a all custom 1 ../f id\nrun 0", "leads out of the folder"),
    ],
)
def test_mistake_in_a_dump_names_file_and_line(tmp_path, line, message):
    (tmp_path / "m.stl").write_text(STL)
    script = tmp_path / "in.s"
    script.write_text(HEAD + line + "\n")
    with pytest.raises(ScriptError) as error:
        run_script(script, root=tmp_path)
    assert message in str(error.value)
    assert not (tmp_path.parent / "f").exists()
