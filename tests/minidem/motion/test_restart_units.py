"""What a restart file tells of units, time step and clock, beside LIGGGHTS, which reads its own."""

from __future__ import annotations

import shutil
import subprocess

import pytest

from minidem import run_script

MODEL = """neighbor 0.0005 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype 1e7
fix m2 all property/global poissonsRatio peratomtype 0.3
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.5
fix m4 all property/global coefficientFriction peratomtypepair 1 0.5
pair_style gran model hertz tangential history
pair_coeff * *
fix integr all nve/sphere
thermo_style custom step atoms dt time ke
"""
BEFORE = f"""atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
units si
region domain block 0 0.04 0 0.04 0 0.04 units box
create_box 1 domain
timestep 1e-5
create_atoms 1 single 0.01 0.01 0.01 units box
create_atoms 1 single 0.02 0.02 0.02 units box
set group all diameter 0.002 density 2500
velocity all set 0.01 0.0 0.0
{MODEL}run 10
write_restart r.restart
"""
BEHIND = {
    "nothing": f"read_restart r.restart\nnewton off\ncommunicate single vel yes\n{MODEL}run 1\n",
    "the time step": "read_restart r.restart\nnewton off\ncommunicate single vel yes\n"
    f"{MODEL}timestep 2e-5\nrun 1\n",
    "units and time step before": "units si\ntimestep 3e-5\natom_style granular\n"
    f"read_restart r.restart\nnewton off\ncommunicate single vel yes\n{MODEL}run 1\n",
    "other units before": "units cgs\ntimestep 3e-5\natom_style granular\n"
    f"read_restart r.restart\nnewton off\ncommunicate single vel yes\n{MODEL}run 1\n",
}
KINETIC = 1.0471976e-09
"""J, of both grains; units lj would divide it by two."""


def _write(folder, name):
    (folder / "in.1").write_text(BEFORE)
    (folder / "in.2").write_text(BEHIND[name])


def _last_row(log):
    rows = [line.split() for line in log.splitlines()]
    return [float(w) for row in rows if len(row) == 5 and row[0] == "11" for w in row]


def _ours(folder, capsys):
    for script in ("in.1", "in.2"):
        run_script(folder / script, root=folder)
    capsys.readouterr()
    return (folder / "log.liggghts").read_text()


@pytest.mark.parametrize(
    ("name", "step"),
    [("nothing", 1e-8), ("the time step", 2e-5), ("units and time step before", 3e-5),
     ("other units before", 1e-8)],
)  # fmt: skip
def test_units_go_along_and_the_clock_does_not(tmp_path, capsys, name, step):
    _write(tmp_path, name)
    log = _ours(tmp_path, capsys)
    # The thermo table has eight digits.
    assert _last_row(log) == pytest.approx([11, 2, step, step, KINETIC], rel=1e-7)
    # who has said no time step since is told what that means
    assert ("the time step is 1e-08" in log) == (step == 1e-8)


@pytest.mark.liggghts
@pytest.mark.parametrize("name", list(BEHIND))
def test_liggghts_does_the_same(tmp_path, capsys, name):
    program = shutil.which("liggghts")
    theirs, ours = tmp_path / "theirs", tmp_path / "ours"
    for folder in (theirs, ours):
        folder.mkdir()
        _write(folder, name)
    for script in ("in.1", "in.2"):
        subprocess.run([program, "-in", script], cwd=theirs, check=True, capture_output=True)
    told = _last_row((theirs / "log.liggghts").read_text())
    assert _last_row(_ours(ours, capsys)) == pytest.approx(told, rel=1e-7)  # eight digits
