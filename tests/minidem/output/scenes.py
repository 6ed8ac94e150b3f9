"""Seven grains on tilted plates, and what both programs write about them."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import numpy as np

from minidem import run_script
from tests.paths import DATA

STORED = DATA / "minidem" / "output"
# Sums in another order differ in their last digits, and contacts amplify that for 300 steps.
RTOL = 1e-9
ATOL = 1e-12

STL = """solid m
facet normal 0 0 1
outer loop
vertex -0.05 -0.05 0.02
vertex 0.05 -0.05 0.02
vertex 0.05 0.05 0
endloop
endfacet
facet normal 0 0 1
outer loop
vertex -0.05 -0.05 0.02
vertex 0.05 0.05 0
vertex -0.05 0.05 0
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
fix m5 all property/global k_finnie peratomtypepair 2 1.0 2.0 2.0 3.0
pair_style gran model hertz tangential history
pair_coeff * *
timestep 1e-5
fix grav all gravity 9.81 vector 0 0 -1
fix cm all mesh/surface/stress file m.stl type 1 wear finnie
fix cn all mesh/surface/stress file m.stl type 2 move 0 0 -0.03 stress off wear finnie
fix cp all mesh/surface file m.stl type 2 move 0 0 -0.05
fix mm all move/mesh mesh cm wiggle amplitude 0.001 0 0.001 period 0.01
fix w all wall/gran model hertz tangential history mesh n_meshes 3 meshes cm cn cp
"""
GRAINS = (  # x y z, m, and vx vy vz, m/s
    (0.0, 0.0, 0.0144, 0.0, 0.0, -1.0),
    (0.0082, 0.0, 0.0144, -0.3, 0.0, -1.0),
    (-0.03, 0.02, 0.0104, 0.5, 0.2, -1.2),
    (0.03, -0.02, 0.0186, 0.1, 0.3, -2.0),
    (0.0295, -0.0115, 0.0186, 0.1, 0.1, -2.0),
    (0.02, 0.02, -0.0196, 0.0, 0.6, -1.0),
    (-0.02, 0.02, -0.0196, 1.0, 0.6, -0.4),
)
TAIL = """fix integr all nve/sphere
thermo_style custom step atoms ke f_cm[1] f_cn[3]
thermo 50
thermo_modify lost ignore norm no format float %.12g
"""


def scene(lines: str, head: str = HEAD) -> str:
    """Return a script of the seven grains with some lines at its end."""
    made = [
        f"create_atoms {k % 2 + 1} single {x} {y} {z} units box"
        for k, (x, y, z, *_) in enumerate(GRAINS)
    ]
    made += [
        f"set atom {k + 1} diameter {0.0076 if k % 2 else 0.008} density 2500 "
        f"vx {vx} vy {vy} vz {vz}"
        for k, (*_, vx, vy, vz) in enumerate(GRAINS)
    ]
    return head + "\n".join(made) + "\n" + TAIL + lines


def write(folder: Path, script: str) -> Path:
    """Write a script and its mesh into a folder; return the script."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "m.stl").write_text(STL)
    path = folder / "in.s"
    path.write_text(script)
    return path


def run_minidem(folder: Path, script: str, *, threads: int = 1) -> dict[str, str]:
    """Run minidem; return what it has written, by name."""
    run_script(write(folder, script), root=folder, threads=threads)
    return files_of(folder)


def run_liggghts(folder: Path, script: str) -> dict[str, str]:
    """Run LIGGGHTS; return what it has written, by name."""
    write(folder, script)
    program = shutil.which("liggghts")
    assert program
    subprocess.run([program, "-in", "in.s"], cwd=folder, check=True, capture_output=True)
    return files_of(folder)


def files_of(folder: Path) -> dict[str, str]:
    """Return the files a script has written, by name."""
    found = [path for path in folder.rglob("*") if path.is_file()]
    return {
        path.relative_to(folder).as_posix(): path.read_text()
        for path in sorted(found)
        if path.suffix not in (".s", ".liggghts", ".restart") and path.name != "m.stl"
    }


NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def alike(mine: str, theirs: str, rtol: float = RTOL, atol: float = ATOL) -> bool:
    """Return True if two texts differ at most in rounding of their numbers."""
    if NUMBER.sub("#", mine) != NUMBER.sub("#", theirs):
        return False
    values = [np.array([float(x) for x in NUMBER.findall(text)]) for text in (mine, theirs)]
    return bool(np.allclose(*values, rtol=rtol, atol=atol))


def different(mine: dict[str, str], theirs: dict[str, str]) -> list[str]:
    """Return the names of the files that are missing or differ by more than rounding."""
    missing = sorted(mine.keys() ^ theirs.keys())
    return missing + [
        name for name in mine if name in theirs and not alike(mine[name], theirs[name])
    ]
