"""Whether a contact slides is decided with LIGGGHTS' rounding.

At the end of a run a contact that slides is exactly at its limit, so that rounding decides at the
start of the next whether it still does. ``tests/data/minidem/sliding.csv`` is what LIGGGHTS 3.8.0
has after the script below, from the last frame of its dump.
"""

from __future__ import annotations

import random

import numpy as np

from minidem import run_script
from tests.paths import ROOT

GRAINS, RUNS = 40, 100
HEAD = """
atom_style granular
atom_modify map array sort 0 0
boundary f f f
newton off
communicate single vel yes
units si
region box block -0.1 0.1 -0.1 0.1 -0.01 0.1 units box
create_box 1 box
neighbor 0.002 bin
neigh_modify delay 0 contact_distance_factor 1.01
fix a all property/global youngsModulus peratomtype 5e6
fix b all property/global poissonsRatio peratomtype 0.3
fix c all property/global coefficientRestitution peratomtypepair 1 0.5
fix d all property/global coefficientFriction peratomtypepair 1 0.3
fix e all property/global coefficientRollingFriction peratomtypepair 1 0.1
fix e2 all property/global coefficientRollingViscousDamping peratomtypepair 1 0.3
pair_style gran model hertz tangential history rolling_friction epsd
pair_coeff * *
timestep 1e-5
fix down all gravity 9.81 vector 0 0 -1
fix floor all wall/gran model hertz tangential history rolling_friction epsd primitive &
    type 1 zplane 0
"""


def script() -> str:
    """Return grains that slide and roll over a floor, in many short runs."""
    draw = random.Random(5)
    lines = []
    for k in range(GRAINS):
        x, y = (k % 7) * 0.012 - 0.04, (k // 7) * 0.012 - 0.04
        z = 0.00199 + draw.random() * 1e-5
        lines.append(f"create_atoms 1 single {x} {y} {z} units box")
    lines.append("set type 1 density 2500 diameter 0.004")
    for k in range(GRAINS):
        vx, vy = draw.uniform(-0.3, 0.3), draw.uniform(-0.3, 0.3)
        wx, wz = draw.uniform(-50, 50), draw.uniform(-50, 50)
        speed = f"vx {vx:.5f} vy {vy:.5f} omegax {wx:.4f} omegaz {wz:.4f}"
        lines.append(f"set atom {k + 1} {speed}")
    lines += [
        "fix move all nve/sphere", "thermo 1000",
        "dump d all custom 3000 d.* id type x y z vx vy vz omegax omegay omegaz",
        'dump_modify d sort id format "%d %d' + 9 * " %.17g" + '"',
    ]  # fmt: skip
    return HEAD + "\n".join([*lines, *["run 30"] * RUNS]) + "\n"


def test_most_grains_that_slide_through_many_runs_have_the_bits_of_liggghts(tmp_path):
    """31 of 40 have them, and 8 if squares of force and limit are compared."""
    wanted = np.loadtxt(
        ROOT / "tests" / "data" / "minidem" / "sliding.csv", delimiter=",", skiprows=1
    )
    (tmp_path / "in.s").write_text(script())
    run_script(tmp_path / "in.s", root=tmp_path, log=None)
    found = np.loadtxt(tmp_path / f"d.{30 * RUNS}", skiprows=9)
    assert (found == wanted).all(axis=1).sum() > 20
    # the others differ by roundings of a metre per second, 2e-16 each
    np.testing.assert_allclose(found[:, 2:8], wanted[:, 2:8], atol=1e-13, rtol=0.0)
