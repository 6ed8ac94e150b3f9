"""What ``units`` sets by itself: the time step, the skin and the constant of temperatures."""

from __future__ import annotations

import shutil
import subprocess

import pytest

from minidem import run_script

SCRIPT = """atom_style granular
boundary f f f
newton off
communicate single vel yes
{units}
region r block -40 40 -40 40 -40 40 units box
create_box 1 r
neigh_modify delay 0
fix a all property/global youngsModulus peratomtype {young}
fix b all property/global poissonsRatio peratomtype 0.3
fix c all property/global coefficientRestitution peratomtypepair 1 0.5
fix d all property/global coefficientFriction peratomtypepair 1 0.5
pair_style gran model hertz tangential history
pair_coeff * *
fix g all gravity 9.81 vector 0 0 -1
create_atoms 1 single 0 0 0
create_atoms 1 single 0.3 0 1.9
create_atoms 1 single 0 10 0
set group all diameter 2 density 2500
set atom 2 vz -30
fix i all nve/sphere
compute t all temp
compute p all pressure t
thermo_style custom step atoms dt ke c_t c_p
thermo_modify norm no format float %.10g
thermo 20
run 20
{step}
run 100
"""
WORDS = {"": 5e7, "lj": 5e7, "si": 5e6, "cgs": 5e7, "micro": 5e7, "nano": 5e7}
"""Units with a modulus that their check of soft particles lets pass; none is the default."""
SKIN = {"": 0.3, "lj": 0.3, "si": 0.001, "cgs": 0.1, "micro": 0.1, "nano": 0.1}
SET = {"": 5e-3, "lj": 5e-3, "si": 1e-8, "cgs": 1e-8, "micro": 2.0, "nano": 4.5e-4}
"""Time steps that they set, of LIGGGHTS 3.8.0."""


def script(units: str) -> str:
    """Return the script; where the step that is set is too large for contacts nothing touches."""
    # The third grain goes a third of the skin in a step, which a smaller skin would not bear.
    step = f"timestep 1e-5\nset atom 3 vx {SKIN[units] / 3e-5:g}"
    text = SCRIPT.format(units=f"units {units}" if units else "", young=WORDS[units], step=step)
    if units == "micro":  # 2.0: grains at rest, far from each other
        text = text.replace("0.3 0 1.9", "0.3 0 19").replace("set atom 2 vz -30\n", "")
        text = text.replace("9.81", "1e-5")
    return text if units not in ("", "lj", "nano") else text.replace("vz -30", "vz -3")


def lines(folder) -> list[list[str]]:
    """Return the thermo lines of a log."""
    rows = (folder / "log.liggghts").read_text().splitlines()
    return [row.split() for row in rows if len(row.split()) == 6 and row.split()[1] == "3"]


@pytest.mark.parametrize("units", WORDS)
def test_units_set_the_time_step(tmp_path, units):
    (tmp_path / "in.s").write_text(script(units))
    run_script(tmp_path / "in.s", root=tmp_path)
    assert float(lines(tmp_path)[0][2]) == SET[units]
    assert float(lines(tmp_path)[-1][2]) == 1e-5
    assert len(lines(tmp_path)) == 8


@pytest.mark.liggghts
@pytest.mark.parametrize("units", WORDS)
def test_what_follows_is_what_follows_in_liggghts(tmp_path, units):
    mine, theirs = tmp_path / "minidem", tmp_path / "liggghts"
    for folder in (mine, theirs):
        folder.mkdir()
        (folder / "in.s").write_text(script(units))
    run_script(mine / "in.s", root=mine)
    program = shutil.which("liggghts")
    assert program
    subprocess.run([program, "-in", "in.s"], cwd=theirs, capture_output=True, check=True)
    assert len(lines(theirs)) == 8
    assert lines(mine) == lines(theirs)
