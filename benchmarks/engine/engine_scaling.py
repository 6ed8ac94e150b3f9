"""Cost per particle and step, and memory per particle, from 1000 to 500 000 particles.

    python benchmarks/engine/engine_scaling.py [--sizes 1000 10000 100000 500000] [--threads 1]

A bed of 1000 grains, 20 layers deep and periodic to the sides, is settled and then repeated side
by side, so that every size has the same structure. Lists are made anew every 50 steps, as often as
in a pile that flows. Times are CPU seconds of the fastest stretch; memory is the largest
resident size of the process, start and file reading included. The bandwidth of the machine is that
of a copy of 400 MB in the same run, and says how far the steps of the largest bed are from it.
"""

from __future__ import annotations

import argparse
import itertools
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from minidem import run_script

COUNT = 1000
RADIUS = 0.0008  # m
SIDE = 14 * RADIUS  # seven grains
STRETCH = 4_000_000  # particle-steps between two looks at the clock, as the engine breathes
MODEL = "model hertz tangential history rolling_friction epsd2"

HEAD = """atom_style granular
atom_modify map array sort 0 0
boundary p p f
newton off
communicate single vel yes
units si
"""

BOX = f"""region domain block 0 {SIDE} 0 {SIDE} -0.001 0.12 units box
create_box 1 domain
"""

PHYSICS = f"""neighbor 0.00024 bin
neigh_modify delay 0 contact_distance_factor 1.01 LISTS
fix m1 all property/global youngsModulus peratomtype 5e6
fix m2 all property/global poissonsRatio peratomtype 0.3
fix m3 all property/global coefficientRestitution peratomtypepair 1 .5
fix m4 all property/global coefficientFriction peratomtypepair 1 .6
fix m5 all property/global coefficientRollingFriction peratomtypepair 1 .1
pair_style gran {MODEL}
pair_coeff * *
timestep 2e-5
fix g all gravity 9.81 vector 0 0 -1
fix floor all wall/gran {MODEL} primitive type 1 zplane 0.0
fix integr all nve/sphere
thermo_style custom step atoms ke
thermo_modify lost error norm no
thermo 1000000
"""

FILL = f"""fix pts all particletemplate/sphere 15485863 atom_type 1 density constant 3500 &
 radius constant {RADIUS}
fix pdd all particledistribution/discrete 32452843 1 pts 1.0
region fill block 0 {SIDE} 0 {SIDE} 0.001 0.11 units box
fix ins all insert/pack seed 86028121 distributiontemplate pdd maxattempt 100 insert_every once &
 overlapcheck yes all_in no vel constant 0 0 -0.4 region fill particles_in_region {COUNT}
run 12000
unfix ins
write_restart bed.npz
"""

CHILD = """
import json, sys, time
from pathlib import Path
from minidem import run_script
seen = []
root = Path(sys.argv[1])
done = run_script(root / "in.run", root=root, threads=int(sys.argv[2]),
                  progress=lambda step, last: seen.append((step, time.process_time(), time.time())))
status = Path("/proc/self/status").read_text()  # getrusage would count the parent's memory
peak = int(status.split("VmHWM:")[1].split()[0]) * 1024
print(json.dumps({"seen": seen, "peak": peak, "particles": done.particles}))
"""


def settle(folder: Path) -> None:
    """Make the bed that is repeated."""
    text = HEAD + BOX + PHYSICS.replace("LISTS", "") + FILL
    (folder / "in.fill").write_text(text)
    run_script(folder / "in.fill", root=folder)


def repeat(bed: Path, target: Path, size: int) -> int:
    """Write a restart file with the bed repeated side by side; return the number of particles."""
    copies = max(1, round(size / COUNT))
    wide = max(k for k in range(1, int(np.sqrt(copies)) + 1) if copies % k == 0)
    counts = (wide, copies // wide)
    with np.load(bed) as file:
        arrays = {name: file[name] for name in file.files}
    meta = json.loads(arrays["meta"].tobytes())
    n = meta["particles"]
    for name, table in arrays.items():
        if name.startswith("state_") and name != "state_marker":
            arrays[name] = np.concatenate([table] * copies)
        elif name.startswith(("pairs_", "walls_")):
            arrays[name] = table[:0] if not name.endswith("start") else np.zeros(1, np.int64)
    shift = np.array([(i, j) for i in range(counts[0]) for j in range(counts[1])]) * SIDE
    arrays["state_row"][:, :2] += np.repeat(shift, n, axis=0)
    arrays["state_ids"] = 1 + np.arange(n * copies)
    arrays["state_rank"] = np.arange(n * copies)
    arrays["state_marker"] = np.zeros((0, n * copies), np.int8)
    arrays["box"][1::2, :2] = np.array(counts) * SIDE
    meta.update(particles=n * copies, top_id=n * copies, before=0)
    arrays["meta"] = np.frombuffer(json.dumps(meta).encode(), np.uint8)
    np.savez(target, **arrays)
    return n * copies


def measure(folder: Path, size: int, threads: int) -> tuple[int, float, float]:
    """Return particles, ns per particle and step, and bytes per particle."""
    work = folder / f"n{size}"
    work.mkdir()
    particles = repeat(folder / "bed.npz", work / "bed.npz", size)
    stretch = max(100, STRETCH // particles)
    physics = PHYSICS.replace("LISTS", "every 50 check no")
    text = HEAD + "read_restart bed.npz\n" + physics + f"run 50\nrun {3 * stretch}\n"
    (work / "in.run").write_text(text)
    child = [sys.executable, "-c", CHILD, str(work), str(threads)]
    found = json.loads(subprocess.run(child, capture_output=True, text=True, check=True).stdout)
    # wall time says what threads are worth, CPU time what one thread costs on a busy machine
    clock = 1 if threads == 1 else 2
    looks = found["seen"][1:]
    cost = min((b[clock] - a[clock]) / (b[0] - a[0]) for a, b in itertools.pairwise(looks))
    return particles, cost / particles * 1e9, found["peak"] / particles


def traffic(bed: Path) -> float:
    """Return the bytes per particle that a step at least reads and writes beyond the caches.

    Both passes over the particles (move; contacts) load position, spin and force and store what
    they change; the pass over the pairs loads neighbour and flag of every entry and loads and
    stores its history.
    """
    with np.load(bed) as file:
        entries = len(file["pairs_other"]) / COUNT
        history = file["pairs_hist"].itemsize * file["pairs_hist"].shape[1]
    row, spin, force, held = 64, 32, 64, 24
    move = 2 * (row + spin + force) + held
    contacts = row + spin + 2 * force
    return float(move + contacts + entries * (4 + 1 + 2 * history))


def copy_bandwidth() -> float:
    """Return what a copy moves, read and written, in bytes per second: the best of five."""
    source = np.ones(50_000_000)
    target = np.zeros_like(source)
    best = np.inf
    for _ in range(5):
        started = time.perf_counter()
        np.copyto(target, source)
        best = min(best, time.perf_counter() - started)
    return float(2 * source.nbytes / best)


def main() -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sizes", type=int, nargs="*", default=[1000, 10_000, 100_000, 500_000])
    parser.add_argument("--threads", type=int, default=1)
    args = parser.parse_args()
    print("| particles | ns per particle and step | of the value at 10k | bytes per particle |")
    print("|---|---|---|---|")
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        settle(folder)
        rows = [measure(folder, size, args.threads) for size in args.sizes]
        least = traffic(folder / "bed.npz")
    base = next((cost for n, cost, _ in rows if n == 10_000), rows[0][1])
    for n, cost, size in rows:
        print(f"| {n} | {cost:.1f} | {cost / base:.2f} | {size:.0f} |")
    copy, largest = copy_bandwidth(), rows[-1]
    print(
        f"\nA step moves at least {least:.0f} bytes per particle; a copy moves {copy / 1e9:.1f} "
        "GB/s, "
        f"so that it could take {least / copy * 1e9:.0f} ns: "
        f"{least / copy * 1e9 / largest[1]:.0%} of what it takes with {largest[0]} particles."
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
