"""Compare the speed of minidem and LIGGGHTS on the same scripts in the same run.

    python benchmarks/engine_speed.py [--repeat 1] [--only settled heap]

Prints a table of particle-steps per second and the ratio. Times are CPU seconds of the whole
process (start included) and, for the settled heap, of the second ``run`` command alone; on a busy
machine they mean more than wall-clock time. The two programs take turns.
"""

from __future__ import annotations

import argparse
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from liggghts_io.cases import CaseSpec, write_case
from minidem import run_script

RADIUS = 0.0008  # m
COUNT = 8000
HSP13 = {
    "mu_pp": 0.694, "mu_roll_pp": 0.0856, "mu_pw": 0.307, "mu_roll_pw": 0.274, "e_pp": 0.742,
    "e_pw": 0.439,
}  # fmt: skip
MODEL = "model hertz tangential history rolling_friction epsd2"

HEAD = f"""atom_style granular
atom_modify map array sort 0 0
boundary f f f
newton off
communicate single vel yes
units si
region domain block -0.03 0.03 -0.03 0.03 -0.002 0.08 units box
create_box 2 domain
neighbor 0.00016 bin
neigh_modify delay 0 contact_distance_factor 1.01
fix m1 all property/global youngsModulus peratomtype 5e6 5e6
fix m2 all property/global poissonsRatio peratomtype 0.3 0.3
fix m3 all property/global coefficientRestitution peratomtypepair 2 .5 .5 .5 .5
fix m4 all property/global coefficientFriction peratomtypepair 2 .6 .6 .6 .6
fix m5 all property/global coefficientRollingFriction peratomtypepair 2 .1 .1 .1 .1
pair_style gran {MODEL}
pair_coeff * *
timestep 2e-5
fix g all gravity 9.81 vector 0 0 -1
fix floor all wall/gran {MODEL} primitive type 2 zplane 0.0
fix cyl all wall/gran {MODEL} primitive type 2 zcylinder 0.022 0 0
fix integr all nve/sphere
thermo_style custom step atoms ke
thermo_modify lost ignore norm no
"""

FILL = f"""fix pts all particletemplate/sphere 15485863 atom_type 1 density constant 3500 &
 radius constant {RADIUS}
fix pdd all particledistribution/discrete 32452843 1 pts 1.0
region fill cylinder z 0 0 0.021 0.001 0.078 units box
fix ins all insert/pack seed 86028121 distributiontemplate pdd maxattempt 100 insert_every once &
 overlapcheck yes all_in yes vel constant 0 0 -0.4 region fill particles_in_region {COUNT}
dump d all custom 6000 settled.dump id x y z
dump_modify d sort id format "%d %.17g %.17g %.17g"
run 6000
"""


@dataclass(frozen=True)
class Timing:
    """CPU seconds of one program on one script, and what the log says of its last run."""

    cpu_s: float
    loop_s: float
    wall_s: float

    @property
    def loop_cpu_s(self) -> float:
        """Last loop time, scaled to CPU seconds by what share of the wall time the CPU was ours."""
        return self.loop_s * min(1.0, self.cpu_s / self.wall_s)


def run_program(engine: str, folder: Path, script: str) -> Timing:
    """Run a script in a folder with one of the programs and time it."""
    if engine == "liggghts":
        command = ["liggghts", "-in", script, "-log", "log.run"]
    else:
        command = [sys.executable, "-m", "minidem.cli", "-in", script, "-log", "log.run"]
    root = str(Path(__file__).parent.parent)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    started = time.perf_counter()
    with (folder / "screen.txt").open("w") as screen:
        subprocess.run(
            command, cwd=folder, stdout=screen, stderr=subprocess.STDOUT, check=True,
            env={**os.environ, "PYTHONPATH": root, "OMP_NUM_THREADS": "1"},
        )  # fmt: skip
    wall = time.perf_counter() - started
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    loops = re.findall(r"^Loop time of (\S+)", (folder / "log.run").read_text(), re.MULTILINE)
    cpu = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
    return Timing(cpu, float(loops[-1]), wall)


def settled_script(folder: Path, steps: int) -> None:
    """Let minidem settle a packing, and write a script that starts from it."""
    (folder / "in.fill").write_text(HEAD + "thermo 6000\n" + FILL)
    run_script(folder / "in.fill", root=folder)
    rows = (folder / "settled.dump").read_text().splitlines()[-COUNT:]
    points = np.array([[float(word) for word in row.split()[1:]] for row in rows])
    lines = [f"create_atoms 1 single {x:.17g} {y:.17g} {z:.17g} units box" for x, y, z in points]
    lines.append(f"set type 1 density 3500 diameter {2 * RADIUS}")
    text = HEAD + "thermo 100000\n" + "\n".join(lines) + f"\nrun 300\nrun {steps}\n"
    (folder / "in.script").write_text(text)


def particle_steps(folder: Path) -> float:
    """Return the sum of particles over all steps, from the thermo lines of a log."""
    rows = [line.split() for line in (folder / "log.run").read_text().splitlines()]
    thermo = [r for r in rows if len(r) == 3 and r[0].isdigit() and r[1].isdigit()]
    steps = np.array([int(r[0]) for r in thermo], float)
    atoms = np.array([int(r[1]) for r in thermo], float)
    return float(np.sum(0.5 * (atoms[1:] + atoms[:-1]) * np.diff(steps)))


def compare(name: str, folder: Path, repeat: int, *, loop_steps: int = 0) -> None:
    """Time both programs in turn and print a row of the table."""
    best: dict[str, float] = {}
    work = 0.0
    for _ in range(repeat):
        for engine in ("minidem", "liggghts"):
            copy = folder.parent / f"{folder.name}_{engine}"
            shutil.rmtree(copy, ignore_errors=True)
            shutil.copytree(folder, copy)
            timing = run_program(engine, copy, "in.script")
            cpu = timing.loop_cpu_s if loop_steps else timing.cpu_s
            best[engine] = min(best.get(engine, np.inf), cpu)
            work = float(loop_steps * COUNT) if loop_steps else particle_steps(copy)
    rate = {engine: work / cpu / 1e6 for engine, cpu in best.items()}
    print(
        f"| {name} | {rate['minidem']:.2f} | {rate['liggghts']:.2f} "
        f"| {best['minidem']:.2f} | {best['liggghts']:.2f} "
        f"| {best['liggghts'] / best['minidem']:.2f} |",
        flush=True,
    )


def main() -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeat", type=int, default=1)
    parser.add_argument("--steps", type=int, default=1000, help="steps of the settled heap")
    parser.add_argument(
        "--only", nargs="*", default=["settled", "heap", "conveyor", "plate_impact"]
    )
    args = parser.parse_args()
    if shutil.which("liggghts") is None:
        print("liggghts is not installed (Debian: apt-get install liggghts)")
        return 2
    print("| script | minidem M/s | LIGGGHTS M/s | minidem CPU s | LIGGGHTS CPU s | ratio |")
    print("|---|---|---|---|---|---|", flush=True)
    with tempfile.TemporaryDirectory() as scratch:
        base = Path(scratch)
        if "settled" in args.only:
            folder = base / "settled"
            folder.mkdir()
            settled_script(folder, args.steps)
            compare(f"settled heap, {COUNT} particles", folder, args.repeat, loop_steps=args.steps)
        for name in ("heap", "conveyor", "plate_impact"):
            if name in args.only:
                spec = CaseSpec(name, "Carbo HSP13", "steel", "quick", HSP13, {}, {}, 1, "minidem")
                write_case(spec, base / name)
                compare(f"{name}, quick scale", base / name, args.repeat)
    return 0


if __name__ == "__main__":
    sys.exit(main())
