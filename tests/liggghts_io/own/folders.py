"""Small folders of own experiments for the tests, and the shipped one."""

from __future__ import annotations

from pathlib import Path

from tests.paths import ROOT

SHIPPED = {
    "hopper": ROOT / "cases" / "plain_script" / "hopper",
}

# One grain falls on a plane at z = 0: everything about it can be worked out by hand.
DEFINITION = """\
name = "fall"
title = "A falling grain"
seeds = ["s1", "s2"]

[variables]
mu_pp = "mu"
e_pp = "e"
d32_m = "d"

[parameters.height_m]
unit = "m"
meaning = "height of the grain's centre at the start"
default = 0.02
limits = [0.01, 1.0]
whole = false
variable = "h"

[[observable]]
name = "t_ground_s"
unit = "s"
meaning = "time until the grain is at half its height"
extract = "time_to"
file = "level.txt"
column = "z_m"
reaches = "0.5 * height_m"

[[curve]]
name = "height"
unit = "mm"
meaning = "height of the grain"
x_name = "time"
x_unit = "s"
levels = [0.01, 0.02]
extract = "columns"
file = "level.txt"
x = "time_s"
y = "z_m"
factor = 1000.0

[[effect]]
name = "weight"
title = "Gravity"
unit = "-"
meaning = "relative deviation of gravity"
variable = "g"
how = "scale"
step = 0.1
settled_by = "a pendulum"
"""
CONTACT = 'contact = ["mu_pp", "e_pp"]\n'
SCRIPT = """\
variable d  equal 0.002   # diameter [m]
variable mu equal 0.5
variable e  equal 0.6
variable h  equal 0.02
variable g  index 9.81
variable s1 equal 10007
variable s2 equal 10009
variable r  equal 0.5*${d}
atom_style granular
atom_modify map array sort 0 0
boundary f f f
newton off
communicate single vel yes
units si
region domain block -0.01 0.01 -0.01 0.01 -0.01 1.1 units box
create_box 1 domain
neighbor 0.001 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype 5e6
fix m2 all property/global poissonsRatio peratomtype 0.3
fix m3 all property/global coefficientRestitution peratomtypepair 1 ${e}
fix m4 all property/global coefficientFriction peratomtypepair 1 ${mu}
pair_style gran model hertz tangential history
pair_coeff * *
timestep 1e-5
fix gravity all gravity ${g} vector 0 0 -1
fix floor all wall/gran model hertz tangential history primitive type 1 zplane 0
create_atoms 1 single 0 0 ${h} units box
set atom 1 diameter ${d} density 2500
fix motion all nve/sphere
variable t equal step*dt
variable z equal bound(all,zmax)
fix level all print 10 "${t} ${z}" file level.txt screen no title "time_s z_m"
dump grains all custom 1000 post/grain_*.dump id type x y z vx vy vz radius
thermo 1000
run 8000
"""


def make_folder(folder: Path, definition: str = "", script: str = SCRIPT, name: str = "fall.in"):
    """Write a folder of an own experiment."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "experiment.toml").write_text(definition or CONTACT + DEFINITION, encoding="utf-8")
    (folder / name).write_text(script, encoding="utf-8")
    return folder
