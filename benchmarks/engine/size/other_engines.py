"""The settled heap of ``engine_speed.py`` in LAMMPS and YADE too, one core each, as context.

    python benchmarks/engine/size/other_engines.py [--repeat 3]

All start from the same 8000 positions, settled by minidem. Times are CPU seconds of 1000 steps
after 300 that are not counted. LAMMPS and YADE are those of Debian (``apt-get install lammps
yade``); what is not installed is left out. The models are not the same: see
``docs/performance.md``.
"""

from __future__ import annotations

import argparse
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from benchmarks.engine.engine_speed import (
    COUNT,
    LIGGGHTS,
    OURS,
    RADIUS,
    best,
    settled_script,
    take_turns,
)
from benchmarks.engine.size.machine import described

STEPS = 1000
SHEAR = 5e6 / (4 * (2 - 0.3) * (1 + 0.3))  # effective modulus of two equal grains, Pa
ROLLING = 8 * SHEAR * RADIUS**2 / 4 * (0.5 * RADIUS * 1e-4) ** 0.5  # about that of epsd2, N m
CONTACT = (
    "hertz/material 5e6 0.5 0.3 tangential mindlin NULL 1.0 0.6 "
    f"rolling sds {ROLLING:.6g} 0.0 0.1 damping tsuji"
)
LAMMPS = f"""atom_style sphere
boundary f f f
newton off
comm_modify vel yes
units si
region domain block -0.03 0.03 -0.03 0.03 -0.002 0.08 units box
create_box 1 domain
neighbor 0.00016 bin
neigh_modify delay 0
pair_style granular
pair_coeff * * {CONTACT}
timestep 2e-5
fix g all gravity 9.81 vector 0 0 -1
fix floor all wall/gran granular {CONTACT} zplane 0.0 NULL
fix cyl all wall/gran granular {CONTACT} zcylinder 0.022
fix integr all nve/sphere
thermo 100000
"""
YADE = """
import sys, time
from yade import geom, utils
sphere = FrictMat(young=5e6, poisson=0.3, frictionAngle=0.5404, density=3500)
O.materials.append(sphere)
for line in open("points"):
    O.bodies.append(utils.sphere([float(w) for w in line.split()], {radius}, material=sphere))
O.bodies.append(utils.wall(0, axis=2, material=sphere))
O.bodies.append(geom.facetCylinder((0, 0, 0.04), 0.022, 0.08, segmentsNumber=24, wallMask=4,
                                   material=sphere))
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb(), Bo1_Facet_Aabb()],
                          verletDist=0.00016),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom(), Ig2_Facet_Sphere_ScGeom()],
        [Ip2_FrictMat_FrictMat_MindlinPhys(en=0.5, krot=1.0, eta=0.1)],
        [Law2_ScGeom_MindlinPhys_Mindlin(includeMoment=True)]),
    NewtonIntegrator(gravity=(0, 0, -9.81), damping=0),
]
O.dt = 2e-5
O.run(300, True)
before = time.process_time()
O.run({steps}, True)
print("took", time.process_time() - before)
"""


def lammps(folder: Path, points: list[str]) -> float:
    """Return CPU time of the steps in LAMMPS, s."""
    lines = [f"create_atoms 1 single {point} units box" for point in points]
    text = LAMMPS + "\n".join(lines)
    text += f"\nset type 1 diameter {2 * RADIUS}\nset type 1 density 3500\nrun 300\nrun {STEPS}\n"
    (folder / "in.lammps").write_text(text)
    program = ["lmp", "-in", "in.lammps", "-log", "none"]
    out = subprocess.run(program, cwd=folder, capture_output=True, text=True, check=True).stdout
    loop = float(re.findall(r"Loop time of (\S+)", out)[-1])
    share = float(re.findall(r"([\d.]+)% CPU use", out)[-1]) / 100
    return loop * min(1.0, share)


def yade(folder: Path, points: list[str]) -> float:
    """Return CPU time of the steps in YADE, s."""
    (folder / "points").write_text("\n".join(points))
    text = YADE.replace("{radius}", str(RADIUS)).replace("{steps}", str(STEPS))
    (folder / "heap.py").write_text(text)
    program = ["yade", "-n", "-x", "-j1", "heap.py"]
    out = subprocess.run(program, cwd=folder, capture_output=True, text=True, check=True).stdout
    return float(re.findall(r"took (\S+)", out)[-1])


def version(command: list[str], pattern: str) -> str:
    """Return what a program says its version is."""
    out = subprocess.run(command, capture_output=True, text=True, check=False)
    found = re.search(pattern, out.stdout + out.stderr)
    return found[1] if found else "?"


def main() -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeat", type=int, default=3)
    args = parser.parse_args()
    print(described() + "\n\n| program | 1000 steps, CPU | of minidem |\n|---|---|---|", flush=True)
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch) / "settled"
        folder.mkdir()
        settled_script(folder, STEPS)
        rows = (folder / "settled.dump").read_text().splitlines()[-COUNT:]
        points = [row.split(maxsplit=1)[1] for row in rows]
        found = best(take_turns(folder, LIGGGHTS, args.repeat), lambda one: one.loop_cpu_s(1))
        seconds = {"minidem": found[OURS], "LIGGGHTS-PUBLIC 3.8.0": found[LIGGGHTS]}
        for name, program, run, pattern in (
            ("LAMMPS", ["lmp", "-h"], lammps, r"Parallel Simulator - (.+)"),
            ("YADE", ["yade", "--version"], yade, r"version: (\S+?),?\s"),
        ):
            if shutil.which(program[0]) is not None:
                label = f"{name} {version(program, pattern)}"
                seconds[label] = min(run(folder, points) for _ in range(args.repeat))
    for name, spent in seconds.items():
        print(f"| {name} | {spent:.2f} s | {spent / found[OURS]:.2f} |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
