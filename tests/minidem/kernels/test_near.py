"""Pairs that are looked at only when they may soon touch are found in time."""

from __future__ import annotations

import numpy as np
import pytest

from minidem import run_script
from minidem.kernels.machine.cache import FREE
from tests.minidem.loops import general_loops, own_loops

SKIN = 0.002  # m
APART = (0.1, 0.3, 0.6, 0.8)
"""Gaps in parts of the skin: within what is near at once, and beyond it. Both grains of a pair meet
before one of them has gone half the skin, so that the list is made once."""
SCRIPT = f"""
atom_style granular
boundary f f f
newton off
communicate single vel yes
units si
region box block -0.05 0.05 -0.05 0.05 -0.05 0.05 units box
create_box 1 box
neighbor {SKIN} bin
neigh_modify delay 0
fix a all property/global youngsModulus peratomtype 5e6
fix b all property/global poissonsRatio peratomtype 0.3
fix c all property/global coefficientRestitution peratomtypepair 1 0.5
fix d all property/global coefficientFriction peratomtypepair 1 0.5
fix e all property/global coefficientRollingFriction peratomtypepair 1 0.1
pair_style gran model hertz tangential history rolling_friction epsd2
pair_coeff * *
timestep 1e-6
"""


def meeting(folder, loops, drift: float = 0.0) -> tuple[np.ndarray, int]:
    """Let pairs of grains meet; return what they do in the end, and how often lists were made.

    All are carried along with `drift`, m/s, where they meet and across.
    """
    folder.mkdir()
    lines = []
    for k, gap in enumerate(APART):
        y = 0.02 * k - 0.03
        lines.append(f"create_atoms 1 single 0 {y} 0 units box")
        lines.append(f"create_atoms 1 single {0.002 + gap * SKIN} {y} 0.0003 units box")
    lines.append("set type 1 density 2500 diameter 0.002")
    for k in range(2 * len(APART)):
        lines.append(f"set atom {k + 1} vx {drift + (0.5 if k % 2 == 0 else -0.5)} vy {drift}")
    lines += ["fix move all nve/sphere", "dump d all custom 1900 d.* id x y z vx vy vz omegay"]
    lines += ['dump_modify d sort id format "%d' + 7 * " %.17g" + '"', "run 1900"]
    (folder / "in.s").write_text(SCRIPT + "\n".join(lines) + "\n")
    with loops():
        summary = run_script(folder / "in.s", root=folder, log=None)
    return np.loadtxt(folder / "d.1900", skiprows=9), summary.builds


@pytest.mark.skipif(not FREE, reason="interpreted, both loops are alike but for their order")
@pytest.mark.parametrize("drift", [0.0, -0.2, 0.4])
def test_grains_that_meet_while_a_list_lives_touch(tmp_path, drift):
    found, builds = meeting(tmp_path / "own", own_loops, drift)
    plain, _ = meeting(tmp_path / "general", general_loops, drift)
    assert np.array_equal(found, plain)
    assert (np.abs(found[:, -1]) > 1.0).all()  # they met off centre, so that they turn
    assert builds <= (2 if drift == 0.0 else 4)  # others are made where grains are carried farther


@pytest.mark.parametrize("side", [4, 11])
def test_lists_are_made_anew_where_one_of_few_or_many_has_gone_half_the_skin(tmp_path, side):
    """Of many particles it is not looked at in every step how far they have moved."""
    first = -0.048
    last = first + 0.004 * (side - 0.5)
    lines = [
        "atom_modify sort 0 0",  # sorting makes new lists, too
        "lattice sc 0.004",
        f"region few block {first} {last} {first} {last} {first} {last} units box",
        "create_atoms 1 region few",
        "create_atoms 1 single 0.03 0.03 -0.04 units box",  # the one that moves
        "set type 1 density 2500 diameter 0.002",
        "group fast id " + str(1 + side**3),
        "velocity fast set 0 0 0.9995 units box",
        "fix move all nve/sphere",
        "run 8000",
    ]
    (tmp_path / "in.s").write_text(SCRIPT + "\n".join(lines) + "\n")
    summary = run_script(tmp_path / "in.s", root=tmp_path, log=None)
    # 0.9995 m/s times 1 us, half a skin of 1 mm: in each 1001st step it has gone farther
    assert summary.particles == 1 + side**3
    assert summary.builds == 1 + 8000 // 1001
