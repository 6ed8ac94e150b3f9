"""Thermo words, functions of groups and thermo_log, held against what LIGGGHTS writes."""

from __future__ import annotations

import pytest

from minidem import run_script
from minidem.errors import ScriptError
from tests.minidem.output import scenes
from tests.minidem.script.test_acceptance import SCRIPT

HEAD = (
    scenes.HEAD.replace("boundary f f m", "boundary p f m")
    .replace("fix mm all move/mesh mesh cm wiggle amplitude 0.001 0 0.001 period 0.01\n", "")
    .replace(" wear finnie", "")
)
LINES = """thermo_log values.txt
create_atoms 1 single 0.199 0.05 0.1 units box
set atom 8 diameter 0.008 density 2500 vx 40
group odd type 1
region rr block -0.02 0.05 -0.2 0.2 -0.1 0.1 units box
lattice sc 0.01 spacing 2 3 4
fix af odd addforce 0.01 0 0.02
fix_modify grav energy yes
fix_modify af energy yes
compute pe all pe
compute pe2 all pe pair
compute longnameofkinetic all ke
compute er all erotate/sphere
compute sm all reduce sum vx vy
compute mx all reduce max vx vy
compute te all temp
compute pr all pressure thermo_temp
variable g equal gyration(all)+10*gyration(odd,rr)
variable a equal angmom(all,x)+angmom(odd,y)+angmom(all,z,rr)
variable t equal torque(all,x)+10*torque(odd,y,rr)+100*torque(all,z)
variable i equal &
  inertia(all,xx)+inertia(all,yy)+inertia(all,zz)-inertia(odd,xy)+inertia(all,yz)-inertia(all,xz,rr)
variable o equal omega(all,x)+omega(odd,y)+omega(all,z,rr)
variable x equal xcm(all,x)+vcm(all,y)+fcm(odd,z)+bound(all,xmax)+ke(odd,rr)
variable k equal ke
variable r equal ramp(0,100)+0.001*elaplong+1e-6*elapsed+vdisplace(0,3)
compute cm all com
thermo_style custom step elapsed elaplong dt time part atoms ke erotate vol density lx ly lz &
  xlo xhi ylo yhi zlo zhi xy xz yz xlat ylat zlat fmax fnorm cella cellb cellc cellalpha &
  cellbeta cellgamma v_g v_a v_t v_i v_o v_x v_k v_r c_cm[1] c_cm[3] c_longnameofkinetic c_er &
  c_sm[1] c_mx[1] c_te c_te[1] c_pr c_pe c_pe2 f_grav f_af f_af[1]
thermo 10
thermo_modify lost ignore norm no format float %.10g
run 50
thermo_log values2.txt
thermo_modify norm yes
run 20 start 0 stop 200
thermo_modify line multi norm no format float %18.10g
run 11
thermo_log none
thermo_style custom step ke v_x
run 10
thermo_style one
run 5
thermo_style custom step ke atoms
thermo_modify line multi
run 10
"""


def without_clock(text: str) -> str:
    """Return a table without the lines that tell the time a run takes."""
    kept = [line for line in text.splitlines() if "CPU =" not in line]
    return "\n".join(kept)


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Return the files that minidem writes, and its log."""
    folder = tmp_path_factory.mktemp("mine")
    found = scenes.run_minidem(folder, scenes.scene(LINES, HEAD))
    return found | {"log": (folder / "log.liggghts").read_text()}


def test_tables_are_those_of_liggghts(files):
    assert sorted(files) == ["log", "values.txt", "values2.txt"]
    for name, stored in (("values.txt", "thermo_values.txt"), ("values2.txt", "thermo_lines.txt")):
        theirs = without_clock((scenes.STORED / stored).read_text())
        assert scenes.alike(without_clock(files[name]), theirs, rtol=1e-7), name


@pytest.mark.liggghts
def test_liggghts_itself_writes_the_same(files, tmp_path):
    theirs = scenes.run_liggghts(tmp_path, scenes.scene(LINES, HEAD))
    for name in theirs:
        assert scenes.alike(without_clock(files[name]), without_clock(theirs[name])), name


def test_usual_columns_show_the_volume_of_a_box_that_grows(files):
    assert "    Step    Atoms         KinEng            CPU         Volume \n" in files["log"]


CLOCK = """timestep 1e-5
run 20
timestep 2e-6
print "<$(time)>"
run 20
print "<$(time)>"
reset_timestep 100
print "<$(time)>"
write_restart clock.restart
run 10
print "<$(time)>"
timestep 3e-6
run 10
print "<$(time)>"
"""
TIMES = (2e-4, 2.4e-4, 3.6e-4, 3.8e-4, 4.1e-4)
"""Printed by LIGGGHTS-PUBLIC 3.8.0; a step number that is set counts as time gone by."""


def test_time_goes_on_when_the_time_step_changes(tmp_path):
    (tmp_path / "in.s").write_text(SCRIPT.replace("run 3\n", CLOCK))
    run_script(tmp_path / "in.s", root=tmp_path)
    assert said_times(tmp_path) == pytest.approx(TIMES, rel=1e-12)


def test_the_same_time_step_once_more_changes_no_bit_of_the_time(tmp_path):
    before, after = (tmp_path / name for name in ("before.restart", "after.restart"))
    text = SCRIPT + f"timestep 3.7e-6\nrun 7\nwrite_restart {before.name}\n"
    (tmp_path / "in.s").write_text(text + f"timestep 3.7e-6\nwrite_restart {after.name}\n")
    run_script(tmp_path / "in.s", root=tmp_path)
    assert before.read_bytes() == after.read_bytes()


@pytest.mark.liggghts
def test_time_of_liggghts_itself(tmp_path):
    text = SCRIPT.replace("run 3\n", CLOCK).replace("communicate", "log log.liggghts\ncommunicate")
    scenes.run_liggghts(tmp_path, text)
    assert said_times(tmp_path) == pytest.approx(TIMES, rel=1e-12)


def said_times(folder):
    lines = (folder / "log.liggghts").read_text().splitlines()
    return [float(line[1:-1]) for line in lines if line.startswith("<")]


def test_pace_and_time_left_are_numbers(tmp_path):
    words = "cpu tpcpu spcpu cpuremain cu"
    lines = f"thermo_style custom step {words}\nthermo_log t.txt\nthermo 50\nrun 100\n"
    found = scenes.run_minidem(tmp_path, scenes.scene(lines))["t.txt"].splitlines()
    assert found[0].split() == ["Step", "CPU", "T/CPU", "S/CPU", "CPULeft", "Cu"]
    assert [float(word) for word in found[1].split()] == [0.0] * 6
    assert found[2].split()[0] == "50"
    assert min(float(word) for word in found[2].split()) > 0.0


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("thermo_style custom step temp", "'temp'; use c_thermo_temp"),
        ("thermo_style custom step pxy", "use c_ID[4] of 'compute ID all pressure"),
        ("thermo_style custom step cpuremains", "did you mean 'cpuremain'?"),
        ("thermo_modify line two", "known: one, multi"),
        ("thermo_modify norm maybe", "known: yes, no"),
        ("thermo_log", "thermo_log: expected a file"),
        ("thermo_log ../a", "leads out of the folder"),
        ("thermo_log a apend", "unknown thermo_log keyword 'apend'"),
        ("run 10 start 5", "start 5 and stop 10 must enclose the steps 0 to 10"),
        ("run 10 stop 5", "start 0 and stop 5 must enclose"),
        ("run 10 pre maybe", "known: yes, no"),
        ("compute p odd pe", "Compute pe must use group all"),
        ("variable a equal gyration(all,rr)\nprint $a", "there is no region 'rr'"),
        ("variable a equal inertia(all,x)\nprint $a", "expected inertia(GROUP,xx)"),
        ("fix_modify grav energy maybe", "known: yes, no"),
    ],
)
def test_mistake_names_file_and_line(tmp_path, line, message):
    script = scenes.write(tmp_path, scenes.scene("group odd type 1\n" + line + "\n"))
    with pytest.raises(ScriptError) as error:
        run_script(script, root=tmp_path)
    assert message in str(error.value)
