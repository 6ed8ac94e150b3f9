"""Grains that are fast: beside a thin skin they miss no contact, beyond any sense they are told."""

from __future__ import annotations

import shutil
import subprocess

import numpy as np
import pytest

from minidem import run_script
from minidem.errors import SimulationError

SCRIPT = """atom_style granular
atom_modify map array sort 0 0
boundary f f f
newton off
communicate single vel yes
units si
region domain block -13 13 -13 13 -5 30 units box
create_box 1 domain
neighbor 0.002 bin
neigh_modify delay 0
hard_particles yes
fix m1 all property/global youngsModulus peratomtype 1e10
fix m2 all property/global poissonsRatio peratomtype 0.3
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.5
fix m4 all property/global coefficientFriction peratomtypepair 1 0.5
pair_style gran model hertz tangential history
pair_coeff * *
timestep 1e-4
create_atoms 1 single 0 0 2 units box
create_atoms 1 single 0.1 0 5 units box
set group all diameter 2 density 4000
set atom 2 vz SPEED
fix integr all nve/sphere
dump d all custom 500 d.txt id x y z vx vy vz omegax omegay omegaz
dump_modify d sort id format "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g"
run 1000
"""
"""The second grain meets the first after 330 steps."""


def _script(folder, speed):
    folder.mkdir(exist_ok=True)
    path = folder / "in.fast"
    path.write_text(SCRIPT.replace("SPEED", f"{speed}"))
    return path


def _last(folder):
    rows = (folder / "d.txt").read_text().splitlines()[-2:]
    return np.array([row.split() for row in rows], float)


@pytest.mark.liggghts
def test_a_grain_that_crosses_the_skin_in_a_step_collides_as_in_liggghts(tmp_path):
    theirs, ours = tmp_path / "theirs", tmp_path / "ours"
    subprocess.run(
        [shutil.which("liggghts"), "-in", _script(theirs, -30).name],
        cwd=theirs, check=True, capture_output=True,
    )  # fmt: skip
    run_script(_script(ours, -30), root=ours)
    found, told = _last(ours), _last(theirs)
    assert abs(found[0, 6]) > 1.0  # it was hit
    # One impact; both programs round, and what they dump has 17 digits.
    scale = np.abs(told).max()
    assert found == pytest.approx(told, abs=1e-12 * scale)


def test_a_grain_that_moves_half_its_radius_in_a_step_ends_the_run_with_its_number(tmp_path):
    with pytest.raises(SimulationError, match=r"particle 2: moves 0\.6 m in one step") as caught:
        run_script(_script(tmp_path, -6000), root=tmp_path)
    assert "reduce the time step" in str(caught.value)
