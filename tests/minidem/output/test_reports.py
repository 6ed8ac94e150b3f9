"""Log, thermo table, echo and fix print, held against LIGGGHTS' own log."""

from __future__ import annotations

import io
import shutil
import subprocess

import pytest

from minidem import run_script
from minidem.errors import ScriptError

HEAD = """atom_style sphere
atom_modify map array sort 0 0
boundary f f f
newton off
communicate single vel yes
units si
region reg block -0.05 0.05 -0.05 0.05 -0.01 0.1 units box
create_box 1 reg
neighbor 0.002 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype 5e6
fix m2 all property/global poissonsRatio peratomtype .3
fix m3 all property/global coefficientRestitution peratomtypepair 1 .6
fix m4 all property/global coefficientFriction peratomtypepair 1 .5
pair_style gran model hertz tangential history
pair_coeff * *
timestep 1e-5
fix p all particletemplate/sphere 15485863 atom_type 1 density constant 2500 radius constant 0.002
fix d all particledistribution/discrete 15485867 1 p 1.0
region bc block -.03 .03 -.03 .03 .01 .06
fix ins all insert/rate/region seed 32452843 distributiontemplate d nparticles 60 &
  particlerate 40000 insert_every 50 vel constant 0 0 -1 region bc
fix integr all nve/sphere
compute er all erotate/sphere
"""
BODY = """variable s equal step
variable n equal count(all)
fix pr all print 50 "at $s: ${n} particles $(v_n*2) box $(zlo)" file p.txt screen yes
fix pr2 all print 100 "ab $s" append p2.txt screen no
fix pr3 all print 100 "ab $s" file p3.txt title none screen no
fix pr4 all print 100 "ab $s" file p4.txt title "# a b" screen no
thermo_modify lost ignore
thermo_style custom step atoms ke dt xlo c_er vol v_n
thermo_modify lost ignore norm no format float %.10g format 2 %5d
thermo 50
echo none
run 100
echo log
log second.log
if "${n} > 10" then "print 'many: ${n}'" else "print few"
run 130
unfix pr
print "done $s"
"""
# What differs for good reason: program, processors, times, memory, statistics of the lists.
DIFFERENT = (
    *("LIGGGHTS (V", "  1 by 1", "Setting up run at", "Memory usage", "Loop time"),
    *("Pair  time", "Neigh time", "Comm  time", "Outpt time", "Other time", "Nlocal", "Histogram"),
    *("Nghost", "Neighs", "Total #", "Ave neighs", "Neighbor list", "Dangerous"),
)


def lines_of(text: str) -> list[str]:
    """Return the lines of a log that must agree, without places in the source of LIGGGHTS."""
    lines = [line.split(" (./src/")[0] for line in text.splitlines()]
    return [line for line in lines if line.strip() and not line.startswith(DIFFERENT)]


@pytest.mark.liggghts
def test_log_and_printed_files_are_those_of_liggghts(tmp_path):
    for name in ("minidem", "liggghts"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "in.s").write_text(HEAD + BODY)
    run_script(tmp_path / "minidem" / "in.s", root=tmp_path / "minidem")
    program = shutil.which("liggghts")
    assert program
    folder = tmp_path / "liggghts"
    subprocess.run([program, "-in", "in.s"], cwd=folder, check=True, capture_output=True)
    for name in ("log.liggghts", "second.log"):
        mine = (tmp_path / "minidem" / name).read_text()
        assert lines_of(mine) == lines_of((folder / name).read_text())
    for name in ("p.txt", "p2.txt", "p3.txt", "p4.txt"):
        assert (tmp_path / "minidem" / name).read_text() == (folder / name).read_text()


def test_screen_shows_thermo_and_prints_without_commands(tmp_path):
    (tmp_path / "in.s").write_text(HEAD + "thermo 50\nrun 50\nprint hello\n")
    screen = io.StringIO()
    run_script(tmp_path / "in.s", root=tmp_path, screen=screen, log=None)
    lines = screen.getvalue().splitlines()
    assert any(line.startswith("    Step    Atoms") for line in lines)
    assert lines[-1] == "hello"
    assert not any(line.startswith("fix ") for line in lines)
    assert [path.name for path in tmp_path.iterdir()] == ["in.s"]


@pytest.mark.parametrize("where", ["none", "screen", "log", "both"])
def test_commands_are_shown_where_they_are_asked_for(tmp_path, where):
    (tmp_path / "in.s").write_text("units si\nprint hello\n")
    screen = io.StringIO()
    run_script(tmp_path / "in.s", root=tmp_path, screen=screen, echo=where)
    shown = {"screen": screen.getvalue(), "log": (tmp_path / "log.liggghts").read_text()}
    for name, text in shown.items():
        lines = text.splitlines()
        assert "hello" in lines
        assert ("units si" in lines) == (where in (name, "both")), name


BOXES = """write_data a.data
replicate 1 2 1 offset 0 0.1 0 shift 0 0 0
clear
atom_style sphere
boundary f f f
newton off
communicate single vel yes
read_data a.data
"""
STL = """solid m
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 0.01 0
endloop
endfacet
endsolid m
"""


def test_log_has_the_boxes_and_names_a_mesh_that_reaches_out_of_one(tmp_path):
    box = "orthogonal box = (-0.05 -0.05 -0.01) to (0.05 0.05 0.1)"
    twice = "orthogonal box = (-0.05 -0.05 -0.01) to (0.05 0.15 0.1)"
    mesh = "fix m all mesh/surface file m.stl type 1 scale 0.07\n"
    materials, _, _ = HEAD.partition("fix p ")
    (tmp_path / "m.stl").write_text(STL)
    (tmp_path / "in.s").write_text(materials + mesh + "run 0\nunfix m\n" + BOXES)
    run_script(tmp_path / "in.s", root=tmp_path)
    lines = (tmp_path / "log.liggghts").read_text().splitlines()
    told = [line for line in lines if "orthogonal box" in line]
    assert told == [
        f"Created {box}", f"  old: {box}", f"  new: {twice}", f"  fin: {twice}", f"  {box}"
    ]  # fmt: skip
    assert "WARNING: Not all nodes of mesh 'm' are inside the simulation box" in lines


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("echo loud", "known: none, screen, log, both"),
        ("log ../a.log", "leads out of the folder"),
        ("log a.log apend", "unknown log keyword 'apend'"),
        ("fix a all print 0 x", "interval 0 is not positive"),
        ("fix a all print 5 x file /tmp/y", "is an absolute path"),
        ("fix a all print 5 x fil y", "unknown fix print keyword 'fil'"),
        ("fix a all print 1 ${nix}\n", "unknown variable 'nix'"),
        ("fix a all print 1 '${nix}'\nrun 1", "unknown variable 'nix'"),
        ("thermo_modify format float %s", "one conversion"),
        ("thermo_modify format 9 %g", "needs int, float or 1 to 4"),
    ],
)
def test_mistake_names_file_and_line(tmp_path, line, message):
    script = tmp_path / "in.s"
    script.write_text(HEAD + line + "\n")
    with pytest.raises(ScriptError) as error:
        run_script(script, root=tmp_path)
    assert message in str(error.value)
