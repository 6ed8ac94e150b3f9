"""Tracers, residence times and computes of where particles lie, against those of LIGGGHTS."""

from __future__ import annotations

import re

import numpy as np
import pytest

from minidem import run_script
from minidem.errors import ScriptError
from tests.minidem.output import scenes

HEAD = """atom_style sphere
atom_modify map array sort 0 0
boundary p f f
newton off
communicate single vel yes
units si
region reg block -0.02 0.02 -0.02 0.02 -0.01 0.05 units box
create_box 3 reg
neighbor 0.002 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype 5e6 1e7 5e6
fix m2 all property/global poissonsRatio peratomtype 0.3 0.25 0.3
fix m3 all property/global coefficientRestitution peratomtypepair 3 .6 .6 .6 .6 .6 .6 .6 .6 .6
fix m4 all property/global coefficientFriction peratomtypepair 3 .5 .5 .5 .5 .5 .5 .5 .5 .5
pair_style gran model hertz tangential history
pair_coeff * *
timestep 2e-5
fix grav all gravity 9.81 vector 0 0 -1
fix p1 all particletemplate/sphere 15485863 atom_type 1 density constant 2500 radius &
  constant 0.002
fix p2 all particletemplate/sphere 15485867 atom_type 2 density constant 2500 radius &
  constant 0.0015
fix p3 all particletemplate/sphere 32452843 atom_type 3 density constant 2500 radius &
  constant 0.001
fix d all particledistribution/discrete 32452867 3 p1 0.4 p2 0.3 p3 0.3
region bc block -0.02 0.02 -0.02 0.02 0 0.03 units box
fix ins all insert/pack seed 49979687 distributiontemplate d insert_every once overlapcheck &
  yes all_in yes vel constant 2 0 -1 particles_in_region 160 region bc
fix w all wall/gran model hertz tangential history primitive type 1 zplane 0
fix w2 all wall/gran model hertz tangential history primitive type 1 yplane -0.02
fix w3 all wall/gran model hertz tangential history primitive type 1 yplane 0.02
fix integr all nve/sphere
region low block -1 1 -1 1 -1 0.01 units box
region left block -0.01 0.0 -1 1 -1 1 units box
thermo_modify lost ignore norm no
run 1
group one type 1
"""
LINES = """fix tr all property/atom/tracer region_mark left mark_step 20 marker_style heaviside &
  check_mark_every 5
fix tr2 one property/atom/tracer region_mark low mark_step 40
fix rt all property/atom/regiontracer/time add_region left add_region low check_region_every 5
fix rt0 one property/atom/regiontracer/time
compute nt all nparticles/tracer/region tracer tr region_count low
compute nt2 one nparticles/tracer/region tracer tr2 region_count left reset_marker no
compute nt3 all nparticles/tracer/region tracer tr2 region_count reg reset_marker no &
  periodic x 1
compute r all rdf 8
compute r2 one rdf 5 1 1 1 2* * *
compute cl all cluster/atom 0.0038
compute cl1 one cluster/atom 0.004
compute ms all msd
compute ms1 one msd com yes
compute cg all contact/atom/gran
compute cg1 one contact/atom/gran skin 0.001
compute ce all centro/atom 2
compute ce1 one centro/atom 4
compute sl all slice 1 3 1 c_ms
compute sl2 all slice 2 8 2 c_r[2]
fix rd all ave/time 50 2 100 c_r[2] c_r file rdf.txt mode vector off 3
dump a all custom 100 a*.dump id c_cl c_cl1 c_cg c_cg1 f_tr f_tr2 f_rt[1] f_rt[2] f_rt[3] c_ce &
  c_ce1
dump_modify a sort id
thermo_style custom step atoms f_tr f_tr2 c_nt[1] c_nt[2] c_nt[3] c_nt[4] c_nt2[2] c_nt2[4] &
  c_nt3[1] c_nt3[2] c_r[1][1] c_r[1][2] c_r[7][2] c_r[8][2] c_r[8][3] c_r2[5][2] c_r2[5][3] &
  c_r2[4][4] c_r2[5][5] c_r2[5][7] c_ms[1] c_ms[3] c_ms[4] c_ms1[1] c_ms1[4] c_sl[1] c_sl[2] &
  c_sl2[1] c_sl2[3] f_rt[1] f_rt[2] f_rt[3]
thermo 10
thermo_modify lost ignore norm no format float %.9g
run 300
run 200
"""


def table(log: str) -> np.ndarray:
    """Return the rows of the thermo table."""
    rows = [line.split() for line in log.splitlines() if re.match(r" +\d+ +160 ", line)]
    return np.array([row for row in rows if len(row) > 10], np.float64)


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Return the files that minidem writes, and its log."""
    folder = tmp_path_factory.mktemp("mine")
    found = scenes.run_minidem(folder, HEAD + LINES)
    return found | {"log": (folder / "log.liggghts").read_text()}


def test_values_are_those_of_liggghts(files):
    theirs = np.loadtxt(scenes.STORED / "arrangement.txt")
    mine = table(files["log"])
    np.testing.assert_allclose(mine[[0, 3, 20, 30, -1]], theirs, rtol=1e-7, atol=1e-12)
    assert files["a300.dump"] == (scenes.STORED / "arrangement_a300.dump").read_text()
    assert files["rdf.txt"] == (scenes.STORED / "arrangement_rdf.txt").read_text()


@pytest.mark.liggghts
def test_all_values_are_those_of_liggghts(files, tmp_path):
    theirs = scenes.run_liggghts(tmp_path, HEAD + LINES)
    log = (tmp_path / "log.liggghts").read_text(errors="replace")
    np.testing.assert_allclose(table(files["log"]), table(log), rtol=1e-7, atol=1e-12)
    for name in theirs:
        assert files[name] == theirs[name], name


def test_marks_are_in_restart_files(tmp_path):
    lines = "fix tr all property/atom/tracer region_mark low mark_step 3\nrun 20\n"
    show = "dump a all custom 20 a*.dump id f_tr\ndump_modify a sort id\nrun 20\n"
    whole = scenes.run_minidem(tmp_path, HEAD + lines + "write_restart s.restart\n" + show)
    setup = HEAD.replace("create_box 3 reg\n", "read_restart s.restart\n")
    setup = setup[: setup.index("thermo_modify")].replace("region reg block", "region rego block")
    again = lines.replace("run 20\n", "") + show
    (tmp_path / "in.t").write_text(setup + again)
    run_script(tmp_path / "in.t", root=tmp_path)
    marks = (tmp_path / "a40.dump").read_text()
    assert marks == whole["a40.dump"]
    assert marks.count(" 1 \n") > 10


def test_several_inputs_of_a_slice_are_columns(tmp_path):
    lines = "compute ms all msd\ncompute te all temp\ncompute sl all slice 1 4 1 c_ms c_te\n"
    lines += "thermo_style custom step atoms c_sl[3][2] c_te[3] c_sl[3][1] c_ms[3] step step step "
    scenes.run_minidem(tmp_path, HEAD + lines + "step step\nrun 5\n")
    rows = table((tmp_path / "log.liggghts").read_text())
    assert rows[-1, 2] == rows[-1, 3] > 0.0
    assert rows[-1, 4] == rows[-1, 5] > 0.0


CONTACTS = "compute lo all pair/gran/local pos force delta\nthermo_modify lost"
HISTOGRAMS = """compute ka all ke/atom
compute k all ke
compute co all contact/atom
compute te all temp
variable q atom vx*vx
variable e equal c_k*1e4
fix h1 all ave/histo 2 5 20 0 0.03 6 x z file h1.txt mode vector
fix h2 one ave/histo 10 1 10 -2 2 8 vx v_q file h2.txt mode vector beyond end ave running
fix h3 all ave/histo 5 2 20 0 1e-4 5 c_ka c_co file h3.txt mode vector beyond extra ave window 3
fix h4 all ave/histo 2 5 20 80 90 4 v_e file h4.txt ave running overwrite start 40
fix h5 all ave/histo 10 1 50 0 1e-5 4 c_lo[10] file h5.txt mode vector title1 "# a" title2 &
  "# b" title3 "# c"
fix h6 all ave/histo 10 1 50 0 1e-2 4 c_te[1] c_k file h6.txt
fix h7 all ave/histo 10 1 50 -1e-2 1e-2 4 c_te file h7.txt mode vector
fix at all ave/time 10 1 50 c_k file at.txt
variable s1 equal f_h1[1]
variable s2 equal f_h2[2][2]
thermo_style custom step atoms f_h1[1] f_h1[2] f_h1[3] f_h1[4] f_h1[2][1] f_h1[2][2] &
  f_h1[2][3] f_h3[1][1] f_h3[7][2] f_h4[1]
thermo 100
thermo_modify lost ignore norm yes format float %.9g
run 99
run 200
"""


def test_histograms_are_those_of_liggghts(tmp_path):
    head = HEAD.replace("thermo_modify lost", CONTACTS)
    found = scenes.run_minidem(tmp_path, head + HISTOGRAMS)
    for name in ("h2.txt", "h3.txt"):
        stored = (scenes.STORED / f"histogram_{name}").read_text()
        assert scenes.alike(found[name], stored, rtol=2e-5), name  # six digits are in the files


@pytest.mark.liggghts
def test_all_histograms_are_those_of_liggghts(tmp_path):
    script = HEAD.replace("thermo_modify lost", CONTACTS) + HISTOGRAMS
    mine = scenes.run_minidem(tmp_path / "mine", script)
    theirs = scenes.run_liggghts(tmp_path / "theirs", script)
    assert len(theirs) == 8
    assert mine == theirs
    logs = [
        (tmp_path / name / "log.liggghts").read_text(errors="replace")
        for name in ("mine", "theirs")
    ]
    np.testing.assert_allclose(table(logs[0]), table(logs[1]), rtol=1e-7)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("fix a all property/atom/tracer region_mark low", "region_mark REGION mark_step STEP"),
        ("fix a all property/atom/tracer region_mark lo mark_step 1", "did you mean 'low'?"),
        ("fix a all property/atom/tracer mark_step 1 mark_step 1", "expected 'region_mark'"),
        ("fix a all property/atom/tracer region_mark low mark_step -1", "is negative"),
        ("fix a all property/atom/regiontracer/time add_region q", "unknown region 'q'"),
        ("compute a all nparticles/tracer/region tracer t tracer t", "expected 'region_count'"),
        (
            "compute a all nparticles/tracer/region tracer t region_count low periodic y 1",
            "the box is not periodic in y",
        ),
        (
            "compute a all nparticles/tracer/region tracer t region_count low\n"
            "thermo_style custom c_a[1]\nrun 1",
            "'t' is no fix property/atom/tracer",
        ),
        ("compute a all rdf 0", "not positive"),
        ("fix a all ave/histo 1 1 1 1 0 5 c_thermo_temp", "expected LO below HI"),
        ("fix a all ave/histo 1 1 1 0 1 5 x", "needs 'mode vector'"),
        ("fix a all ave/histo 1 1 1 0 1 5 q", "unknown fix ave/histo input 'q'"),
        ("fix a all ave/histo 1 1 1 0 1 5 c_thermo_temp overwrite", "needs 'ave running'"),
        ("fix a all ave/histo 1 1 1 0 1 5 c_thermo_temp file ../a", "leads out of the folder"),
        ("fix a all ave/histo 1 1 1 0 1 5 x mode vector beyond all", "known: ignore, end, extra"),
        ("fix a all ave/histo 1 1 1 0 1 5 c_q mode vector\nrun 1", "no compute 'q'"),
        ("compute a all rdf 5 1", "'1' has no partner"),
        ("compute a all rdf 5 1 4", "no range of types between 1 and 3"),
        ("compute a all rdf 999999999", "at most 100000 bins"),
        ("compute a all cluster/atom 0", "above zero"),
        (
            "compute a all cluster/atom 0.1\ndump d all custom 1 d id c_a\nrun 1",
            "is longer than 0.004",
        ),
        ("compute a all centro/atom 3", "an even number up to 100 is needed"),
        ("compute a all msd com maybe", "known: yes, no"),
        ("compute a all slice 3 1 1 c_thermo_temp", "the end 1 comes before 3"),
        ("compute a all slice 1 3 1 c_nix", "there is no 'c_nix'"),
        (
            "compute a all slice 1 3 1 c_thermo_temp\nthermo_style custom c_a[3]\nrun 1",
            "compute a has no",
        ),
    ],
)
def test_mistake_names_file_and_line(tmp_path, line, message):
    script = scenes.write(tmp_path, HEAD + line + "\n")
    with pytest.raises(ScriptError) as error:
        run_script(script, root=tmp_path)
    assert message in str(error.value)


def test_the_radial_distribution_counts_whom_the_run_began_with(tmp_path):
    """As in LIGGGHTS, where a particle has left the box; its file for this script has this row."""
    head = HEAD[: HEAD.index("fix p1")].replace("boundary p f f", "boundary f f f")
    lines = "create_atoms 1 single 0 0 0.045 units box\ncreate_atoms 1 single 0 0 0 units box\n"
    lines += "create_atoms 1 single 0 0 0.0099 units box\n"
    lines += "set group all diameter 0.01 density 2500\nset atom 1 vz 100\n"
    lines += "fix integr all nve/noforce\ncompute rdf all rdf 2\n"
    lines += "fix a all ave/time 10 1 10 c_rdf[1] c_rdf[2] c_rdf[3] mode vector file rdf.txt\n"
    lines += "run 50\n"
    (tmp_path / "in.s").write_text(head + lines)
    run_script(tmp_path / "in.s", root=tmp_path)
    rows = (tmp_path / "rdf.txt").read_text().splitlines()
    assert rows[-3:] == ["50 2", "1 0.0025 0 0", "2 0.0075 5.82052 0.666667"]


def test_opposite_neighbours_add_up_to_nothing(tmp_path):
    """Of three spheres in a row the one in the middle is as in a crystal until one is moved."""
    head = HEAD[: HEAD.index("fix p1")].replace("boundary p f f", "boundary p f p")
    lines = "".join(f"create_atoms 1 single {x} 0 0 units box\n" for x in (-0.018, 0.018, 0.014))
    lines += "set group all diameter 0.005 density 2500\ncompute a all centro/atom 2\n"
    lines += "dump d all custom 1 d*.dump id c_a\nfix i all nve/noforce\nrun 0\n"
    found = scenes.run_minidem(tmp_path, head + lines + "set atom 3 z 0.001\nrun 1\n")
    values = [found[f"d{k}.dump"].splitlines()[-3:] for k in (0, 1)]
    # through the periodic face the neighbours of 2 are at 0.004 m on both sides
    assert [float(row.split()[1]) for row in values[0]] == pytest.approx([0, 0, 0], abs=1e-20)
    assert [float(row.split()[1]) for row in values[1]] == pytest.approx([0, 1e-6, 0], rel=1e-5)
